#include "kernels/wall_panels.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/wall_corners.hpp"

namespace greenwater {

using namespace wall_geometry;

namespace {

// A face with what can be said of it alone.
struct Raw {
  Piece piece{};
  Vector normal;
  LinearField velocity{}, acceleration{};
  Bounds bounds;
  int face = 0;
  bool moves = false;
};

LinearField linear(const Piece& piece, const std::array<Vector, 3>& at_corners, int dim) {
  coord value[3][3];
  for (int e = 0; e < 3; ++e) put(value[e], at_corners[e]);
  return dim == 2 ? linear_field<2>(piece, value) : linear_field<3>(piece, value);
}

bool degenerate(const std::array<Vector, 3>& c, int dim, coord tolerance) {
  if (dim == 2) return (c[1] - c[0]).norm() < tolerance;
  const coord longest = std::max({(c[1] - c[0]).norm(), (c[2] - c[0]).norm(), (c[2] - c[1]).norm()});
  return (c[1] - c[0]).cross(c[2] - c[0]).norm() < tolerance * longest;
}

std::vector<Raw> raw_pieces(const WallFaces& walls, coord tolerance) {
  std::vector<Raw> raw;
  for (std::size_t f = 0; f < walls.faces.size(); ++f) {
    std::array<Vector, 3> at, velocity, acceleration;
    for (int e = 0; e < 3; ++e) {
      const WallPoint& point = walls.faces[f].corner[walls.dim == 2 ? e % 2 : e];
      at[e] = vec(point.position);
      velocity[e] = vec(point.velocity);
      acceleration[e] = vec(point.acceleration);
    }
    if (degenerate(at, walls.dim, tolerance)) continue;
    Raw r;
    r.face = static_cast<int>(f);
    r.moves = walls.bodies[walls.faces[f].body].bends;
    r.normal = vec(face_normal(corners_of(walls.faces[f]), walls.dim));
    for (int e = 0; e < walls.dim; ++e) {
      put(r.piece.corner[e], at[e]);
      const Vector along = at[(e + 1) % walls.dim] - at[e];
      put(r.piece.inward[e], (walls.dim == 2 ? along : Vector(r.normal.cross(along))).normalized());
      r.moves = r.moves || velocity[e].squaredNorm() > 0 || acceleration[e].squaredNorm() > 0;
    }
    r.velocity = linear(r.piece, velocity, walls.dim);
    r.acceleration = linear(r.piece, acceleration, walls.dim);
    r.bounds = {at[0].cwiseMin(at[1]), at[0].cwiseMax(at[1])};
    if (walls.dim == 3) r.bounds.take_in({at[2], at[2]});
    raw.push_back(r);
  }
  return raw;
}

Vector value_at(const LinearField& field, const Vector& from_point) {
  Vector v = vec(field.value);
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 3; ++e) v[d] += field.gradient[d][e] * from_point[e];
  return v;
}

bool moves_alike(const Raw& a, const Raw& b, int dim) {
  if (a.moves != b.moves) return false;
  if (!a.moves) return true;
  for (int e = 0; e < dim; ++e) {
    const Vector r = corner(b.piece, e) - corner(a.piece, 0), s = corner(b.piece, e) - corner(b.piece, 0);
    const Vector v = value_at(b.velocity, s), c = value_at(b.acceleration, s);
    if ((value_at(a.velocity, r) - v).norm() > 1e-9 * v.norm() + 1e-12) return false;
    if ((value_at(a.acceleration, r) - c).norm() > 1e-9 * c.norm() + 1e-9) return false;
  }
  return true;
}

// Two pieces of one plane: do they share more than a point (2-D: a point)?
bool adjoin(const Raw& a, const Raw& b, int dim, coord tolerance) {
  if (dim == 2) {
    for (int e = 0; e < 2; ++e)
      if (contains(a.piece, 2, corner(b.piece, e), tolerance) || contains(b.piece, 2, corner(a.piece, e), tolerance))
        return true;
    return false;
  }
  // Two places of one on the other, a good way apart.
  std::vector<Vector> shared;
  for (const auto& [one, other] : {std::pair{&a, &b}, std::pair{&b, &a}})
    for (int e = 0; e < 3; ++e) {
      const Vector from = corner(one->piece, e), to = corner(one->piece, (e + 1) % 3);
      for (const coord s : {0.0, 0.5})
        if (const Vector q = from + s * (to - from); contains(other->piece, 3, q, tolerance)) shared.push_back(q);
    }
  for (const Vector& p : shared)
    for (const Vector& q : shared)
      if ((p - q).norm() > 10 * tolerance) return true;
  return false;
}

bool one_panel(const WallFaces& walls, const Raw& a, const Raw& b, coord tolerance) {
  if (a.normal.cross(b.normal).norm() > parallel) return false;
  for (int e = 0; e < walls.dim; ++e)
    if (std::fabs(a.normal.dot(corner(b.piece, e) - corner(a.piece, 0))) > tolerance) return false;
  const WallBody &body_a = walls.bodies[walls.faces[a.face].body], &body_b = walls.bodies[walls.faces[b.face].body];
  if (body_a.bends || body_b.bends) return false;
  return body_a.no_slip == body_b.no_slip && moves_alike(a, b, walls.dim) && adjoin(a, b, walls.dim, tolerance);
}

struct Groups {  // union and find
  std::vector<int> parent;
  explicit Groups(std::size_t count) : parent(count) { std::iota(parent.begin(), parent.end(), 0); }
  int of(int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(int i, int j) { parent[std::max(of(i), of(j))] = std::min(of(i), of(j)); }
};

// The rim of a panel: ends and edges of pieces that are not those of another piece too. Where an edge meets only a part of
// another one both count, although they are inside: a rim too much costs time and nothing else.
void add_rim(Panel& panel, WallPanels& made, int dim, coord tolerance) {
  constexpr int most = 64;  // pieces
  panel.first_rim = panel.last_rim = -1;
  if (panel.last_piece - panel.first_piece > most) return;
  panel.first_rim = static_cast<int>(made.rims.size());
  const auto same = [&](const Vector& a, const Vector& b) { return (a - b).norm() <= tolerance; };
  for (int k = panel.first_piece; k < panel.last_piece; ++k)
    for (int e = 0; e < dim; ++e) {
      const Vector a = corner(made.pieces[k], e), b = dim == 2 ? a : corner(made.pieces[k], (e + 1) % 3);
      bool inside = false;
      for (int m = panel.first_piece; m < panel.last_piece && !inside; ++m) {
        if (m == k) continue;
        if (dim == 2) inside = contains(made.pieces[m], 2, a, tolerance);
        for (int f = 0; f < 3 && dim == 3 && !inside; ++f) {
          const Vector c = corner(made.pieces[m], f), d = corner(made.pieces[m], (f + 1) % 3);
          inside = (same(a, c) && same(b, d)) || (same(a, d) && same(b, c));
        }
      }
      if (inside) continue;
      Rim rim{};
      put(rim.a, a);
      put(rim.b, b);
      made.rims.push_back(rim);
    }
  panel.last_rim = static_cast<int>(made.rims.size());
}

// Bounds of each panel, in the order of the panels.
std::vector<Bounds> make_panels(const WallFaces& walls, const std::vector<Raw>& raw, coord tolerance,
                                WallPanels& made) {
  std::vector<Bounds> piece_bounds;
  for (const Raw& r : raw) piece_bounds.push_back(r.bounds);
  Groups groups(raw.size());
  for_each_touching(piece_bounds, tolerance, [&](int i, int j) {
    if (groups.of(i) != groups.of(j) && one_panel(walls, raw[i], raw[j], tolerance)) groups.join(i, j);
  });
  std::vector<std::vector<int>> members(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) members[groups.of(static_cast<int>(i))].push_back(static_cast<int>(i));
  std::vector<Bounds> bounds;
  for (const auto& group : members) {
    if (group.empty()) continue;
    const Raw& lead = raw[group.front()];
    Panel panel{};
    put(panel.normal, lead.normal);
    put(panel.point, corner(lead.piece, 0));
    panel.first_piece = static_cast<int>(made.pieces.size());
    panel.body = walls.faces[lead.face].body;
    panel.face = lead.face;
    panel.no_slip = walls.bodies[panel.body].no_slip;
    panel.moves = lead.moves;
    panel.bends = walls.bodies[panel.body].bends;
    panel.velocity = lead.velocity;
    panel.acceleration = lead.acceleration;
    bounds.push_back(lead.bounds);
    for (const int i : group) {
      made.pieces.push_back(raw[i].piece);
      bounds.back().take_in(raw[i].bounds);
    }
    panel.last_piece = static_cast<int>(made.pieces.size());
    add_rim(panel, made, walls.dim, tolerance);
    put(panel.middle, (bounds.back().low + bounds.back().high) / 2);
    panel.extent = (bounds.back().high - bounds.back().low).norm() / 2;
    made.panels.push_back(panel);
  }
  return bounds;
}

}  // namespace

WallPanels find_panels(const WallFaces& faces, coord tolerance) {
  WallPanels made;
  const std::vector<Bounds> bounds = make_panels(faces, raw_pieces(faces, tolerance), tolerance, made);
  add_mirrors(faces, bounds, tolerance, made);
  return made;
}

}  // namespace greenwater
