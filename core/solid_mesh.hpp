#pragma once
// A mesh of solid elements with named parts, on the host: what is read from a file or built from a case, and what the
// finite elements work on.

#include <array>
#include <string>
#include <vector>

namespace greenwater {

/// One side of one element.
struct Facet {
  int element = 0;
  int side = 0;
  bool operator==(const Facet&) const = default;
};

/// A name for a piece of the mesh: where it is clamped, loaded, or wet. `nodes` has those of the facets too.
struct MeshPart {
  std::string name;
  std::vector<int> nodes;     // ascending, each once
  std::vector<Facet> facets;  // empty for a part of nodes alone
};

/// 3-D: hexahedra of eight nodes, the first four anti-clockwise seen from inside the element, the others opposite them
/// (the order of VTK and Gmsh). 2-D: quadrilaterals of four nodes, anti-clockwise; the last four of `elements` are not
/// used.
struct SolidMesh {
  int dim = 3;
  std::vector<std::array<double, 3>> nodes;  // [m]; z = 0 in 2-D
  std::vector<std::array<int, 8>> elements;  // indices of nodes
  std::vector<MeshPart> parts;

  int nodes_per_element() const { return dim == 2 ? 4 : 8; }
  int sides_per_element() const { return dim == 2 ? 4 : 6; }
  int nodes_per_side() const { return dim == 2 ? 2 : 4; }
};

/// The nodes of a side: in 3-D four, anti-clockwise seen from outside; in 2-D two, the element on their left. -1 where
/// there is none.
std::array<int, 4> nodes_of(const SolidMesh& mesh, Facet facet);

/// The sides that belong to one element only, by element and side.
std::vector<Facet> outer_facets(const SolidMesh& mesh);

/// The part of this name, or nullptr.
const MeshPart* find_part(const SolidMesh& mesh, const std::string& name);

/// The names of all parts for messages: `"foot", "tip"`, or `none`.
std::string part_names(const SolidMesh& mesh);

/// Every place times `by`.
void scale(SolidMesh& mesh, double by);

/// Adds a part made of these facets and their nodes.
void add_part(SolidMesh& mesh, const std::string& name, std::vector<Facet> facets);

/// A box from `low` to `high` [m] in divisions[0] x divisions[1] (x divisions[2]) equal elements. Parts: left, right
/// (x), in 3-D front, back (y), bottom, top (the last axis). Nodes count up along x first, then y, then z.
SolidMesh box_mesh(int dim, const std::array<double, 3>& low, const std::array<double, 3>& high,
                   const std::array<int, 3>& divisions);

}  // namespace greenwater
