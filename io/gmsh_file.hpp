#pragma once
// What stands in a .msh file of Gmsh: format 4.1 as text.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/data_file.hpp"

namespace greenwater {

/// Gmsh's numbers of the kinds of elements that a solid needs, and of their sides.
constexpr int msh_line = 1, msh_quadrilateral = 3, msh_hexahedron = 5, msh_point = 15;

/// Dimension (0: points ... 3: volumes) and tag: what an entity is known by, and what a physical group is known by.
using MshTag = std::pair<int, std::int64_t>;

struct MshNode {
  std::array<double, 3> position{};  // in the unit of the file
  int line = 0;
};

struct MshElement {
  std::array<int, 8> nodes{};  // indices of MshFile::nodes, as many as the kind has
  int line = 0;
};

/// Elements first ... first + count - 1, all of one kind and of one entity.
struct MshBlock {
  MshTag entity;
  int type = 0;
  std::size_t first = 0, count = 0;
};

/// A physical group; the line names it, or puts the first entity into it.
struct MshGroup {
  std::string name;
  int line = 0;
};

struct MshFile {
  std::vector<MshNode> nodes;
  std::vector<MshElement> elements;
  std::vector<MshBlock> blocks;
  std::map<MshTag, MshGroup> groups;
  std::map<MshTag, std::vector<std::int64_t>> groups_of_entity;  // tags of groups of the same dimension
};

/// How many nodes an element of this kind has.
int msh_nodes(int type);

/// Reads the sections MeshFormat, PhysicalNames, Entities, Nodes and Elements, and goes over all others. Throws
/// CaseError with line, column and cure for a file that is not of this format, is cut short, or says what cannot be,
/// and for elements that are not lines, quadrilaterals, hexahedra or points.
MshFile parse_msh(const DataFile& file);

}  // namespace greenwater
