#pragma once
// Which element is at a place.

#include <array>

#include "core/solid_mesh.hpp"

namespace greenwater {

/// A place that moves with the body: an element, and natural coordinates in it from -1 to 1, along the axes of its
/// reference element; what is beyond the dimension is 0.
struct MeshPlace {
  int element = 0;
  std::array<double, 3> xi{};
};

/// The place of the mesh nearest to x [m]: in the element that x lies in, or else on the outside of the nearest one. Of
/// elements that share it, the first.
MeshPlace place_in_mesh(const SolidMesh& mesh, const std::array<double, 3>& x);

/// Whether x lies in an element, or on its outside.
bool is_inside(const SolidMesh& mesh, const std::array<double, 3>& x);

}  // namespace greenwater
