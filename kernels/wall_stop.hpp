#pragma once
// Nobody goes through a wall: ways that would are bent.

#include "kernels/sight.hpp"

namespace greenwater {

// From when to when walls move while particles do, as seen from where the panels stand [s]; both 0: they do not.
struct Sweep {
  coord begin, end;
  KOKKOS_INLINE_FUNCTION bool with_walls() const { return begin != end; }
};

// Where the corners of a piece are at a time.
template <int Dim>
KOKKOS_INLINE_FUNCTION void corners_at(const Panel& w, const Piece& piece, coord time, Vec<Dim, coord>* corner) {
  for (int e = 0; e < Dim; ++e) {
    corner[e] = Sight<Dim>::as_vec(piece.corner[e]);
    corner[e] = along(corner[e], time, w.velocity.at(difference(corner[e], Sight<Dim>::as_vec(w.point))));
  }
}

// Distance of x from the panel as it stands after a time, with the sign of the side that x is on [m].
template <int Dim>
KOKKOS_INLINE_FUNCTION coord side_after(const Sight<Dim>& sight, const Panel& w, coord time, const Vec<Dim, coord>& x) {
  const coord side = sight.side(w, x);
  if (time == 0) return side;
  const auto n = sight.as_vec(w.normal);
  const auto foot = difference(along(x, -side, n), sight.as_vec(w.point));
  return side - time * dot(w.velocity.at(foot), n);
}

// Distance of x from the plane of a piece [m], with the sign of the side that x is on.
template <int Dim>
KOKKOS_INLINE_FUNCTION coord side_of_piece(const Vec<Dim, coord>* c, const Vec<Dim, coord>& x) {
  const auto a = difference(c[1], c[0]), r = difference(x, c[0]);
  if constexpr (Dim == 2) {
    return (a[0] * r[1] - a[1] * r[0]) / sqrt(dot(a, a));
  } else {
    const auto b = difference(c[2], c[0]);
    const Vec<3, coord> n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return dot(n, r) / sqrt(dot(n, n));
  }
}

// Is q, a point in the plane of the corners, between them? A millionth of the piece's size is let pass.
template <int Dim>
KOKKOS_INLINE_FUNCTION bool between(const Vec<Dim, coord>* c, const Vec<Dim, coord>& q) {
  constexpr coord slack = -1e-6;
  const auto a = difference(c[1], c[0]), r = difference(q, c[0]);
  const coord aa = dot(a, a), ar = dot(a, r);
  if constexpr (Dim == 2) {
    return ar >= slack * aa && ar <= (1 - slack) * aa;
  } else {
    const auto b = difference(c[2], c[0]);
    const coord ab = dot(a, b), bb = dot(b, b), br = dot(b, r), det = aa * bb - ab * ab;
    const coord s = (bb * ar - ab * br) / det, t = (aa * br - ab * ar) / det;
    return s >= slack && t >= slack && s + t <= 1 - slack;
  }
}

// Does a particle on its way from x to x + dx meet a panel on its own way? `side` is then the side of the panel, as it
// stands at the end, on which the particle has to end to keep its distance [m].
template <int Dim>
KOKKOS_INLINE_FUNCTION bool meets_moving(const Sight<Dim>& sight, const Panel& w, const Sweep& sweep,
                                         const Vec<Dim, coord>& x, const Vec<Dim, coord>& dx, coord& side) {
  const auto end = along(x, coord(1), dx);
  for (int k = w.first_piece; k < w.last_piece; ++k) {
    Vec<Dim, coord> before[3], then[3];
    corners_at(w, sight.piece[k], sweep.begin, before);
    corners_at(w, sight.piece[k], sweep.end, then);
    const coord from = side_of_piece(before, x), to = side_of_piece(then, end);
    if (from * to > 0 || from == to) continue;
    const coord s = from / (from - to);
    for (int e = 0; e < Dim; ++e) then[e] = along(before[e], s, difference(then[e], before[e]));
    if (!between(then, along(x, s, dx))) continue;
    side = to * side_after(sight, w, sweep.end, end) < 0 ? -from : from;  // the piece may be turned against its panel
    return true;
  }
  return false;
}

// A way from x to x + dx that crosses a wall is bent: along the wall it goes on, towards the wall it ends where it began
// as seen from the wall, and the speed towards the wall becomes the wall's own. Returns whether it was.
template <int Dim>
KOKKOS_INLINE_FUNCTION bool stop_at_walls(const MirrorWalls& walls, const GridShape& grid, const Sweep& sweep,
                                          const Vec<Dim, coord>& x, Vec<Dim, coord>& dx, Vec<Dim>& u) {
  const auto sight = sight_from(walls, grid, x, dot(dx, dx) > grid.cell * grid.cell);
  bool stopped = false;
  Vec<Dim, coord> carried{};
  for (int k = sight.begin; k < sight.end; ++k) {
    if (sight.reach[k] >= sight.panels) break;
    const Panel& w = sight.panel[sight.reach[k]];
    coord side = sight.side(w, x);
    const bool moving = sweep.with_walls() && w.moves;
    if (!(moving ? meets_moving(sight, w, sweep, x, dx, side) : sight.meets(w, x, along(x, coord(1), dx)))) continue;
    const auto n = sight.as_vec(w.normal);
    const auto u_w = w.velocity.at(difference(x, sight.as_vec(w.point)));
    coord speed = 0;
    for (int d = 0; d < Dim; ++d) speed += (u[d] - u_w[d]) * n[d];
    for (int d = 0; d < Dim; ++d) u[d] -= static_cast<real>(speed * n[d]);
    const coord end = moving ? sweep.end : 0;
    dx = along(dx, side - side_after(sight, w, end, along(x, coord(1), dx)), n);
    if (moving) carried = along(Vec<Dim, coord>{}, side - side_after(sight, w, end, x), n);
    stopped = true;
  }
  // Past the end of one wall and into another: stay, or go with the wall.
  if (stopped && !sight.sees(x, along(x, coord(1), dx))) dx = carried;
  return stopped;
}

// Moves particle i by dx, or as far as the walls let it. Returns 1 when they stopped it.
template <int Dim>
KOKKOS_INLINE_FUNCTION int move(const MirrorWalls& walls, const GridShape& grid, const Sweep& sweep,
                                const CoordField& x, const VectorField& u, int i, Vec<Dim, coord> dx, Vec<Dim> ui) {
  const auto xi = load<Dim>(x, i);
  const int stopped = stop_at_walls(walls, grid, sweep, xi, dx, ui) ? 1 : 0;
  store(u, i, ui);
  store(x, i, along(xi, coord(1), dx));
  return stopped;
}

}  // namespace greenwater
