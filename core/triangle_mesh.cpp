#include "core/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "core/point_math.hpp"
#include "core/whole.hpp"

namespace greenwater {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15U;
    return static_cast<std::size_t>(hash ^ (hash >> 32U));
  }
};

/// Finds an earlier point within a tolerance. Cells are much wider than it, so that one cell is nearly always enough.
class NearPoints {
 public:
  explicit NearPoints(coord tolerance) : tolerance_(tolerance), width_(64 * tolerance) {}

  /// The number of a point near `x`; where there is none, -1, and `x` is remembered as `number`.
  int find_or_add(const Triple& x, int number, const std::vector<Triple>& points) {
    Cell low, high;
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = cell(x[d] - tolerance_);
      high[d] = cell(x[d] + tolerance_);
    }
    for (Cell c = low; c[0] <= high[0]; ++c[0]) {
      for (c[1] = low[1]; c[1] <= high[1]; ++c[1]) {
        for (c[2] = low[2]; c[2] <= high[2]; ++c[2]) {
          const auto found = cells_.find(c);
          if (found == cells_.end()) continue;
          for (const int other : found->second)
            if (distance(points[static_cast<std::size_t>(other)], x) <= tolerance_) return other;
        }
      }
    }
    cells_[{cell(x[0]), cell(x[1]), cell(x[2])}].push_back(number);
    return -1;
  }

 private:
  // Shifted by a part of a cell, as round coordinates would lie on the borders of cells.
  std::int64_t cell(coord x) const {
    constexpr std::int64_t most = std::int64_t{1} << 62;
    return whole_within(std::floor(x / width_ + 0.37), -most, most);
  }

  coord tolerance_, width_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

/// Gives every vertex that is used the next number, in the order of use.
void drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<Triple> used;
  for (auto& triangle : mesh.triangles) {
    for (int& corner : triangle) {
      int& mine = number[static_cast<std::size_t>(corner)];
      if (mine < 0) {
        mine = static_cast<int>(used.size());
        used.push_back(mesh.vertices[static_cast<std::size_t>(corner)]);
      }
      corner = mine;
    }
  }
  mesh.vertices = std::move(used);
}

}  // namespace

MeshBounds bounds_of(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  MeshBounds bounds{mesh.vertices.front(), mesh.vertices.front()};
  for (const Triple& x : mesh.vertices) {
    for (std::size_t d = 0; d < 3; ++d) {
      bounds.low[d] = std::min(bounds.low[d], x[d]);
      bounds.high[d] = std::max(bounds.high[d], x[d]);
    }
  }
  return bounds;
}

coord diagonal_of(const TriangleMesh& mesh) {
  const MeshBounds bounds = bounds_of(mesh);
  return distance(bounds.low, bounds.high);
}

void scale(TriangleMesh& mesh, coord by) {
  for (Triple& x : mesh.vertices) x = scaled(x, by);
}

void turn(TriangleMesh& mesh, const std::array<coord, 3>& axis, coord angle) {
  const Triple k = scaled(axis, 1 / length(axis));
  const coord c = std::cos(angle), s = std::sin(angle);
  // Rodrigues: x' = x cos + (k x x) sin + k (k.x) (1 - cos)
  for (Triple& x : mesh.vertices) {
    x = sum(sum(scaled(x, c), scaled(cross(k, x), s)), scaled(k, dot(k, x) * (1 - c)));
  }
}

void move(TriangleMesh& mesh, const std::array<coord, 3>& by) {
  for (Triple& x : mesh.vertices) x = sum(x, by);
}

int weld(TriangleMesh& mesh, coord tolerance) {
  struct ExactHash {
    std::size_t operator()(const Triple& x) const {
      std::uint64_t hash = 0;
      for (const coord c : x) hash = (hash ^ std::hash<coord>()(c)) * 0x9E3779B97F4A7C15U;
      return static_cast<std::size_t>(hash ^ (hash >> 32U));
    }
  };
  std::unordered_map<Triple, int, ExactHash> exact;
  NearPoints near(tolerance);
  std::vector<int> root(mesh.vertices.size());
  int merged = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto [same, is_new] = exact.try_emplace(mesh.vertices[i], static_cast<int>(i));
    if (is_new && tolerance > 0) {
      const int other = near.find_or_add(mesh.vertices[i], static_cast<int>(i), mesh.vertices);
      if (other >= 0) {
        same->second = other;
        ++merged;
      }
    }
    root[i] = same->second;
  }
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) corner = root[static_cast<std::size_t>(corner)];
  drop_unused_vertices(mesh);
  return merged;
}

}  // namespace greenwater
