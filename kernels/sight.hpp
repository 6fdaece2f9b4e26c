#pragma once
// Who sees whom: the paths of mirror_wall.hpp, followed.

#include "kernels/mirror_wall.hpp"

namespace greenwater {

/// The piece of walls that a kernel works with: views and the questions of sight near one cell.
template <int Dim>
struct Sight {
  const Panel* panel;  // plain pointers: one of these is made for each particle
  const Piece* piece;
  const Rim* rim;
  const Joint* joint;
  const int* joint_of_panel;
  const Mirror* mirror;
  const int* reach;
  int panels, begin, end;
  coord tolerance;

  using Point = Vec<Dim, coord>;

  KOKKOS_INLINE_FUNCTION static Point as_vec(const coord* c) {
    Point v;
    for (int d = 0; d < Dim; ++d) v[d] = c[d];
    return v;
  }

  KOKKOS_INLINE_FUNCTION static coord side(const Panel& p, const Point& x) {
    return dot(as_vec(p.normal), difference(x, as_vec(p.point)));
  }

  /// Is q, a point of the panel's plane, on the panel?
  KOKKOS_INLINE_FUNCTION bool on_panel(const Panel& p, const Point& q) const {
    for (int k = p.first_piece; k < p.last_piece; ++k) {
      bool in = true;
      for (int e = 0; e < Dim; ++e)
        in = in && dot(as_vec(piece[k].inward[e]), difference(q, as_vec(piece[k].corner[e]))) >= -tolerance;
      if (in) return true;
    }
    return false;
  }

  /// Does the segment from p to q meet the panel? Its ends count, so that nothing slips through along an edge.
  KOKKOS_INLINE_FUNCTION bool meets(const Panel& w, const Point& p, const Point& q) const {
    const coord sp = side(w, p), sq = side(w, q);
    if (sp * sq > 0 || sp == sq) return false;
    return on_panel(w, greenwater::along(p, sp / (sp - sq), difference(q, p)));
  }

  /// Do a and b see each other?
  KOKKOS_INLINE_FUNCTION bool sees(const Point& a, const Point& b) const {
    for (int k = begin; k < end && reach[k] < panels; ++k)
      if (meets(panel[reach[k]], a, b)) return false;
    return true;
  }

  /// The share with which a sees the image of b in mirror number k (and b that of a in its reverse), given that it has a
  /// distance: 1 as a rule, less where the path passes close to the edge of a corner, 0 where it is not seen. a may be b:
  /// its own image.
  KOKKOS_INLINE_FUNCTION real sees_image(int k, const Point& a, const Point& b) const {
    const Mirror& m = mirror[k];
    Spared spared;
    coord share = 1;
    if (m.length > 1) {
      share = share_at(joint[m.joint], m.panel, m.length, a, b);
      if (!(share > 0)) return 0;
      spared.add(joint[m.joint].panel[0]);
      spared.add(joint[m.joint].panel[1]);
    } else if (m.length == 1) {
      share *= share_of_panel(m.panel, a, b, k < panels, spared);
    }
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e) share *= share_of_panel(m.also[e], a, b, false, spared);
    if (!(share > 0)) return 0;
    Point from_a, from_b;
    if (!first_bounce(m, a, b, from_a, spared) || !open(a, from_a, spared)) return 0;
    if (m.length == 0 && outside_at_edge(m, a, b, from_a)) return 0;
    if (k < panels) return open(from_a, b, spared) ? static_cast<real>(share) : real(0);
    if (!first_bounce(mirror[m.reverse], b, a, from_b, spared)) return 0;
    return open(from_b, b, spared) && open(from_a, from_b, spared) ? static_cast<real>(share) : real(0);
  }

  /// Leaves out the walls and corners that nobody at x can reach within `radius`, if the rest fits into `room`.
  KOKKOS_INLINE_FUNCTION void narrow(const Point& x, coord radius, int* room, int capacity) {
    int count = 0;
    for (int k = begin; k < end; ++k) {
      if (!within(mirror[reach[k]], x, radius)) continue;
      if (count == capacity) return;
      room[count++] = reach[k];
    }
    reach = room;
    begin = 0;
    end = count;
  }

  /// Is everything that x can reach in front of, or behind, one wall that goes on beyond it on all sides? Then what is in
  /// sight, and what has an image, is a question of distances alone. After narrow().
  KOKKOS_INLINE_FUNCTION bool one_endless_wall(const Point& x, coord radius) const {
    if (end - begin != 1 || reach[begin] >= panels) return false;
    const Panel& w = panel[reach[begin]];
    if (w.first_rim < 0) return false;
    const auto foot = greenwater::along(x, -side(w, x), as_vec(w.normal));
    if (!on_panel(w, foot)) return false;
    for (int k = w.first_rim; k < w.last_rim; ++k) {
      const auto a = as_vec(rim[k].a), edge = difference(as_vec(rim[k].b), a);
      const auto r = difference(foot, a);
      const coord length2 = dot(edge, edge), s = length2 > 0 ? dot(r, edge) / length2 : coord(0);
      const auto off = greenwater::along(r, -(s < 0 ? coord(0) : s > 1 ? coord(1) : s), edge);
      if (dot(off, off) < radius * radius) return false;
    }
    return true;
  }

  /// Square of the distance from a to the image of b [m^2], which are sqrt(r2) apart; infinite where a wall of the path
  /// is not between them. The same number from b to the image of a in the reverse.
  KOKKOS_INLINE_FUNCTION coord image_distance2(int k, const Point& a, const Point& b, coord r2) const {
    constexpr coord nowhere = 1e300;
    const Mirror& m = mirror[k];
    // Walls at right angles to each other add up: |a - b'|^2 = |a - b|^2 + 4 s_a s_b.
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e) {
      const coord both = side(panel[m.also[e]], a) * side(panel[m.also[e]], b);
      if (!(both > 0)) return nowhere;
      r2 += 4 * both;
    }
    if (m.length == 0) return r2;
    const coord both = side(panel[m.panel], a) * side(panel[m.panel], b);
    if (!(both > 0)) return nowhere;
    if (m.length == 1) return r2 + 4 * both;
    const auto way = difference(image_position(m, b), a);
    return dot(way, way);
  }

 private:
  KOKKOS_INLINE_FUNCTION bool within(const Panel& p, const Point& x, coord radius) const {
    const auto r = difference(x, as_vec(p.middle));
    const coord most = p.extent + radius;
    return fabs(side(p, x)) < radius && dot(r, r) < most * most;
  }

  KOKKOS_INLINE_FUNCTION bool within(const Mirror& m, const Point& x, coord radius) const {
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e)
      if (!within(panel[m.also[e]], x, radius)) return false;
    if (m.length == 0) return true;
    if (m.length == 1) return within(panel[m.panel], x, radius);
    return within(panel[joint[m.joint].panel[0]], x, radius) && within(panel[joint[m.joint].panel[1]], x, radius);
  }

  // Panels that a path touches by right: they do not hide it from anybody.
  struct Spared {
    int panel[8];
    int count = 0;
    KOKKOS_INLINE_FUNCTION void add(int p) {
      if (!has(p) && count < 8) panel[count++] = p;
    }
    KOKKOS_INLINE_FUNCTION bool has(int p) const {
      for (int k = 0; k < count; ++k)
        if (panel[k] == p) return true;
      return false;
    }
  };

  KOKKOS_INLINE_FUNCTION bool open(const Point& p, const Point& q, const Spared& spared) const {
    for (int k = begin; k < end; ++k) {
      const int f = reach[k];
      if (f >= panels) return true;  // from here on: corners
      if (!spared.has(f) && meets(panel[f], p, q)) return false;
    }
    return true;
  }

  // Is x inside the corner? Its angle is measured from the joint's first panel.
  KOKKOS_INLINE_FUNCTION bool inside(const Joint& q, const Point& x, coord& angle) const {
    const auto r = difference(x, as_vec(q.point));
    if constexpr (Dim == 3) {
      const coord z = dot(as_vec(q.edge), r);
      if (z < q.low - tolerance || z > q.high + tolerance) return false;
    }
    angle = atan2(dot(as_vec(q.across), r), dot(as_vec(q.along[0]), r));
    if (q.angle > half_turn && angle < -half_turn / 2) angle += 2 * half_turn;
    return angle > 0 && angle < q.angle;
  }

  // The line to the image sweeps this angle round the edge; beyond 180 degrees the path round the edge's other side is
  // the shorter one. Shares fall from 1 to 0 there, and those of both sides make up 1.
  KOKKOS_INLINE_FUNCTION coord share_at(const Joint& q, int first, int length, const Point& a, const Point& b) const {
    coord at_a, at_b;
    if (!inside(q, a, at_a) || !inside(q, b, at_b)) return 0;
    if (first != q.panel[0]) {
      at_a = q.angle - at_a;
      at_b = q.angle - at_b;
    }
    return share_of_sweep(q, at_a + (length % 2 == 1 ? (length - 1) * q.angle + at_b : length * q.angle - at_b));
  }

  KOKKOS_INLINE_FUNCTION static coord share_of_sweep(const Joint& q, coord sweep) {
    const coord left = (q.angle > half_turn ? q.angle : half_turn) - sweep;
    if (left >= q.blend + 1e-9) return 1;
    if (left <= -q.blend - 1e-9) return 0;
    return q.blend > 1e-6 ? 0.5 + 0.5 * left / q.blend : 0.5;
  }

  // The corners at the panel's ends, as far as a and b are both inside. In a corner of walls (not alone) one that bends
  // goes on where its panels meet.
  KOKKOS_INLINE_FUNCTION coord share_of_panel(int p, const Point& a, const Point& b, bool alone, Spared& spared) const {
    spared.add(p);
    coord share = 1;
    for (int k = panel[p].first_joint; k < panel[p].last_joint; ++k) {
      const Joint& q = joint[joint_of_panel[k]];
      coord at_a, at_b;
      if (Dim == 2 && !alone && panel[q.panel[0]].bends && panel[q.panel[1]].bends && q.angle > blunt) continue;
      if (!inside(q, a, at_a) || !inside(q, b, at_b)) continue;
      share *= p == q.panel[0] ? share_of_sweep(q, at_a + at_b) : share_of_sweep(q, 2 * q.angle - at_a - at_b);
      spared.add(q.panel[0] == p ? q.panel[1] : q.panel[0]);
    }
    return share;
  }

  // Where the path from a to the image of b comes to its first wall. False when it misses the wall's end.
  KOKKOS_INLINE_FUNCTION bool first_bounce(const Mirror& m, const Point& a, const Point& b, Point& at,
                                           Spared& spared) const {
    const auto line = difference(image_position(m, b), a);
    coord least = 2;
    int wall = -1;
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e) way_to(m.also[e], a, line, least, wall);
    if (m.length > 0) way_to(m.panel, a, line, least, wall);
    if (wall < 0) {  // past the edge: the path touches it
      if (m.length <= 1) return false;
      const Joint& q = joint[m.joint];
      at = as_vec(q.point);
      if constexpr (Dim == 3) {
        const auto middle = greenwater::along(a, coord(0.5), line);
        at = greenwater::along(at, dot(as_vec(q.edge), difference(middle, at)), as_vec(q.edge));
      }
      return true;
    }
    at = greenwater::along(a, least, line);
    if (on_panel(panel[wall], at) || at_edge(wall, a, b, at)) return true;
    return m.length != 1 && goes_on(panel[wall], at, spared);
  }

  // A path that leads to the very edge of a right-angled corner, as that to one's own image does, comes there from outside as
  // well as from inside. Inside is where all walls go on from there.
  KOKKOS_INLINE_FUNCTION bool outside_at_edge(const Mirror& m, const Point& a, const Point& b, const Point& at) const {
    constexpr coord onward = 0.1;
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e)
      if (fabs(side(panel[m.also[e]], at)) > tolerance) return false;
    for (int e = 0; e < 3 && m.also[e] >= 0; ++e) {
      const Panel& w = panel[m.also[e]];
      const auto foot = greenwater::along(a, -side(w, a), as_vec(w.normal));
      auto further = greenwater::along(at, onward, difference(foot, at));
      if (!on_panel(w, further) && !at_edge(m.also[e], a, b, further)) return true;
    }
    return false;
  }

  // A point of the plane of a wall that bends, beyond its end: is another panel of that wall there, nearly in the plane?
  // It is then spared.
  KOKKOS_INLINE_FUNCTION bool goes_on([[maybe_unused]] const Panel& w, [[maybe_unused]] const Point& at,
                                      [[maybe_unused]] Spared& spared) const {
    if constexpr (Dim == 2) {
      constexpr coord nearly = 0.94;  // cosine of 20 degrees
      for (int k = begin; w.bends && k < end && reach[k] < panels; ++k) {
        const Panel& other = panel[reach[k]];
        if (other.body != w.body || dot(as_vec(other.normal), as_vec(w.normal)) < nearly) continue;
        const coord off = side(other, at);
        if (fabs(off) > other.extent || !on_panel(other, greenwater::along(at, -off, as_vec(other.normal)))) continue;
        spared.add(reach[k]);
        return true;
      }
    }
    return false;
  }

  KOKKOS_INLINE_FUNCTION void way_to(int p, const Point& a, const Point& line, coord& least, int& wall) const {
    const coord from = side(panel[p], a), slope = dot(as_vec(panel[p].normal), line);
    const coord t = slope == 0 ? coord(2) : -from / slope;
    if (!(t >= 0 && t < least && t <= 1)) return;
    least = t;
    wall = p;
  }

  // A point of the panel's plane beyond the edge of a corner that a and b are in moves onto that edge.
  KOKKOS_INLINE_FUNCTION bool at_edge(int p, const Point& a, const Point& b, Point& at) const {
    for (int k = panel[p].first_joint; k < panel[p].last_joint; ++k) {
      const Joint& q = joint[joint_of_panel[k]];
      coord at_a, at_b;
      if (!inside(q, a, at_a) || !inside(q, b, at_b)) continue;
      const auto along = as_vec(q.along[q.panel[0] == p ? 0 : 1]);
      const coord beyond = dot(along, difference(at, as_vec(q.point)));
      if (beyond > 0) continue;
      at = greenwater::along(at, -beyond, along);
      return true;
    }
    return false;
  }

  static constexpr coord half_turn = 3.14159265358979323846;
  static constexpr coord blunt = half_turn * 8 / 9;
};

/// What can be met within one radius of x; empty without walls. `far`: at any distance.
template <int Dim>
KOKKOS_INLINE_FUNCTION Sight<Dim> sight_from(const MirrorWalls& walls, const GridShape& grid, const Vec<Dim, coord>& x,
                                             bool far = false) {
  int begin = 0, end = 0;
  if (walls.count > 0) {
    const int c = far ? grid.count() : grid.cell_of(x);
    begin = walls.first(c);
    end = walls.first(c + 1);
  }
  return {walls.panel.data(),
          walls.piece.data(),
          walls.rim.data(),
          walls.joint.data(),
          walls.joint_of_panel.data(),
          walls.mirror.data(),
          walls.reach.data(),
          walls.panels,
          begin,
          end,
          walls.tolerance};
}

}  // namespace greenwater
