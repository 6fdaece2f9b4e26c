#pragma once
// Meshes of solids from Gmsh: .msh files of format 4.1, as text.

#include <filesystem>

#include "core/solid_mesh.hpp"
#include "io/place.hpp"

namespace greenwater {

/// The hexahedra of the file or, where there are none, its quadrilaterals, which must lie in the plane z = 0; in the
/// order and the unit of the file, with the nodes that they use. Each physical group is a part with the name of the
/// group or, without a name, its tag: groups of surfaces (2-D: of curves) have the sides of the elements as facets, all
/// others are nodes. Parts are in the order of their dimension and tag. Whether elements are turned inside out is not
/// looked at. Throws CaseError that names the file with the line, the cure, and `place` where the case names the file;
/// FileError when the file cannot be read.
SolidMesh read_gmsh(const std::filesystem::path& path, const Place& place);

}  // namespace greenwater
