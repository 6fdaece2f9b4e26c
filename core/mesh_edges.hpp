#pragma once
// Which triangles share which edges.

#include <vector>

#include "core/point_math.hpp"
#include "core/triangle_mesh.hpp"

namespace greenwater {

/// One side of one triangle.
struct MeshSide {
  int from = 0, to = 0;  // vertices in the direction of the triangle
  int triangle = 0;
  int low() const { return from < to ? from : to; }
  int high() const { return from < to ? to : from; }
};

/// The sides of all triangles but those with two equal corners, sides of the same edge one after the other, in the order
/// of triangles.
class MeshEdges {
 public:
  explicit MeshEdges(const TriangleMesh& mesh);

  std::size_t count() const { return begin_.size() - 1; }
  const MeshSide* begin(std::size_t edge) const { return sides_.data() + begin_[edge]; }
  const MeshSide* end(std::size_t edge) const { return sides_.data() + begin_[edge + 1]; }
  std::size_t uses(std::size_t edge) const { return begin_[edge + 1] - begin_[edge]; }
  /// The edge between two vertices; count() when there is none.
  std::size_t find(int a, int b) const;

 private:
  std::vector<MeshSide> sides_;
  std::vector<std::size_t> begin_;
};

inline const Triple& vertex(const TriangleMesh& mesh, int v) { return mesh.vertices[static_cast<std::size_t>(v)]; }
inline const std::array<int, 3>& triangle(const TriangleMesh& mesh, int t) {
  return mesh.triangles[static_cast<std::size_t>(t)];
}

inline bool has_equal_corners(const std::array<int, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// The shape of a triangle: side s is from corner s to the next one.
struct TriangleShape {
  int longest = 0, shortest = 0;  // sides
  coord longest_length = 0, shortest_length = 0, smallest_height = 0;
};
TriangleShape shape_of(const TriangleMesh& mesh, const std::array<int, 3>& corners);

/// A vertex that lies on an edge which belongs to one triangle only, and does not end there.
struct VertexOnEdge {
  int vertex = 0;
  MeshSide side;
  coord along = 0;  // part of the edge before it
};
/// Those of an edge one after the other, in the order in which they lie on it.
std::vector<VertexOnEdge> vertices_on_edges(const TriangleMesh& mesh, const MeshEdges& edges);

/// The parts of a surface; triangles are joined over edges that belong to two of them.
struct MeshParts {
  struct Part {
    int first = 0;           // triangle
    int triangles = 0;       // how many
    int turned = 0;          // how many face the other way than the first
    bool closed = true;      // every edge belongs to two triangles
    bool one_sided = false;  // neighbours cannot be made to agree, as on a Moebius strip
    coord volume = 0;        // [m^3], when all face as the first; positive when it faces outwards
    int depth = 0;           // how many other closed parts it lies in, if it is closed
  };
  std::vector<Part> parts;
  std::vector<int> part;     // of each triangle; -1 when it has two equal corners
  std::vector<char> turned;  // of each triangle: it faces the other way than the first one of its part
};
MeshParts parts_of(const TriangleMesh& mesh, const MeshEdges& edges);

}  // namespace greenwater
