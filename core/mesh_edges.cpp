#include "core/mesh_edges.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "core/mesh_faults.hpp"

namespace greenwater {
namespace {

std::pair<int, int> key(const MeshSide& side) { return {side.low(), side.high()}; }

/// 6 x the volume between a triangle and a point.
coord six_volumes(const TriangleMesh& mesh, const std::array<int, 3>& t, const Triple& from) {
  return dot(difference(vertex(mesh, t[0]), from),
             cross(difference(vertex(mesh, t[1]), from), difference(vertex(mesh, t[2]), from)));
}

/// Spreads over edges of two triangles from the first triangle of a part.
class Flood {
 public:
  Flood(const TriangleMesh& mesh, const MeshEdges& edges) : edges_(edges), edges_of_(mesh.triangles.size()) {
    for (std::size_t e = 0; e < edges.count(); ++e)
      for (const MeshSide* s = edges.begin(e); s != edges.end(e); ++s) edges_of_[index(s->triangle)].push_back(e);
    result_.part.assign(mesh.triangles.size(), -1);
    result_.turned.assign(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (result_.part[t] < 0 && !edges_of_[t].empty()) fill_from(static_cast<int>(t));
    }
  }
  MeshParts take() { return std::move(result_); }

 private:
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

  void fill_from(int first) {
    const int number = static_cast<int>(result_.parts.size());
    result_.parts.push_back({});
    result_.parts.back().first = first;
    result_.part[index(first)] = number;
    std::vector<int> waiting{first};
    while (!waiting.empty()) {
      const int t = waiting.back();
      waiting.pop_back();
      ++result_.parts.back().triangles;
      result_.parts.back().turned += result_.turned[index(t)];
      for (const std::size_t e : edges_of_[index(t)]) cross_edge(e, t, waiting);
    }
  }

  void cross_edge(std::size_t e, int t, std::vector<int>& waiting) {
    MeshParts::Part& part = result_.parts.back();
    if (edges_.uses(e) != 2) {
      part.closed = false;
      return;
    }
    const MeshSide *mine = edges_.begin(e), *other = mine + 1;
    if (mine->triangle != t) std::swap(mine, other);
    const char turned = static_cast<char>(result_.turned[index(t)] ^ static_cast<char>(mine->from == other->from));
    int& its_part = result_.part[index(other->triangle)];
    if (its_part >= 0) {
      part.one_sided = part.one_sided || result_.turned[index(other->triangle)] != turned;
      return;
    }
    its_part = result_.part[index(t)];
    result_.turned[index(other->triangle)] = turned;
    waiting.push_back(other->triangle);
  }

  const MeshEdges& edges_;
  std::vector<std::vector<std::size_t>> edges_of_;
  MeshParts result_;
};

/// Solid angle of a triangle seen from a point, with the sign of its side (van Oosterom and Strackee 1983).
coord solid_angle(const TriangleMesh& mesh, const std::array<int, 3>& t, const Triple& from) {
  const Triple a = difference(vertex(mesh, t[0]), from), b = difference(vertex(mesh, t[1]), from),
               c = difference(vertex(mesh, t[2]), from);
  const coord la = length(a), lb = length(b), lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

Triple middle(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  return scaled(sum(sum(vertex(mesh, t[0]), vertex(mesh, t[1])), vertex(mesh, t[2])), coord(1) / 3);
}

bool within(const MeshBounds& bounds, const Triple& x) {
  bool inside = true;
  for (std::size_t d = 0; d < 3; ++d) inside = inside && bounds.low[d] <= x[d] && x[d] <= bounds.high[d];
  return inside;
}

void measure_depth(const TriangleMesh& mesh, MeshParts& all) {
  std::vector<std::vector<int>> triangles(all.parts.size());
  for (std::size_t t = 0; t < all.part.size(); ++t)
    if (all.part[t] >= 0) triangles[static_cast<std::size_t>(all.part[t])].push_back(static_cast<int>(t));
  for (std::size_t outer = 0; outer < all.parts.size(); ++outer) {
    if (!all.parts[outer].closed || all.parts[outer].one_sided) continue;
    TriangleMesh corners;
    for (const int t : triangles[outer])
      for (const int v : triangle(mesh, t)) corners.vertices.push_back(vertex(mesh, v));
    const MeshBounds bounds = bounds_of(corners);
    for (std::size_t inner = 0; inner < all.parts.size(); ++inner) {
      if (inner == outer || !all.parts[inner].closed) continue;
      const Triple x = middle(mesh, triangle(mesh, all.parts[inner].first));
      if (!within(bounds, x)) continue;
      coord angle = 0;
      for (const int t : triangles[outer]) {
        angle += (all.turned[static_cast<std::size_t>(t)] != 0 ? -1 : 1) * solid_angle(mesh, triangle(mesh, t), x);
      }
      all.parts[inner].depth += std::abs(angle) > 2 * std::numbers::pi ? 1 : 0;
    }
  }
}

}  // namespace

MeshEdges::MeshEdges(const TriangleMesh& mesh) {
  sides_.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corner = mesh.triangles[t];
    if (has_equal_corners(corner)) continue;
    for (std::size_t s = 0; s < 3; ++s) sides_.push_back({corner[s], corner[(s + 1) % 3], static_cast<int>(t)});
  }
  std::stable_sort(sides_.begin(), sides_.end(), [](const MeshSide& a, const MeshSide& b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (i == 0 || key(sides_[i]) != key(sides_[i - 1])) begin_.push_back(i);
  }
  begin_.push_back(sides_.size());
}

std::size_t MeshEdges::find(int a, int b) const {
  const std::pair<int, int> wanted{std::min(a, b), std::max(a, b)};
  const auto last = begin_.end() - 1;
  const auto found =
      std::lower_bound(begin_.begin(), last, wanted, [&](std::size_t i, const auto& k) { return key(sides_[i]) < k; });
  const bool is_there = found != last && key(sides_[*found]) == wanted;
  return is_there ? static_cast<std::size_t>(found - begin_.begin()) : count();
}

TriangleShape shape_of(const TriangleMesh& mesh, const std::array<int, 3>& corners) {
  TriangleShape shape;
  std::array<coord, 3> side;
  for (std::size_t s = 0; s < 3; ++s) side[s] = distance(vertex(mesh, corners[s]), vertex(mesh, corners[(s + 1) % 3]));
  const auto longest = std::max_element(side.begin(), side.end()),
             shortest = std::min_element(side.begin(), side.end());
  shape.longest = static_cast<int>(longest - side.begin());
  shape.shortest = static_cast<int>(shortest - side.begin());
  shape.longest_length = *longest;
  shape.shortest_length = *shortest;
  const Triple area = cross(difference(vertex(mesh, corners[1]), vertex(mesh, corners[0])),
                            difference(vertex(mesh, corners[2]), vertex(mesh, corners[0])));
  shape.smallest_height = *longest > 0 ? length(area) / *longest : 0;
  return shape;
}

std::vector<VertexOnEdge> vertices_on_edges(const TriangleMesh& mesh, const MeshEdges& edges) {
  const MeshBounds bounds = bounds_of(mesh);
  std::size_t axis = 0;  // the longest one parts the vertices best
  for (std::size_t d = 1; d < 3; ++d)
    if (bounds.high[d] - bounds.low[d] > bounds.high[axis] - bounds.low[axis]) axis = d;
  std::vector<MeshSide> free;
  std::vector<std::pair<coord, int>> ends;
  for (std::size_t e = 0; e < edges.count(); ++e) {
    if (edges.uses(e) != 1) continue;
    free.push_back(*edges.begin(e));
    for (const int v : {free.back().from, free.back().to}) ends.emplace_back(vertex(mesh, v)[axis], v);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<VertexOnEdge> found;
  for (const MeshSide& side : free) {
    const Triple a = vertex(mesh, side.from), along = difference(vertex(mesh, side.to), a);
    const coord near = sliver_height * length(along);
    const auto& corners = triangle(mesh, side.triangle);
    const auto [low, high] = std::minmax({a[axis], a[axis] + along[axis]});
    const auto first = found.size();
    for (auto i = std::lower_bound(ends.begin(), ends.end(), std::pair(low - near, -1));
         i != ends.end() && i->first <= high + near; ++i) {
      if (std::find(corners.begin(), corners.end(), i->second) != corners.end()) continue;
      const Triple x = difference(vertex(mesh, i->second), a);
      const coord part = dot(x, along) / dot(along, along);
      const bool between = part > sliver_height && part < 1 - sliver_height;
      if (between && distance(x, scaled(along, part)) <= near) found.push_back({i->second, side, part});
    }
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
              [](const VertexOnEdge& p, const VertexOnEdge& q) { return p.along < q.along; });
  }
  return found;
}

MeshParts parts_of(const TriangleMesh& mesh, const MeshEdges& edges) {
  MeshParts all = Flood(mesh, edges).take();
  const MeshBounds bounds = bounds_of(mesh);
  const Triple centre = scaled(sum(bounds.low, bounds.high), 0.5);  // volumes from far away would lose digits
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (all.part[t] < 0) continue;
    const coord sign = all.turned[t] != 0 ? -1 : 1;
    all.parts[static_cast<std::size_t>(all.part[t])].volume += sign * six_volumes(mesh, mesh.triangles[t], centre) / 6;
  }
  measure_depth(mesh, all);
  return all;
}

}  // namespace greenwater
