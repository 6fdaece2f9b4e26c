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
  Vec<Dim, coord> particle{}, seen_from{};  // where the image's particle is, and the one that sees it [m]

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
    for_each_wall_from_particle([&](const Panel& w, const Vec<Dim, coord>& at) {
      const auto u_w = w.moves ? w.velocity.at(on(w, at)) : Vec<Dim, coord>{};
      coord normal = 0;
      for (int d = 0; d < Dim; ++d) normal += (u_w[d] - v[d]) * w.normal[d];
      for (int d = 0; d < Dim; ++d)
        v[d] = sticking && w.no_slip ? static_cast<real>(2 * u_w[d] - v[d])
                                     : static_cast<real>(v[d] + 2 * normal * w.normal[d]);
    });
    return v;
  }

  /// From the particle to its image [m].
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> way_of_particle() const {
    return difference(image_position(*mirror, particle), particle);
  }

  /// What the pressure of the image is above that of its particle, per density: (g - a_w) . (x_img - x), wall by wall.
  KOKKOS_INLINE_FUNCTION real pressure_offset(const Vec<Dim>& g) const {
    const auto way = way_of_particle();
    coord sum = 0;
    for (int d = 0; d < Dim; ++d) sum += g[d] * way[d];
    if (mirror->moves) {
      auto y = particle;
      for_each_wall_from_particle([&](const Panel& w, const Vec<Dim, coord>& at) {
        const coord away = -2 * Sight<Dim>::side(w, y);
        const auto n = Sight<Dim>::as_vec(w.normal);
        y = along(y, away, n);
        sum -= away * dot(w.acceleration.at(on(w, at)), n);
      });
    }
    return static_cast<real>(sum);
  }

  /// Calls f(panel, place) for the walls of the path as it comes to them from the one that sees, with the place of the
  /// wall's plane where it is thrown back [m]. The length of a path changes with the wall's normal speed there: so there
  /// a wall that moves has its say, and the divergence of a flow that turns with its walls is 0 to the last digit.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_wall(F f) const {
    walk(seen_from, image_position(*mirror, particle), 0, 1, f);
  }

 private:
  // The same path backwards.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_wall_from_particle(F f) const {
    Vec<Dim, coord> image_of_seer{};  // the map is orthogonal
    for (int d = 0; d < Dim; ++d)
      for (int e = 0; e < Dim; ++e) image_of_seer[d] += mirror->map[e][d] * (seen_from[e] - mirror->shift[e]);
    walk(particle, image_of_seer, mirror->length - 1, -1, f);
  }

  // Follows the straight line to an image, and reflects that at every wall that it meets; walls of the corner in turn,
  // beginning with number `next`, the others whenever the line comes to them.
  template <class F>
  KOKKOS_INLINE_FUNCTION void walk(Vec<Dim, coord> at, Vec<Dim, coord> image, int next, int turn, F f) const {
    bool met[3] = {};
    for (int in_turn = mirror->length;;) {
      const Panel* wall = in_turn > 0 ? &panels[wall_of_corner(next)] : nullptr;
      coord part = wall ? way_to(*wall, at, image) : coord(0);
      int other = -1;
      for (int e = 0; e < 3 && mirror->also[e] >= 0; ++e) {
        if (met[e]) continue;
        const coord t = way_to(panels[mirror->also[e]], at, image);
        if (wall && t >= part) continue;
        other = e;
        part = t;
        wall = &panels[mirror->also[e]];
      }
      if (!wall) return;
      if (other >= 0) met[other] = true;
      if (other < 0) {
        --in_turn;
        next += turn;
      }
      at = along(at, part, difference(image, at));
      f(*wall, at);
      image = along(image, -2 * Sight<Dim>::side(*wall, image), Sight<Dim>::as_vec(wall->normal));
    }
  }

  // Which part of the line from a to b is before the wall's plane.
  KOKKOS_INLINE_FUNCTION static coord way_to(const Panel& w, const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) {
    const coord from = Sight<Dim>::side(w, a), between = from - Sight<Dim>::side(w, b);
    return between == 0 ? coord(0.5) : from / between;
  }

  KOKKOS_INLINE_FUNCTION int wall_of_corner(int k) const {
    if (k % 2 == 0) return mirror->panel;
    const Joint& q = joints[mirror->joint];
    return q.panel[0] == mirror->panel ? q.panel[1] : q.panel[0];
  }

  // A place as the wall's fields want it: from the panel's own point.
  KOKKOS_INLINE_FUNCTION static Vec<Dim, coord> on(const Panel& w, const Vec<Dim, coord>& at) {
    return difference(at, Sight<Dim>::as_vec(w.point));
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
  template <class Drive>
  KOKKOS_INLINE_FUNCTION Pack pressure_offset(const Drive&, const IndexPack&) const {
    return Pack{};
  }
};

/// What a pack of particles sees by way of walls; some lanes may see nothing, and have no share.
template <int Dim>
struct Images {
  Image<Dim> image[pack_lanes];
  Pack share{};       // with which each counts in every sum
  bool kept = false;  // weights are rounded like those of the rows: a mirror image balances its original

  /// Whether lane l sees any.
  KOKKOS_INLINE_FUNCTION bool there(int l) const { return image[l].mirror != nullptr; }

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

  /// From the particles to their images [m].
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> way_of_particle() const {
    Vec<Dim, Pack> way{};
    for (int l = 0; l < pack_lanes; ++l) {
      if (!image[l].mirror) continue;
      const auto by = image[l].way_of_particle();
      for (int d = 0; d < Dim; ++d) set_lane(way[d], l, static_cast<real>(by[d]));
    }
    return way;
  }

  /// What the pressures of the images are above those of their particles j, per density, given what drives particles. It
  /// belongs to gradients, loads and probes; never to the pressure rows, whose source carries gravity and the wall's motion
  /// already.
  template <class Drive>
  KOKKOS_INLINE_FUNCTION Pack pressure_offset(const Drive& drive, const IndexPack& j) const {
    const auto g = drive.at(j);
    Pack offset{};
    for (int l = 0; l < pack_lanes; ++l)
      if (image[l].mirror) set_lane(offset, l, image[l].pressure_offset(lane_of<Dim, real>(g, l)));
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
