#include "io/gmsh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "io/gmsh_file.hpp"

namespace greenwater {
namespace {

constexpr const char* entities_of_dim[] = {"points", "curves", "surfaces", "volumes"};
constexpr const char* keyword_of_dim[] = {"Point", "Curve", "Surface", "Volume"};

DataSpot at_line(int line) { return {line, 1, 1}; }

/// Makes the mesh of what stands in one file.
class GmshSolid {
 public:
  GmshSolid(const DataFile& file, const MshFile& msh) : file_(file), msh_(msh) {}

  SolidMesh mesh() {
    mesh_.dim = dim_of_solid();
    find_groups();
    add_elements();
    if (mesh_.dim == 2) flatten();
    find_sides();
    for (const auto& [tag, group] : msh_.groups) add_group(tag, group);
    return std::move(mesh_);
  }

 private:
  using SideNodes = std::array<int, 4>;  // of the solid's nodes, ascending, -1 where there is none

  int dim_of_solid() const {
    const auto has = [&](int type) {
      return std::any_of(msh_.blocks.begin(), msh_.blocks.end(),
                         [&](const MshBlock& block) { return block.type == type && block.count > 0; });
    };
    const bool is_solid = has(msh_hexahedron);
    require_at(
        file_, {}, is_solid || has(msh_quadrilateral),
        "there are no hexahedra in the file, nor quadrilaterals: Gmsh saves only what is in a physical group, if "
        "there is any; put the solid into one (Physical Volume, or Physical Surface in 2-D) and mesh it again");
    return is_solid ? 3 : 2;
  }
  int solid_type() const { return mesh_.dim == 3 ? msh_hexahedron : msh_quadrilateral; }

  void find_groups() {
    for (const MshBlock& block : msh_.blocks) {
      const auto found = msh_.groups_of_entity.find(block.entity);
      if (found == msh_.groups_of_entity.end() || block.count == 0) continue;
      for (const std::int64_t tag : found->second) blocks_[{block.entity.first, tag}].push_back(&block);
    }
  }

  /// All elements of the solid, in groups or not, and their nodes in the order of the file.
  void add_elements() {
    std::vector<char> used(msh_.nodes.size(), 0);
    for_elements([&](const MshElement& element) {
      for (int a = 0; a < mesh_.nodes_per_element(); ++a) used[element.nodes[a]] = 1;
    });
    node_.assign(msh_.nodes.size(), -1);
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (used[i] == 0) continue;
      node_[i] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.push_back(msh_.nodes[i].position);
    }
    for_elements([&](const MshElement& element) {
      std::array<int, 8> nodes{};
      for (int a = 0; a < mesh_.nodes_per_element(); ++a) nodes[a] = node_[element.nodes[a]];
      mesh_.elements.push_back(nodes);
    });
  }
  template <class Visit>
  void for_elements(Visit visit) const {
    for (const MshBlock& block : msh_.blocks) {
      if (block.type != solid_type()) continue;
      for (std::size_t e = 0; e < block.count; ++e) visit(msh_.elements[block.first + e]);
    }
  }

  void flatten() {
    constexpr double rounding = 1e-9;  // of the largest coordinate
    double largest = 0;
    for (const auto& x : mesh_.nodes) {
      for (const double c : x) largest = std::max(largest, std::abs(c));
    }
    for (std::size_t i = 0; i < node_.size(); ++i) {
      if (node_[i] < 0) continue;
      const double z = msh_.nodes[i].position[2];
      require_at(file_, at_line(msh_.nodes[i].line), std::abs(z) <= rounding * largest,
                 "there are no hexahedra in the file, and its quadrilaterals do not lie in the plane z = 0, for here z "
                 "= ",
                 z, "; mesh a solid with gmsh -3 and put it into a Physical Volume, or draw the 2-D one in x and y");
      mesh_.nodes[node_[i]][2] = 0;
    }
  }

  bool is_of_sides(const MshTag& group) const { return group.first == mesh_.dim - 1; }

  /// The nodes of a surface element as a key; a node that the solid does not have makes a key that no side has.
  SideNodes side_nodes(const MshElement& element) const {
    SideNodes nodes{-1, -1, -1, -1};
    for (int a = 0; a < mesh_.nodes_per_side(); ++a) nodes[a] = node_[element.nodes[a]];
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }

  /// Whose sides the surface elements in groups are.
  void find_sides() {
    for (const auto& [tag, blocks] : blocks_) {
      if (!is_of_sides(tag)) continue;
      for (const MshBlock* block : blocks) {
        for (std::size_t e = 0; e < block->count; ++e) sides_[side_nodes(msh_.elements[block->first + e])];
      }
    }
    if (sides_.empty()) return;
    for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e) {
      for (int side = 0; side < mesh_.sides_per_element(); ++side) {
        SideNodes nodes = nodes_of(mesh_, {e, side});
        std::sort(nodes.begin(), nodes.end());
        const auto found = sides_.find(nodes);
        if (found != sides_.end()) found->second.push_back({e, side});
      }
    }
  }

  void add_group(const MshTag& tag, const MshGroup& group) {
    const int dim = tag.first;
    const DataSpot spot = at_line(group.line);
    require_at(file_, spot, blocks_.count(tag) > 0, "group \"", group.name, "\" of ", entities_of_dim[dim],
               " has no elements: give it ", entities_of_dim[dim], " that are meshed, or delete Physical ",
               keyword_of_dim[dim], " ", tag.second);
    require_at(file_, spot, find_part(mesh_, group.name) == nullptr, "two groups are called \"", group.name,
               "\", and one of them is of ", entities_of_dim[dim], "; give each a name of its own, like Physical ",
               keyword_of_dim[dim], "(\"", group.name, " ", entities_of_dim[dim], "\", ", tag.second, ")");
    if (is_of_sides(tag)) {
      add_part(mesh_, group.name, facets(tag, group));
    } else {
      mesh_.parts.push_back({group.name, nodes(tag, group), {}});
    }
  }

  std::vector<Facet> facets(const MshTag& tag, const MshGroup& group) const {
    std::vector<Facet> facets;
    std::set<SideNodes> seen;
    for (const MshBlock* block : blocks_.at(tag)) {
      for (std::size_t e = 0; e < block->count; ++e) {
        const MshElement& element = msh_.elements[block->first + e];
        const SideNodes nodes = side_nodes(element);
        const std::vector<Facet>& found = sides_.at(nodes);
        const DataSpot spot = at_line(element.line);
        const char* what = mesh_.dim == 3 ? "this quadrilateral" : "this line";
        const char* solid = mesh_.dim == 3 ? "hexahedron" : "quadrilateral";
        require_at(file_, spot, !found.empty(), what, " of group \"", group.name, "\" is not a side of any ", solid,
                   ": take into the group only ", entities_of_dim[tag.first],
                   " that bound the solid, and let bodies that touch share them (Coherence)");
        require_at(file_, spot, found.size() == 1, what, " of group \"", group.name, "\" lies between ", found.size(),
                   " elements, so nobody knows whose side it is; take into the group only ", entities_of_dim[tag.first],
                   " on the outside of the solid");
        require_at(file_, spot, seen.insert(nodes).second, what, " of group \"", group.name,
                   "\" stands twice in the file; delete one of the two ", entities_of_dim[tag.first],
                   " (Coherence) and mesh again");
        facets.push_back(found.front());
      }
    }
    return facets;
  }

  std::vector<int> nodes(const MshTag& tag, const MshGroup& group) const {
    std::set<int> found;
    for (const MshBlock* block : blocks_.at(tag)) {
      for (std::size_t e = 0; e < block->count; ++e) {
        const MshElement& element = msh_.elements[block->first + e];
        for (int a = 0; a < msh_nodes(block->type); ++a) {
          const int node = node_[element.nodes[a]];
          require_at(file_, at_line(element.line), node >= 0, "group \"", group.name, "\" of ",
                     entities_of_dim[tag.first], " has a node here that no element of the solid has: take only ",
                     entities_of_dim[tag.first], " of the solid, or embed them (", keyword_of_dim[tag.first],
                     "{...} In ", keyword_of_dim[mesh_.dim], "{...})");
          found.insert(node);
        }
      }
    }
    return {found.begin(), found.end()};
  }

  const DataFile& file_;
  const MshFile& msh_;
  SolidMesh mesh_;
  std::vector<int> node_;                                  // of the solid, for each of the file; or -1
  std::map<MshTag, std::vector<const MshBlock*>> blocks_;  // of each group that has elements
  std::map<SideNodes, std::vector<Facet>> sides_;          // of the solid, where a group has elements
};

}  // namespace

SolidMesh read_gmsh(const std::filesystem::path& path, const Place& place) {
  const DataFile file = read_data_file(path, place);
  const MshFile msh = parse_msh(file);
  return GmshSolid(file, msh).mesh();
}

}  // namespace greenwater
