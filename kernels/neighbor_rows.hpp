#pragma once
// Who is near whom: for each particle a row of neighbours and a row of images, each entry with the weight of the
// pressure operator beside it. Rebuilt every step, as everything has moved (a list that lives longer must reach
// further, and pays for it in every sum).

#include "kernels/cell_grid.hpp"
#include "kernels/sight.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// Compressed rows: the entries of particle i are first(i) ... first(i + 1) - 1.
struct Rows {
  std::int64_t entries = 0;
  OffsetField first;
  IndexField index;    // neighbour j
  ScalarField weight;  // w of the Laplacian's radius, at the positions of the last build [-]; empty when not kept
};

/// Rows of images: entry k is the image of index(k) in mirror number mirror(k). A particle may be its own neighbour here.
struct ImageRows {
  std::int64_t entries = 0;
  OffsetField first;
  IndexField index;
  IndexField mirror;
  ScalarField share;   // with which the image counts [-]: 1 but near the edges of corners
  ScalarField weight;  // share times w
};

/// What particle i sees of particle j: j itself, or its image by way of walls.
template <int Dim>
struct Image {
  const Mirror* mirror = nullptr;  // null: j itself
  const Panel* panels = nullptr;
  const Joint* joints = nullptr;
  Vec<Dim, coord> middle{};  // of i and j [m]: walls that move do so as below it
  real share = 1;            // with which it counts in every sum

  KOKKOS_INLINE_FUNCTION explicit operator bool() const { return mirror != nullptr; }

  /// u of the image of a velocity at j: free slip, mirrored with the walls' normal velocity.
  KOKKOS_INLINE_FUNCTION Vec<Dim> velocity(const Vec<Dim>& u) const { return velocity_at_walls<false>(u); }

  /// As velocity(); where the fluid sticks to the wall u' = 2 u_w - u.
  KOKKOS_INLINE_FUNCTION Vec<Dim> sticking_velocity(const Vec<Dim>& u) const { return velocity_at_walls<true>(u); }

  /// What the pressure of the image is above that of j at x, per density: (g - a_w) . (x_img - x_j), wall by wall. It
  /// belongs to gradients, loads and probes; never to the pressure rows, whose source carries gravity and the wall's
  /// motion already.
  KOKKOS_INLINE_FUNCTION real pressure_offset(const Vec<Dim>& g, const Vec<Dim, coord>& x) const {
    const auto way = difference(image_position(*mirror, x), x);
    coord sum = 0;
    for (int d = 0; d < Dim; ++d) sum += g[d] * way[d];
    if (mirror->moves) {
      auto at = x;
      for_each_wall([&](const Panel& w) {
        const coord away = -2 * Sight<Dim>::side(w, at);
        const auto n = Sight<Dim>::as_vec(w.normal);
        at = along(at, away, n);
        sum -= away * dot(w.acceleration.at(below(w)), n);
      });
    }
    return static_cast<real>(sum);
  }

 private:
  // The walls of the path as the image is made: the one next to j first.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_wall(F f) const {
    for (int k = mirror->length; k > 0; --k) f(panels[wall(k - 1)]);
    for (int e = 0; e < 3 && mirror->also[e] >= 0; ++e) f(panels[mirror->also[e]]);
  }

  KOKKOS_INLINE_FUNCTION int wall(int k) const {
    if (k % 2 == 0) return mirror->panel;
    const Joint& q = joints[mirror->joint];
    return q.panel[0] == mirror->panel ? q.panel[1] : q.panel[0];
  }

  // The wall's point nearest to the middle, from the panel's own point.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> below(const Panel& w) const {
    const auto foot = along(middle, -Sight<Dim>::side(w, middle), Sight<Dim>::as_vec(w.normal));
    return difference(foot, Sight<Dim>::as_vec(w.point));
  }

  template <bool sticking>
  KOKKOS_INLINE_FUNCTION Vec<Dim> velocity_at_walls(const Vec<Dim>& u) const {
    Vec<Dim> v = u;
    if (!mirror->moves && !(sticking && mirror->no_slip)) {
      for (int d = 0; d < Dim; ++d) {
        v[d] = 0;
        for (int e = 0; e < Dim; ++e) v[d] += static_cast<real>(mirror->map[d][e]) * u[e];
      }
      return v;
    }
    for_each_wall([&](const Panel& w) {
      const auto u_w = w.moves ? w.velocity.at(below(w)) : Vec<Dim, coord>{};
      coord normal = 0;
      for (int d = 0; d < Dim; ++d) normal += (u_w[d] - v[d]) * w.normal[d];
      for (int d = 0; d < Dim; ++d)
        v[d] = sticking && w.no_slip ? static_cast<real>(2 * u_w[d] - v[d])
                                     : static_cast<real>(v[d] + 2 * normal * w.normal[d]);
    });
    return v;
  }
};

/// Device view of both rows, at the positions that the particles have now.
template <int Dim>
struct Around {
  Read<CoordField> x;
  Read<OffsetField> first, image_first;
  Read<IndexField> index, image_index, image_mirror;
  Read<ScalarField> image_share;
  Kokkos::View<const Mirror*, Device> mirrors;
  Kokkos::View<const Panel*, Device> panels;
  Kokkos::View<const Joint*, Device> joints;

  /// Calls f(j, r_ij, image) for every neighbour and every image of particle i, in the same order each time. r_ij points
  /// from i to the neighbour or image [m].
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each(int i, F f) const {
    const auto xi = load<Dim>(x, i);
    for (auto k = first(i); k < first(i + 1); ++k) {
      const int j = index(k);
      f(j, narrow(difference(load<Dim>(x, j), xi)), Image<Dim>{});
    }
    if (image_first.extent(0) == 0) return;
    for (auto k = image_first(i); k < image_first(i + 1); ++k) {
      const int j = image_index(k);
      const auto xj = load<Dim>(x, j);
      const Mirror* m = &mirrors(image_mirror(k));
      const auto middle = along(xi, coord(0.5), difference(xj, xi));
      f(j, narrow(difference(image_position(*m, xj), xi)),
        Image<Dim>{m, panels.data(), joints.data(), middle, image_share(k)});
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION static Vec<Dim> narrow(const Vec<Dim, coord>& r) {
    Vec<Dim> s;
    for (int d = 0; d < Dim; ++d) s[d] = static_cast<real>(r[d]);
    return s;
  }
};

struct RowOptions {
  Weight weight;             // whose values stand beside the entries
  coord radius = 0;          // of the search: the largest of all weights; at most the grid's cell [m]
  bool keep_weights = true;  // false: whoever needs a weight computes it; a third of the memory
};

class NeighborRows {
 public:
  /// Finds all neighbours and images within the search radius of each particle. The particles must have been sorted
  /// into the grid just before. Capacity grows by itself: rows are counted before they are filled.
  void build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls, const RowOptions& options);

  template <int Dim>
  Around<Dim> around(const Particles& particles, const MirrorWalls& walls) const {
    return {particles.position, near.first,   images.first, near.index,  images.index,
            images.mirror,      images.share, walls.mirror, walls.panel, walls.joint};
  }

  Rows near;
  ImageRows images;  // without walls: never allocated
};

}  // namespace greenwater
