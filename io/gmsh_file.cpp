#include "io/gmsh_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>
#include <unordered_map>

#include "io/gmsh_lines.hpp"

namespace greenwater {
namespace {

constexpr std::size_t any_number = SIZE_MAX;

// ---- kinds of elements ----

struct Kind {
  int type, dim, nodes;
};
constexpr Kind usable_kinds[] = {
    {msh_line, 1, 2}, {msh_quadrilateral, 2, 4}, {msh_hexahedron, 3, 8}, {msh_point, 0, 1}};

const Kind* find_kind(std::int64_t type) {
  const auto* found = std::find_if(std::begin(usable_kinds), std::end(usable_kinds),
                                   [&](const Kind& kind) { return kind.type == type; });
  return found == std::end(usable_kinds) ? nullptr : found;
}

struct StrangeKind {
  std::int64_t type;
  const char *name, *cure;
};
constexpr const char* recombine = "let Gmsh recombine them (Mesh.RecombineAll = 1, or Recombine Surface)";
constexpr const char* transfinite =
    "make hexahedra (Transfinite Volume and Recombine Surface, or Extrude with Layers and Recombine)";
constexpr const char* first_order = "make elements of first order (Mesh.ElementOrder = 1, or gmsh -order 1)";
constexpr const char* only_these = "the solid needs hexahedra (type 5), or quadrilaterals (type 3) in 2-D";
constexpr StrangeKind strange_kinds[] = {
    {2, "triangles", recombine},
    {4, "tetrahedra", transfinite},
    {6, "prisms", transfinite},
    {7, "pyramids", transfinite},
    {8, "second-order lines", first_order},
    {9, "second-order triangles", first_order},
    {10, "second-order quadrilaterals of 9 nodes", first_order},
    {11, "second-order tetrahedra", first_order},
    {12, "second-order hexahedra of 27 nodes", first_order},
    {13, "second-order prisms of 18 nodes", first_order},
    {14, "second-order pyramids of 14 nodes", first_order},
    {16, "second-order quadrilaterals of 8 nodes", first_order},
    {17, "second-order hexahedra of 20 nodes", first_order},
    {18, "second-order prisms of 15 nodes", first_order},
    {19, "second-order pyramids of 13 nodes", first_order},
};

StrangeKind strange_kind(std::int64_t type) {
  for (const StrangeKind& kind : strange_kinds) {
    if (kind.type == type) return kind;
  }
  return {type, "of another kind", only_these};
}

// ---- sections ----

/// Reads the file once from its start to its end.
class MshParser {
 public:
  explicit MshParser(const DataFile& file) : file_(file), lines_(file) {}

  MshFile parse() {
    read_format();
    while (lines_.next()) read_section(std::string(lines_.words()[0]));
    for (const char* section : {"$Nodes", "$Elements"}) {
      require_at(file_, {lines_.number(), 1, 1}, seen_.count(section) > 0,
                 "the file is cut short, or it has no mesh: ", section,
                 " is missing; mesh the geometry (gmsh -3, or -2 in 2-D) and save it again");
    }
    return std::move(mesh_);
  }

 private:
  void read_format() {
    require_at(file_, {}, !file_.text.empty(), "the file is empty; save the mesh again");
    const bool is_msh = lines_.next() && lines_.words()[0] == "$MeshFormat";
    require_at(file_, {}, is_msh || !looks_binary(file_.text),
               "this is no mesh of Gmsh: it should begin with $MeshFormat; save it as .msh, version 4.1, ASCII");
    require_at(file_, {1, 1, 1}, !lines_.words().empty(), "the file is empty; save the mesh again");
    require_at(file_, lines_.spot(0), is_msh, "this is no mesh of Gmsh: it should begin with $MeshFormat, not with ",
               lines_.quote(0), "; save it as .msh, version 4.1, ASCII");
    lines_.record({"the format (version, 0 for text, size of a number)"}, 3);
    const std::string_view version = lines_.words()[0];
    require_at(file_, lines_.spot(0), version == "4.1", "this is version ", lines_.quote(0),
               " of the format, but 4.1 is wanted: set Mesh.MshFileVersion = 4.1, or convert the file with "
               "gmsh FILE -save -format msh41 -o NEW");
    require_at(file_, lines_.spot(1), lines_.whole(1, "the type of the file") == 0,
               "this is a binary file, but text is wanted: set Mesh.Binary = 0, or convert the file with "
               "gmsh FILE -save -format msh41 -o NEW");
    require_at(file_, {}, !looks_binary(file_.text),
               "the file has bytes that no text has, although it says that it is text; copy or save it again");
    lines_.whole(2, "the size of a number");
    lines_.end_section("$MeshFormat");
    seen_.insert("$MeshFormat");
  }

  void read_section(const std::string& section) {
    const DataSpot spot = lines_.spot(0);
    require_at(file_, spot, section.size() > 1 && section[0] == '$' && section.rfind("$End", 0) != 0,
               "a section like $Nodes is wanted here, found ", lines_.quote(0),
               ": a count above is wrong or lines are lost; save the mesh again");
    require_at(file_, spot, section != "$PartitionedEntities",
               "the mesh is divided into partitions; save it in one piece (Mesh.NbPartitions = 0, or "
               "\"Unpartition\" in Gmsh)");
    const bool is_known = section == "$MeshFormat" || section == "$PhysicalNames" || section == "$Entities" ||
                          section == "$Nodes" || section == "$Elements";
    if (!is_known) {
      lines_.skip_section(section);
      return;
    }
    require_at(file_, spot, seen_.insert(section).second, section,
               " stands twice in the file: are these two meshes in one? Save the mesh again");
    if (section == "$PhysicalNames") read_names();
    if (section == "$Entities") read_entities(spot);
    if (section == "$Nodes") read_nodes();
    if (section == "$Elements") read_elements(spot);
  }

  void read_names() {
    lines_.record({"the line of counts in $PhysicalNames"}, 1);
    const std::int64_t count = lines_.count(0, "the number of names");
    for (std::int64_t i = 1; i <= count; ++i) {
      lines_.record({"name", i, count}, 3, any_number);
      const MshTag tag{static_cast<int>(lines_.whole_from(0, 3, 0, "the dimension of a group")),
                       lines_.whole_from(1, INT32_MAX, 1, "the tag of a group")};
      // The name may have blanks, so it is more than a word.
      const std::string_view line = lines_.line();
      const std::size_t open = line.find('"'), close = line.rfind('"');
      require_at(file_, lines_.spot(2), lines_.words()[2][0] == '"' && open < close,
                 "the name of a group must stand between two quotes, found ", lines_.quote(2), "; save the mesh again");
      std::string name(line.substr(open + 1, close - open - 1));
      if (name.empty()) name = std::to_string(tag.second);
      require_at(file_, lines_.spot(1), mesh_.groups.emplace(tag, MshGroup{name, lines_.number()}).second, "group ",
                 tag.second, " of dimension ", tag.first, " has a name already; save the mesh again");
    }
    lines_.end_section("$PhysicalNames");
  }

  void read_entities(const DataSpot& section) {
    require_at(file_, section, seen_.count("$Nodes") + seen_.count("$Elements") == 0,
               "$Entities must stand before $Nodes and $Elements; save the mesh again");
    lines_.record({"the line of counts in $Entities"}, 4);
    std::array<std::int64_t, 4> counts{};
    for (std::size_t dim = 0; dim < 4; ++dim) counts[dim] = lines_.count(dim, "the number of entities");
    constexpr const char* names[] = {"point", "curve", "surface", "volume"};
    for (int dim = 0; dim < 4; ++dim) {
      for (std::int64_t i = 1; i <= counts[dim]; ++i) read_entity({names[dim], i, counts[dim]}, dim);
    }
    lines_.end_section("$Entities");
  }

  /// A point: tag, place, groups. Anything else: tag, two corners of its box, groups, entities that bound it. Before
  /// groups and before bounds stands how many.
  void read_entity(const MshItem& item, int dim) {
    const std::size_t groups_at = dim == 0 ? 4 : 7;
    lines_.record(item, groups_at + 1, any_number);
    const MshTag entity{dim, lines_.whole(0, "the tag of an entity")};
    const std::size_t bounds_at = after_list(groups_at, "the number of groups");
    const std::size_t end = dim == 0 ? bounds_at : after_list(bounds_at, "the number of bounding entities");
    require_at(file_, lines_.spot(std::min(end, lines_.words().size() - 1)), end == lines_.words().size(), item,
               " has more numbers than it announces; save the mesh again");
    auto [place, is_new] = mesh_.groups_of_entity.emplace(entity, std::vector<std::int64_t>());
    require_at(file_, lines_.spot(0), is_new, item, " has the tag ", entity.second,
               ", which another one has; save the mesh again");
    for (std::size_t word = groups_at + 1; word < bounds_at; ++word) {
      // A minus says that the entity is turned round in this group.
      const std::int64_t group = std::abs(lines_.whole_from(-INT32_MAX, INT32_MAX, word, "the tag of a group"));
      if (std::count(place->second.begin(), place->second.end(), group) == 0) place->second.push_back(group);
      mesh_.groups.emplace(MshTag{dim, group}, MshGroup{std::to_string(group), lines_.number()});
    }
  }

  /// The word behind a list that begins with its length.
  std::size_t after_list(std::size_t at, const char* what) const {
    const std::size_t last = lines_.words().size() - 1;
    require_at(file_, lines_.spot(last), at <= last, what, " is missing; save the mesh again");
    const auto length = static_cast<std::size_t>(lines_.count(at, what));
    require_at(file_, lines_.spot(at), length <= last - at, what, " is ", length, ", but only ", last - at,
               " follow in the line; save the mesh again");
    return at + 1 + length;
  }

  void read_nodes() {
    lines_.record({"the line of counts in $Nodes"}, 4);
    const DataSpot total = lines_.spot(1);
    const std::int64_t blocks = lines_.count(0, "the number of blocks"), nodes = lines_.count(1, "the number of nodes");
    for (std::int64_t i = 1; i <= blocks; ++i) read_node_block({"block of nodes", i, blocks});
    lines_.end_section("$Nodes");
    require_at(file_, total, nodes == static_cast<std::int64_t>(mesh_.nodes.size()), "$Nodes announces ", nodes,
               " nodes, but its blocks have ", mesh_.nodes.size(), "; save the mesh again");
  }

  void read_node_block(const MshItem& item) {
    lines_.record(item, 4);
    const auto dim = static_cast<std::size_t>(lines_.whole_from(0, 3, 0, "the dimension of an entity"));
    lines_.whole(1, "the tag of an entity");
    const bool parametric = lines_.whole_from(0, 1, 2, "the mark of parametric nodes") == 1;
    const std::int64_t count = lines_.count(3, "the number of nodes in a block");
    const std::size_t first = mesh_.nodes.size();
    for (std::int64_t i = 1; i <= count; ++i) {
      lines_.record({"node tag", i, count}, 1);
      const std::int64_t tag = lines_.whole(0, "the tag of a node");
      require_at(file_, lines_.spot(0), node_of_tag_.emplace(tag, static_cast<int>(mesh_.nodes.size())).second, "node ",
                 tag, " stands twice in the file; save the mesh again");
      mesh_.nodes.emplace_back();
    }
    for (std::int64_t i = 1; i <= count; ++i) {
      lines_.record({"node", i, count}, parametric ? 3 + dim : 3);
      MshNode& node = mesh_.nodes[first + static_cast<std::size_t>(i) - 1];
      for (std::size_t d = 0; d < 3; ++d) node.position[d] = lines_.coordinate(d);
      node.line = lines_.number();
    }
  }

  void read_elements(const DataSpot& section) {
    require_at(file_, section, seen_.count("$Nodes") > 0, "$Nodes must stand before $Elements; save the mesh again");
    lines_.record({"the line of counts in $Elements"}, 4);
    const DataSpot total = lines_.spot(1);
    const std::int64_t blocks = lines_.count(0, "the number of blocks"),
                       elements = lines_.count(1, "the number of elements");
    for (std::int64_t i = 1; i <= blocks; ++i) read_element_block({"block of elements", i, blocks});
    lines_.end_section("$Elements");
    require_at(file_, total, elements == static_cast<std::int64_t>(mesh_.elements.size()), "$Elements announces ",
               elements, " elements, but its blocks have ", mesh_.elements.size(), "; save the mesh again");
  }

  void read_element_block(const MshItem& item) {
    lines_.record(item, 4);
    const MshTag entity{static_cast<int>(lines_.whole_from(0, 3, 0, "the dimension of an entity")),
                        lines_.whole(1, "the tag of an entity")};
    const std::int64_t type = lines_.whole(2, "the type of elements");
    const std::int64_t count = lines_.count(3, "the number of elements in a block");
    const Kind* kind = find_kind(type);
    if (kind == nullptr) {
      const StrangeKind strange = strange_kind(type);
      refuse(file_, lines_.spot(2), count, count == 1 ? " element" : " elements", " of Gmsh's type ", type, " (",
             strange.name, ") cannot be used: ", strange.cure);
    }
    require_at(file_, lines_.spot(0), kind->dim == entity.first, "elements of type ", type, " cannot be of dimension ",
               entity.first, "; save the mesh again");
    require_at(file_, lines_.spot(1), seen_.count("$Entities") == 0 || mesh_.groups_of_entity.count(entity) > 0,
               "$Entities has no entity ", entity.second, " of dimension ", entity.first, "; save the mesh again");
    mesh_.blocks.push_back({entity, kind->type, mesh_.elements.size(), static_cast<std::size_t>(count)});
    for (std::int64_t i = 1; i <= count; ++i) read_element({"element", i, count}, kind->nodes);
  }

  void read_element(const MshItem& item, int nodes) {
    lines_.record(item, 1 + static_cast<std::size_t>(nodes));
    lines_.whole(0, "the tag of an element");
    MshElement element;
    element.line = lines_.number();
    for (int a = 0; a < nodes; ++a) {
      const std::size_t word = 1 + static_cast<std::size_t>(a);
      const std::int64_t tag = lines_.whole(word, "the tag of a node");
      const auto found = node_of_tag_.find(tag);
      require_at(file_, lines_.spot(word), found != node_of_tag_.end(), "node ", tag,
                 " does not exist: $Nodes has no such tag; save the mesh again");
      const auto end = element.nodes.begin() + a;
      require_at(file_, lines_.spot(word), std::find(element.nodes.begin(), end, found->second) == end, "node ", tag,
                 " stands twice in this element, which has no shape then; mend the geometry and mesh it again");
      element.nodes[static_cast<std::size_t>(a)] = found->second;
    }
    mesh_.elements.push_back(element);
  }

  const DataFile& file_;
  MshLines lines_;
  MshFile mesh_;
  std::set<std::string> seen_;  // sections
  std::unordered_map<std::int64_t, int> node_of_tag_;
};

}  // namespace

int msh_nodes(int type) {
  const Kind* kind = find_kind(type);
  expect(kind != nullptr);
  return kind->nodes;
}

MshFile parse_msh(const DataFile& file) { return MshParser(file).parse(); }

}  // namespace greenwater
