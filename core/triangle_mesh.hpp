#pragma once
// A surface of triangles, on the host.

#include <array>
#include <vector>

#include "core/real.hpp"

namespace greenwater {

struct TriangleMesh {
  std::vector<std::array<coord, 3>> vertices;  // [m]
  std::vector<std::array<int, 3>> triangles;   // three vertices each, anti-clockwise seen from outside
};

struct MeshBounds {
  std::array<coord, 3> low{}, high{};  // [m]
};
MeshBounds bounds_of(const TriangleMesh& mesh);
/// Of the bounds [m].
coord diagonal_of(const TriangleMesh& mesh);

void scale(TriangleMesh& mesh, coord by);
/// Anti-clockwise by `angle` [rad] round an axis through the origin; the axis has any length but 0.
void turn(TriangleMesh& mesh, const std::array<coord, 3>& axis, coord angle);
void move(TriangleMesh& mesh, const std::array<coord, 3>& by);

/// Vertices nearer to each other than `tolerance` [m] become one, the first of them; unused ones go. Triangles keep
/// their number and order, also those that lose their area. Returns how many vertices went into another at a distance.
int weld(TriangleMesh& mesh, coord tolerance);

}  // namespace greenwater
