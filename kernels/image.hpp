#pragma once
// What a particle sees of another one: that one itself, or its image by way of walls.

#include "core/lanes.hpp"
#include "kernels/sight.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// The image of one particle by way of walls.
template <int Dim>
struct Image {
  const Mirror* mirror = nullptr;  // null: there is none
  const Panel* panels = nullptr;
  const Joint* joints = nullptr;
  Vec<Dim, coord> middle{};  // between image's particle and the one that sees it [m]: walls that move do so as below it

  /// u of the image of a velocity u. At a wall, with the walls' normal velocity, it slips freely; where the fluid sticks
  /// to the wall and `sticking` is asked for u' = 2 u_w - u.
  template <bool sticking>
  KOKKOS_INLINE_FUNCTION Vec<Dim> velocity(const Vec<Dim>& u) const {
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

  /// What the pressure of the image is above that of its particle at x, per density: (g - a_w) . (x_img - x), wall by
  /// wall.
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

  /// The point of a wall's plane below the middle [m]: there a wall that moves has its say.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> foot(const Panel& w) const {
    return along(middle, -Sight<Dim>::side(w, middle), Sight<Dim>::as_vec(w.normal));
  }

  /// Calls f(panel) for the walls of the path, the one next to the image first.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_wall_backwards(F f) const {
    int others = 0;
    while (others < 3 && mirror->also[others] >= 0) ++others;
    for (int e = others; e > 0; --e) f(panels[mirror->also[e - 1]]);
    for (int k = 0; k < mirror->length; ++k) f(panels[wall(k)]);
  }

 private:
  // The walls of the path as the image is made: the one next to the particle first.
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

  // The foot, from the panel's own point.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> below(const Panel& w) const {
    return difference(foot(w), Sight<Dim>::as_vec(w.point));
  }
};

/// What a pack of particles sees directly: neighbours as they are.
template <int Dim>
struct Itself {
  static constexpr real share = 1;
  bool kept = false;  // the weights of the rows can be taken
  Pack weight_kept{};

  /// share w(r), from r^2 [m^2].
  KOKKOS_INLINE_FUNCTION Pack weight(const Weight& w, const Pack& r2) const { return kept ? weight_kept : w(sqrt(r2)); }
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> velocity(const Vec<Dim, Pack>& u) const { return u; }
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> sticking_velocity(const Vec<Dim, Pack>& u) const { return u; }
  template <class Drive, class X>
  KOKKOS_INLINE_FUNCTION Pack pressure_offset(const Drive&, const X&, const IndexPack&) const {
    return Pack{};
  }
};

/// What a pack of particles sees by way of walls; some lanes may see nothing, and have no share.
template <int Dim>
struct Images {
  Image<Dim> image[pack_lanes];
  Pack share{};       // with which each counts in every sum
  bool kept = false;  // weights are rounded like those of the rows: a mirror image balances its original

  /// share w(r), from r^2 [m^2].
  KOKKOS_INLINE_FUNCTION Pack weight(const Weight& w, const Pack& r2) const {
    const Pack exact = share * w(sqrt(r2));
    return kept ? convert_lanes<Pack>(convert_lanes<Lanes<float, pack_lanes>>(exact)) : exact;
  }

  /// Velocities of the images of velocities: slipping freely at walls.
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> velocity(const Vec<Dim, Pack>& u) const { return mirrored_velocity<false>(u); }

  /// As velocity(); where the fluid sticks to the wall u' = 2 u_w - u.
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> sticking_velocity(const Vec<Dim, Pack>& u) const {
    return mirrored_velocity<true>(u);
  }

  /// What the pressures of the images are above those of their particles j, per density, given what drives particles
  /// and where they are. It belongs to gradients, loads and probes; never to the pressure rows, whose source carries
  /// gravity and the wall's motion already.
  template <class Drive, class X>
  KOKKOS_INLINE_FUNCTION Pack pressure_offset(const Drive& drive, const X& all_x, const IndexPack& j) const {
    const auto g = drive.at(j);
    const auto x = gather_pack<Dim>(all_x, j);
    Pack offset{};
    for (int l = 0; l < pack_lanes; ++l)
      if (image[l].mirror)
        set_lane(offset, l, image[l].pressure_offset(lane_of<Dim, real>(g, l), lane_of<Dim, coord>(x, l)));
    return offset;
  }

 private:
  template <bool sticking>
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> mirrored_velocity(const Vec<Dim, Pack>& u) const {
    auto v = u;
    for (int l = 0; l < pack_lanes; ++l) {
      if (!image[l].mirror) continue;
      const auto w = image[l].template velocity<sticking>(lane_of<Dim, real>(u, l));
      for (int d = 0; d < Dim; ++d) set_lane(v[d], l, w[d]);
    }
    return v;
  }
};

}  // namespace greenwater
