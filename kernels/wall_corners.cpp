#include "kernels/wall_corners.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"

namespace greenwater {

using namespace wall_geometry;

namespace {

constexpr coord right_angle = 1e-9;    // cosine below which two panels stand at right angles
constexpr coord sharpest = M_PI / 36;  // 5 degrees
// Above 160 degrees a path of two reflections grazes both walls: left out, as in a finely cut surface they are many.
constexpr coord bluntest = M_PI * 8 / 9;
// Of a joint that bends a little: lattices have many pairs that lie evenly about it, and in a narrower blend these would have a
// whole image in each panel.
constexpr coord least_blend = M_PI / 18;

struct Edge {
  Vector point, direction;
  coord low = 0, high = 0;
};

// The part of the segment that lies on the panel, as lengths from its start; empty when low > high.
std::pair<coord, coord> part_on(const WallPanels& made, const Panel& panel, const Vector& from, const Vector& to,
                                coord tolerance) {
  const Vector n = normal_of(panel), p = vec(panel.point);
  const coord length = (to - from).norm();
  coord low = 1, high = 0;
  if (std::fabs(n.dot(from - p)) > tolerance || std::fabs(n.dot(to - p)) > tolerance) return {low, high};
  const Vector along = (to - from) / length;
  bool any = false;
  for (int k = panel.first_piece; k < panel.last_piece; ++k) {
    coord enter = 0, leave = length;
    for (int e = 0; e < 3; ++e) {
      const Vector in = vec(made.pieces[k].inward[e]);
      const coord start = in.dot(from - corner(made.pieces[k], e)) + tolerance, slope = in.dot(along);
      if (std::fabs(slope) * length < tolerance / 10) {
        if (start < 0) leave = -1;
      } else if (slope > 0) {
        enter = std::max(enter, -start / slope);
      } else {
        leave = std::min(leave, -start / slope);
      }
    }
    if (enter > leave) continue;
    low = any ? std::min(low, enter) : enter;
    high = any ? std::max(high, leave) : leave;
    any = true;
  }
  return any ? std::pair{low, high} : std::pair<coord, coord>{1, 0};
}

// Of two triangles of one surface that bends: their common side, if they have one. Where they only share a corner, nearly in
// one plane, their other sides come closer than any tolerance, and are no edge.
bool find_common_side(const WallPanels& made, const Panel& f, const Panel& g, coord tolerance, Edge& edge) {
  const Piece &one = made.pieces[f.first_piece], &other = made.pieces[g.first_piece];
  std::vector<Vector> shared;
  for (int e = 0; e < 3; ++e)
    for (int k = 0; k < 3; ++k)
      if ((corner(one, e) - corner(other, k)).norm() < tolerance) shared.push_back(corner(one, e));
  if (shared.size() != 2) return false;
  const Vector along = shared[1] - shared[0];
  edge = {shared[0], along.normalized(), 0, along.norm()};
  return true;
}

bool find_edge_3d(const WallPanels& made, const Panel& f, const Panel& g, coord tolerance, Edge& edge) {
  if (f.bends && g.bends && f.body == g.body) return find_common_side(made, f, g, tolerance, edge);
  bool found = false;
  for (const auto& [one, other] : {std::pair{&f, &g}, std::pair{&g, &f}})
    for (int k = one->first_piece; k < one->last_piece; ++k)
      for (int e = 0; e < 3; ++e) {
        const Vector from = corner(made.pieces[k], e), to = corner(made.pieces[k], (e + 1) % 3);
        const auto [low, high] = part_on(made, *other, from, to, tolerance);
        if (high - low < 10 * tolerance) continue;
        if (!found) {
          edge = {from, (to - from).normalized(), low, high};
          found = true;
          continue;
        }
        for (const coord s : {low, high}) {
          const coord at = edge.direction.dot(from + s * (to - from).normalized() - edge.point);
          edge.low = std::min(edge.low, at);
          edge.high = std::max(edge.high, at);
        }
      }
  return found;
}

bool find_edge_2d(const WallPanels& made, const Panel& f, const Panel& g, coord tolerance, Edge& edge) {
  edge.direction = {0, 0, 1};
  for (const auto& [one, other] : {std::pair{&f, &g}, std::pair{&g, &f}})
    for (int k = one->first_piece; k < one->last_piece; ++k)
      for (int m = other->first_piece; m < other->last_piece; ++m)
        for (int e = 0; e < 2; ++e) {
          const Piece& piece = made.pieces[m];
          edge.point = corner(made.pieces[k], e);
          if (distance_to_segment(corner(piece, 0), corner(piece, 1), edge.point) < tolerance) return true;
        }
  // Two walls that cross.
  for (int k = f.first_piece; k < f.last_piece; ++k)
    for (int m = g.first_piece; m < g.last_piece; ++m) {
      const Vector a = corner(made.pieces[k], 0), ab = corner(made.pieces[k], 1) - a;
      const Vector c = corner(made.pieces[m], 0), cd = corner(made.pieces[m], 1) - c;
      const coord cross = ab[0] * cd[1] - ab[1] * cd[0];
      if (std::fabs(cross) < parallel * ab.norm() * cd.norm()) continue;
      const coord s = ((c - a)[0] * cd[1] - (c - a)[1] * cd[0]) / cross;
      const coord t = ((c - a)[0] * ab[1] - (c - a)[1] * ab[0]) / cross;
      edge.point = a + s * ab;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) return true;
    }
  return false;
}

bool reaches(const WallPanels& made, const Panel& panel, int dim, const Vector& from, const Vector& way, coord least) {
  for (int k = panel.first_piece; k < panel.last_piece; ++k)
    for (int e = 0; e < dim; ++e)
      if (way.dot(corner(made.pieces[k], e) - from) > least) return true;
  return false;
}

// ---- Mirrors

struct Isometry {
  Matrix map = Matrix::Identity();
  Vector shift = Vector::Zero();
};

// x -> first(second(x))
Isometry chain(const Isometry& first, const Isometry& second) {
  return {first.map * second.map, first.map * second.shift + first.shift};
}

Isometry reflection(const Panel& panel) {
  const Vector n = normal_of(panel);
  return {Matrix::Identity() - 2 * n * n.transpose(), 2 * n.dot(vec(panel.point)) * n};
}

Mirror make_mirror(const WallPanels& made, int joint, int panel, int length, const std::vector<int>& also) {
  Mirror m{};
  m.length = length;
  m.panel = panel;
  m.joint = joint;
  m.reverse = static_cast<int>(made.mirrors.size());
  Isometry way;
  int wall = panel;
  const auto take = [&](int p) {
    way = chain(way, reflection(made.panels[p]));
    m.moves = m.moves || made.panels[p].moves;
    m.no_slip = m.no_slip || made.panels[p].no_slip;
  };
  for (int k = 0; k < length; ++k) {
    take(wall);
    if (joint >= 0) wall = made.joints[joint].panel[made.joints[joint].panel[0] == wall ? 1 : 0];
  }
  for (int e = 0; e < 3; ++e) m.also[e] = e < static_cast<int>(also.size()) ? also[e] : -1;
  for (const int p : also) take(p);
  for (int d = 0; d < 3; ++d) {
    m.shift[d] = way.shift[d];
    for (int e = 0; e < 3; ++e) m.map[d][e] = way.map(d, e);
  }
  return m;
}

// All paths of two reflections and more in one corner; those of an even number come in pairs, each the other backwards.
void add_words(WallPanels& made, int joint, const std::vector<int>& also) {
  const Joint q = made.joints[joint];
  if (q.angle > bluntest) return;
  for (int length = 2; (length - 1) * q.angle < M_PI + q.blend - 1e-9; ++length) {
    const int first = static_cast<int>(made.mirrors.size());
    for (int k = 0; k < 2; ++k) made.mirrors.push_back(make_mirror(made, joint, q.panel[k], length, also));
    if (length % 2 == 0) std::swap(made.mirrors[first].reverse, made.mirrors[first + 1].reverse);
  }
}

// What is known of two panels that touch.
struct Corner {
  int f, g;
  Edge edge;
  std::vector<int> joints;  // empty: right-angled
};

void add_joints(const WallFaces& walls, WallPanels& made, Corner& corner_of, coord tolerance) {
  const Panel &f = made.panels[corner_of.f], &g = made.panels[corner_of.g];
  const Edge& edge = corner_of.edge;
  const Vector along_f = edge.direction.cross(normal_of(f)).normalized();
  const Vector along_g = edge.direction.cross(normal_of(g)).normalized();
  for (const coord s : {1.0, -1.0})
    for (const coord t : {1.0, -1.0}) {
      const Vector a = s * along_f, b = t * along_g;
      if (!reaches(made, f, walls.dim, edge.point, a, 10 * tolerance)) continue;
      if (!reaches(made, g, walls.dim, edge.point, b, 10 * tolerance)) continue;
      const coord angle = std::atan2(a.cross(b).norm(), a.dot(b));
      if (angle < parallel) continue;                           // one on the other: they move differently
      if (angle <= sharpest && (f.bends || g.bends)) continue;  // a closed gap, or one that opens: no water in it
      require(angle > sharpest, "geometry: \"", walls.bodies[f.body].name, "\" and \"", walls.bodies[g.body].name,
              "\" meet at ", angle * 180 / M_PI, " degrees near (", edge.point[0], ", ", edge.point[1], ", ",
              edge.point[2], ") m: there is no room for water below 5 degrees; open the corner or fill it with a wall");
      Joint q{};
      q.panel[0] = corner_of.f;
      q.panel[1] = corner_of.g;
      put(q.point, edge.point);
      put(q.edge, edge.direction);
      q.low = edge.low;
      q.high = edge.high;
      put(q.along[0], a);
      put(q.along[1], b);
      const Vector n = normal_of(f);
      put(q.across, b.dot(n) < 0 ? Vector(-n) : n);
      q.angle = angle;
      q.blend = std::max(0.0, std::min(M_PI / 4, M_PI - angle));
      if (angle > bluntest && M_PI - angle > parallel) q.blend = std::max(q.blend, least_blend);
      corner_of.joints.push_back(static_cast<int>(made.joints.size()));
      made.joints.push_back(q);
      const bool bend = angle > bluntest && (f.body == g.body || (f.bends && g.bends));
      if (M_PI - angle > parallel && !bend) continue;
      // Flat, or one of the many edges of a wall that is round, or bends: inside is on both sides of it. On the outer side of
      // a bend no path meets either panel in a narrow wedge; there the one that is nearer stands for both. Without that a
      // particle in the wedge lacks its own image, and is drawn to the edge.
      put(q.across, b.dot(n) < 0 ? n : Vector(-n));
      q.angle = 2 * M_PI - angle;
      q.blend = 0;
      corner_of.joints.push_back(static_cast<int>(made.joints.size()));
      made.joints.push_back(q);
    }
}

// Where the end of the corner's edge is on the panel.
bool ends_on(const WallPanels& made, const Edge& edge, const Panel& h, coord tolerance) {
  for (const coord at : {edge.low, edge.high}) {
    const Vector end = edge.point + at * edge.direction;
    if (std::fabs(normal_of(h).dot(end - vec(h.point))) > 10 * tolerance) continue;
    for (int k = h.first_piece; k < h.last_piece; ++k)
      if (contains(made.pieces[k], 3, end, 10 * tolerance)) return true;
  }
  return false;
}

void add_corners(const WallFaces& walls, const std::vector<Bounds>& bounds, coord tolerance, WallPanels& made) {
  std::vector<Corner> corners;
  for_each_touching(bounds, tolerance, [&](int f, int g) {
    Corner c{f, g, {}, {}};
    const bool touch = walls.dim == 2 ? find_edge_2d(made, made.panels[f], made.panels[g], tolerance, c.edge)
                                      : find_edge_3d(made, made.panels[f], made.panels[g], tolerance, c.edge);
    if (!touch) return;
    if (std::fabs(normal_of(made.panels[f]).dot(normal_of(made.panels[g]))) < right_angle) {
      made.mirrors.push_back(make_mirror(made, -1, -1, 0, {f, g}));
    } else {
      add_joints(walls, made, c, tolerance);
      for (const int q : c.joints) add_words(made, q, {});
    }
    corners.push_back(c);
  });
  if (walls.dim == 2) return;
  std::vector<std::vector<int>> partners(made.panels.size());
  for (const Corner& c : corners) {
    partners[c.f].push_back(c.g);
    partners[c.g].push_back(c.f);
  }
  for (const Corner& c : corners)
    for (const int h : partners[c.f]) {
      if (h == c.g || std::find(partners[c.g].begin(), partners[c.g].end(), h) == partners[c.g].end()) continue;
      const Vector n = normal_of(made.panels[h]);
      if (n.cross(c.edge.direction).norm() > right_angle || !ends_on(made, c.edge, made.panels[h], tolerance)) continue;
      if (!c.joints.empty()) {
        for (const int q : c.joints) add_words(made, q, {h});
      } else if (c.f < h && c.g < h) {  // once for each corner of three
        made.mirrors.push_back(make_mirror(made, -1, -1, 0, {c.f, c.g, h}));
      }
    }
}

void list_joints(WallPanels& made) {
  std::vector<std::vector<int>> of(made.panels.size());
  for (std::size_t q = 0; q < made.joints.size(); ++q)
    for (const int p : made.joints[q].panel) of[p].push_back(static_cast<int>(q));
  for (std::size_t p = 0; p < of.size(); ++p) {
    made.panels[p].first_joint = static_cast<int>(made.joint_of_panel.size());
    made.joint_of_panel.insert(made.joint_of_panel.end(), of[p].begin(), of[p].end());
    made.panels[p].last_joint = static_cast<int>(made.joint_of_panel.size());
  }
}

}  // namespace

void add_mirrors(const WallFaces& walls, const std::vector<Bounds>& bounds, coord tolerance, WallPanels& made) {
  for (int p = 0; p < static_cast<int>(made.panels.size()); ++p)
    made.mirrors.push_back(make_mirror(made, -1, p, 1, {}));
  add_corners(walls, bounds, tolerance, made);
  list_joints(made);
}

}  // namespace greenwater
