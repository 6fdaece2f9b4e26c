#pragma once
// The .vtu format: the elements of a solid, where its nodes are at one instant.

#include <array>
#include <string>
#include <vector>

#include "core/solid_mesh.hpp"
#include "core/table.hpp"

namespace greenwater {

/// What a solid shows at one instant. Lists go over all nodes, or over all elements, of its mesh; those that are empty
/// are left out, and without displacement the mesh is drawn as it was made.
struct SolidFrame {
  double time = 0;                                  // [s]
  std::vector<std::array<double, 3>> displacement;  // of the nodes [m]; the last component is 0 in 2-D
  std::vector<std::array<double, 3>> velocity;      // of the nodes [m/s]; the same
  std::vector<std::array<double, 6>> stress;        // of the elements [Pa]: xx, yy, zz, xy, yz, xz
  std::vector<Column> node_data, element_data;      // anything else; six components are a tensor in the same order
};

/// The whole file: real values in 32 bits, hexahedra (VTK's type 12) or quadrilaterals (type 9) in the order of the
/// mesh.
std::string vtu_text(const SolidMesh& mesh, const SolidFrame& frame);

}  // namespace greenwater
