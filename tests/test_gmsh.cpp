// Meshes of solids from Gmsh: what is read, what is refused and how it is said.

#include <unistd.h>

#include <iomanip>

#include "io/gmsh.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Place named{"case.toml", 12, 8, 1, nullptr};

/// Two cubes along x, between them the nodes 3, 4, 7 and 8. The right end is clamped, the top is wet, the foot of the
/// left end is a group of a point, the whole a group of a volume; node 99 belongs to nobody. Curve 5 and the left end
/// (surface 22) are in no group.
const std::string beam = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 4 "foot"
2 7 "wet top"
3 1 "beam"
$EndPhysicalNames
$Entities
1 1 3 1
1 0 0 0 1 4 
5 0 0 0 1 0 0 0 2 1 -2 
20 0 0 1 2 1 1 1 7 2 5 6 
21 2 0 0 2 1 1 2 -9 7 0 
22 0 0 0 0 1 1 0 0 
1 0 0 0 2 1 1 1 1 3 20 21 22 
$EndEntities
$Nodes
3 13 1 120
0 1 0 1
1
0 0 0
2 20 1 2
102
110
0 0 1 0.25 0.5
1 0 1 0.25 0.5
3 1 0 10
3
4
7
120
8
111
112
113
114
99
1 0 0
1 1 0
0 1 0
2 0 0
1 1 1
0 1 1
2 1 0
2 0 1
2 1 1
5 5 5
$EndNodes
$Periodic
0
$EndPeriodic
$Elements
6 8 1 40
0 1 15 1
1 1
1 5 1 1
2 1 3
2 20 3 2
3 102 110 8 111
4 8 110 113 114
2 21 3 1
40 120 112 114 113
2 22 3 1
41 1 102 111 7
3 1 5 2
5 1 3 4 7 102 110 8 111
6 3 120 112 4 110 113 114 8
$EndElements
)";

/// Two squares along x with a line below both, all turned round and without names.
const std::string plate = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$Entities
0 2 1 0
1 0 0 0 2 0 0 1 3 0
2 0 0 0 0 1 0 0 0
1 0 0 0 2 1 0 1 5 0
$EndEntities
$Nodes
1 6 1 6
2 1 0 6
1
2
3
4
5
6
0 0 0
1 0 1e-17
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
2 4 1 4
1 1 1 2
1 2 1
2 3 2
2 1 3 2
3 1 2 5 4
4 2 3 6 5
$EndElements
)";

SolidMesh mesh_of(const std::string& text) {
  const TemporaryFolder folder;
  write_text(folder / "solid.msh", text);
  return read_gmsh(folder / "solid.msh", named);
}

std::string complaint_about(const std::string& text) {
  try {
    mesh_of(text);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

/// The text with the first `old` after `from` replaced.
std::string with(std::string text, const std::string& old, const std::string& other, const std::string& from = {}) {
  const std::size_t at = text.find(old, text.find(from));
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), other);
}

struct Slip {
  std::string text, place, what, cure;
};

void check(const std::vector<Slip>& slips) {
  for (const Slip& slip : slips) {
    const std::string answer = complaint_about(slip.text);
    INFO(answer);
    INFO(slip.what);
    CHECK(contains(answer, "solid.msh" + slip.place + " error: "));
    CHECK(contains(answer, slip.what));
    CHECK(contains(answer, slip.cure));
    CHECK(contains(answer, "case.toml:12:8: the file is named here"));
  }
}

std::vector<std::array<double, 3>> places_of(const SolidMesh& mesh, const std::string& part) {
  std::vector<std::array<double, 3>> places;
  const MeshPart* found = find_part(mesh, part);
  REQUIRE(found != nullptr);
  for (const int node : found->nodes) places.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
  return places;
}

const std::string save_again = "save the mesh again";

}  // namespace

TEST_CASE("hexahedra and physical groups are read", "[unit][gmsh]") {
  const SolidMesh mesh = mesh_of(beam);
  CHECK(mesh.dim == 3);
  CHECK(mesh.nodes.size() == 12);  // without node 99
  REQUIRE(mesh.elements.size() == 2);
  CHECK(mesh.elements[0] == std::array<int, 8>{0, 3, 4, 5, 1, 2, 7, 8});
  CHECK(mesh.nodes[7] == std::array<double, 3>{1, 1, 1});
  CHECK(part_names(mesh) == "\"foot\", \"wet top\", \"9\", \"beam\"");
  CHECK(find_part(mesh, "foot")->nodes == std::vector<int>{0});
  CHECK(find_part(mesh, "foot")->facets.empty());
  CHECK(find_part(mesh, "beam")->nodes.size() == 12);
  // Surface 21 is in two groups, of which one has no name and one has it turned round.
  CHECK(find_part(mesh, "9")->facets == std::vector<Facet>{{1, 1}});
  CHECK(places_of(mesh, "9") == std::vector<std::array<double, 3>>{{2, 0, 0}, {2, 1, 0}, {2, 0, 1}, {2, 1, 1}});
  CHECK(find_part(mesh, "wet top")->facets == std::vector<Facet>{{0, 5}, {1, 5}, {1, 1}});
  CHECK(find_part(mesh, "wet top")->nodes.size() == 8);
}

TEST_CASE("a group of curves in 3-D is a part of nodes", "[unit][gmsh]") {
  const SolidMesh mesh = mesh_of(with(beam, "5 0 0 0 1 0 0 0 2", "5 0 0 0 1 0 0 1 33 2"));
  REQUIRE(find_part(mesh, "33") != nullptr);
  CHECK(find_part(mesh, "33")->nodes == std::vector<int>{0, 3});
  CHECK(find_part(mesh, "33")->facets.empty());
}

TEST_CASE("quadrilaterals are a solid in 2-D, and lines its sides", "[unit][gmsh]") {
  const SolidMesh mesh = mesh_of(plate);
  CHECK(mesh.dim == 2);
  CHECK(mesh.nodes.size() == 6);
  CHECK(mesh.nodes[1] == std::array<double, 3>{1, 0, 0});
  REQUIRE(mesh.elements.size() == 2);
  CHECK(mesh.elements[1] == std::array<int, 8>{1, 2, 5, 4, 0, 0, 0, 0});
  CHECK(part_names(mesh) == "\"3\", \"5\"");
  CHECK(find_part(mesh, "3")->facets == std::vector<Facet>{{0, 2}, {1, 2}});
  CHECK(find_part(mesh, "3")->nodes == std::vector<int>{0, 1, 2});
  CHECK(find_part(mesh, "5")->nodes.size() == 6);
  CHECK(find_part(mesh, "5")->facets.empty());
}

TEST_CASE("a mesh written and read is the same", "[unit][gmsh]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = box_mesh(dim, {-1, 0, 0}, {1, 2, dim == 3 ? 3.0 : 0.0}, {3, 2, 2});
    const std::size_t sides = mesh.parts.size();
    const auto on_sides = [&] {
      std::size_t count = 0;
      for (const MeshPart& part : mesh.parts) count += part.facets.size();
      return count;
    }();
    std::string names, entities, nodes, elements;
    const std::string in_dim = std::to_string(dim), on_dim = std::to_string(dim - 1);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) nodes += text_of(1000 + 3 * i, '\n');  // tags with gaps
    for (const auto& x : mesh.nodes) nodes += text_of(std::setprecision(17), x[0], ' ', x[1], ' ', x[2], '\n');
    const auto line_of = [&](const auto& corners, int count) {
      std::string line = "1";
      for (int a = 0; a < count; ++a) line += text_of(' ', 1000 + 3 * corners[static_cast<std::size_t>(a)]);
      return line + '\n';
    };
    for (std::size_t s = 0; s < sides; ++s) {
      const MeshPart& part = mesh.parts[s];
      names += text_of(on_dim, ' ', s + 1, " \"", part.name, "\"\n");
      entities += text_of(s + 1, " 0 0 0 0 0 0 1 ", s + 1, " 0\n");
      elements += text_of(on_dim, ' ', s + 1, dim == 3 ? " 3 " : " 1 ", part.facets.size(), '\n');
      for (const Facet facet : part.facets) elements += line_of(nodes_of(mesh, facet), mesh.nodes_per_side());
    }
    elements += text_of(in_dim, " 1 ", dim == 3 ? 5 : 3, ' ', mesh.elements.size(), '\n');
    for (const auto& element : mesh.elements) elements += line_of(element, mesh.nodes_per_element());
    const std::string text = text_of("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n", sides, '\n', names,
                                     "$EndPhysicalNames\n$Entities\n", dim == 3 ? "0 0 6 1\n" : "0 4 1 0\n", entities,
                                     "1 0 0 0 0 0 0 0 0\n$EndEntities\n$Nodes\n1 ", mesh.nodes.size(), " 1 1\n", in_dim,
                                     " 1 0 ", mesh.nodes.size(), '\n', nodes, "$EndNodes\n$Elements\n", sides + 1, ' ',
                                     on_sides + mesh.elements.size(), " 1 1\n", elements, "$EndElements\n");
    const SolidMesh again = mesh_of(text);
    CHECK(again.dim == dim);
    CHECK(again.nodes == mesh.nodes);
    CHECK(again.elements == mesh.elements);
    REQUIRE(again.parts.size() == sides);
    for (std::size_t s = 0; s < sides; ++s) {
      CHECK(again.parts[s].name == mesh.parts[s].name);
      CHECK(again.parts[s].facets == mesh.parts[s].facets);
      CHECK(again.parts[s].nodes == mesh.parts[s].nodes);
    }
  }
}

TEST_CASE("a mesh needs no groups and no entities, and line ends do not matter", "[unit][gmsh]") {
  const std::string bare = plate.substr(0, plate.find("$Entities")) + plate.substr(plate.find("$Nodes"));
  CHECK(mesh_of(bare).parts.empty());
  CHECK(part_names(mesh_of(bare)) == "none");
  std::string windows;
  for (const char c : beam) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  CHECK(mesh_of(windows).parts.size() == 4);
  CHECK(mesh_of(with(beam, "$Nodes\n", "\n  \n$Nodes\n\n")).nodes == mesh_of(beam).nodes);
  CHECK(mesh_of(beam.substr(0, beam.size() - 1)).elements == mesh_of(beam).elements);
  // An empty name, and one with a quote in it.
  CHECK(part_names(mesh_of(with(beam, "\"beam\"", "\"\""))) == "\"foot\", \"wet top\", \"9\", \"1\"");
  CHECK(find_part(mesh_of(with(beam, "\"foot\"", "\"5\" foot\"")), "5\" foot") != nullptr);
}

TEST_CASE("a mesh is scaled", "[unit][gmsh]") {
  SolidMesh mesh = mesh_of(beam);
  scale(mesh, 1e-3);
  CHECK(mesh.nodes[7] == std::array<double, 3>{1e-3, 1e-3, 1e-3});
}

TEST_CASE("a mesh that is cut short anywhere is refused", "[unit][gmsh]") {
  for (const std::string& whole : {beam, plate}) {
    std::size_t told = 0;
    for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {
      const std::string answer = complaint_about(whole.substr(0, bytes));
      INFO(bytes << " bytes: " << answer);
      REQUIRE(contains(answer, "solid.msh"));
      if (contains(answer, "the file is cut short")) ++told;
    }
    // Not within the first words, which make it another file, and not where a number has lost its last digits.
    CHECK(told > whole.size() * 4 / 5);
  }
  check({{beam.substr(0, beam.find("1 0 1 0.25")), ":27:1:", "it ends where node 2 of 2 should be", "copy or save it"},
         {beam.substr(0, beam.find("110 113 114 8\n") + 7), ":69:19:", "it ends within this line", "copy or save it"},
         {beam.substr(0, beam.find("$EndPeriodic")), ":51:1:", "$Periodic has no $EndPeriodic", "copy or save it"},
         {beam.substr(0, beam.find("$EndElements")), ":69:1:", "$EndElements is missing", "copy or save it"},
         {beam.substr(0, beam.find("$Elements")), ":53:1:", "$Elements is missing", "mesh the geometry"},
         {"", ":", "the file is empty", save_again}});
}

TEST_CASE("files that are no text of Gmsh 4.1 are refused with the way to it", "[unit][gmsh]") {
  check({{with(beam, "4.1 0", "2.2 0"), ":2:1:", "this is version \"2.2\" of the format", "-format msh41"},
         {with(beam, "4.1 0", "4 0"), ":2:1:", "this is version \"4\" of the format", "Mesh.MshFileVersion = 4.1"},
         {with(beam, "4.1 0", "4.0 0"), ":2:1:", "4.1 is wanted", "Mesh.MshFileVersion = 4.1"},
         {with(beam, "4.1 0 8\n", "4.1 1 8\n" + std::string("\1\0\0\0\n", 5)), ":2:5:", "a binary file",
          "Mesh.Binary = 0"},
         {with(beam, "1 1 0", std::string("1 \0 0", 5)), ":", "bytes that no text has", "copy or save it"},
         {with(beam, "0 8", "0 x"), ":2:7:", "the size of a number must be a whole number, found \"x\"", save_again},
         {"solid test\n", ":1:1:", "it should begin with $MeshFormat, not with \"solid\"", "version 4.1"},
         {std::string("\x89PNG\r\n\0", 7), ":", "it should begin with $MeshFormat", "version 4.1"},
         {"\n \n", ":1:1:", "the file is empty", save_again}});
  CHECK_THROWS_WITH(read_gmsh("none.msh", named), Catch::Contains("case.toml:12:8: error: there is no file none.msh"));
}

TEST_CASE("a file of a mesh that may not be read ends with exit code 4", "[unit][gmsh]") {
  if (geteuid() == 0) return;  // who may read everything
  const TemporaryFolder folder;
  write_text(folder / "solid.msh", beam);
  std::filesystem::permissions(folder / "solid.msh", std::filesystem::perms::none);
  CHECK_THROWS_AS(read_gmsh(folder / "solid.msh", named), FileError);
}

TEST_CASE("elements that the solid cannot use are named, with the cure", "[unit][gmsh]") {
  const auto of_type = [](const std::string& type) { return with(beam, "3 1 5 2", "3 1 " + type + " 2"); };
  check({{of_type("4"), ":67:5:", "2 elements of Gmsh's type 4 (tetrahedra) cannot be used", "Transfinite Volume"},
         {of_type("6"), ":67:5:", "type 6 (prisms)", "Transfinite Volume"},
         {of_type("7"), ":67:5:", "type 7 (pyramids)", "Transfinite Volume"},
         {of_type("17"), ":67:5:", "type 17 (second-order hexahedra of 20 nodes)", "Mesh.ElementOrder = 1"},
         {of_type("12"), ":67:5:", "type 12 (second-order hexahedra of 27 nodes)", "Mesh.ElementOrder = 1"},
         {of_type("92"), ":67:5:", "type 92 (of another kind)", "needs hexahedra"},
         {of_type("3"), ":67:1:", "elements of type 3 cannot be of dimension 3", save_again},
         {with(plate, "2 1 3 2", "2 1 2 2"), ":31:5:", "type 2 (triangles)", "Mesh.RecombineAll = 1"},
         {with(plate, "1 1 1 2", "1 1 8 2"), ":28:5:", "type 8 (second-order lines)", "Mesh.ElementOrder = 1"}});
}

TEST_CASE("counts that lie are told", "[unit][gmsh]") {
  check({
      {with(beam, "3\n0 4", "4\n0 4"), ":9:1:", "name 4 of 4 is missing: \"$EndPhysicalNames\" comes too early",
       "lost"},
      {with(beam, "3\n0 4", "2\n0 4"), ":8:1:", "$EndPhysicalNames is wanted here, found \"3\"", save_again},
      {with(beam, "1 1 3 1\n", "1 1 2 1\n"), ":17:1:", "$EndEntities is wanted here, found \"1\"", save_again},
      {with(beam, "1 1 3 1\n", "1 1 3 2\n"), ":18:1:", "volume 2 of 2 is missing", save_again},
      {with(beam, "1 1 3 1\n", "1 1 3\n"),
       ":11:5:", "the line of counts in $Entities needs 4 words in its line, found 3", save_again},
      {with(beam, "1 0 0 0 1 4", "1 0 0 0 2 4"), ":12:9:", "the number of groups is 2, but only 1 follow", save_again},
      {with(beam, "1 0 0 0 1 4", "1 0 0 0 1 4 5"), ":12:13:", "has more numbers than it announces", save_again},
      {with(beam, "1 7 2 5 6", "1 7 3 5 6"), ":14:20:", "bounding entities is 3, but only 2 follow", save_again},
      {with(beam, "1 7 2 5 6", "1 7"), ":14:18:", "the number of bounding entities is missing", save_again},
      {with(beam, "3 13 1 120", "3 14 1 120"), ":20:3:", "announces 14 nodes, but its blocks have 13", save_again},
      {with(beam, "3 13 1 120", "2 13 1 120"), ":29:1:", "$EndNodes is wanted here, found \"3\"", save_again},
      {with(beam, "3 13 1 120", "3 999999 1 120"), ":20:3:", "the number of nodes, 999999, is more than", "copy"},
      {with(beam, "3 13 1 120", "-3 13 1 120"), ":20:1:", "the number of blocks cannot be -3", save_again},
      {with(beam, "3 1 0 10\n", "3 1 0 9\n"), ":39:1:", "node 1 of 9 needs 3 words in its line, found 1", save_again},
      {with(beam, "3 1 0 10\n", "3 1 0 11\n"), ":40:3:", "node tag 11 of 11 needs 1 word in its line", save_again},
      {with(beam, "2 20 1 2", "2 20 0 2"), ":27:7:", "node 1 of 2 needs 3 words in its line, found 5", save_again},
      {with(beam, "2 20 1 2", "2 20 2 2"), ":24:6:", "the mark of parametric nodes must be from 0 to 1", save_again},
      {with(beam, "6 8 1 40", "6 9 1 40"), ":55:3:", "announces 9 elements, but its blocks have 8", save_again},
      {with(beam, "6 8 1 40", "7 8 1 40"), ":70:1:", "block of elements 7 of 7 is missing", save_again},
      {with(beam, "6 8 1 40", "5 8 1 40"), ":67:1:", "$EndElements is wanted here, found \"3\"", save_again},
      {with(beam, "3 1 5 2", "3 1 5 3"), ":70:1:", "element 3 of 3 is missing", save_again},
      {with(beam, "3 1 5 2", "3 1 5 1"), ":69:1:", "$EndElements is wanted here, found \"6\"", save_again},
      {with(beam, "2 21 3 1", "2 21 3 2"), ":65:8:", "element 2 of 2 needs 5 words in its line, found 4", save_again},
  });
}

TEST_CASE("what the numbers of a mesh cannot be is told", "[unit][gmsh]") {
  check({
      {with(beam, "5 5 5\n", "5 five 5\n"), ":49:3:", "\"five\" is not a number", "like 0.25"},
      {with(beam, "5 5 5\n", "5 5 nan\n"), ":49:5:", "\"nan\" is not a usable number", "mend it in the program"},
      {with(beam, "5 5 5\n", "1e999 5 5\n"), ":49:1:", "\"1e999\" is not a usable number", "mend it in the program"},
      {with(beam, "5 5 5\n", "1e31 5 5\n"), ":49:1:", "\"1e31\" is not a usable number", "mend it in the program"},
      {with(beam, "\n120\n8\n", "\n3\n8\n"), ":33:1:", "node 3 stands twice", save_again},
      {with(beam, "\n120\n8\n", "\n1.5\n8\n"), ":33:1:", "must be a whole number, found \"1.5\"", save_again},
      {with(beam, "5 1 3 4 7", "5 1 3 5 7"), ":68:7:", "node 5 does not exist", save_again},
      {with(beam, "5 1 3 4 7", "5 1 3 3 7"), ":68:7:", "node 3 stands twice in this element", "mend the geometry"},
      {with(beam, "3 1 5 2", "4 1 5 2"), ":67:1:", "the dimension of an entity must be from 0 to 3", save_again},
      {with(beam, "3 1 5 2", "3 2 5 2"), ":67:3:", "$Entities has no entity 2 of dimension 3", save_again},
      {with(beam, "22 0 0 0 0 1", "21 0 0 0 0 1"), ":16:1:", "surface 3 of 3 has the tag 21", save_again},
      {with(beam, "2 7 \"wet", "0 4 \"wet"), ":7:3:", "group 4 of dimension 0 has a name already", save_again},
      {with(beam, "\"wet top\"", "wet top"), ":7:5:", "must stand between two quotes", save_again},
      {with(beam, "\"wet top\"", "\"wet top"), ":7:5:", "must stand between two quotes", save_again},
  });
}

TEST_CASE("sections that are out of place are told", "[unit][gmsh]") {
  const std::string nodes = beam.substr(beam.find("$Nodes"), beam.find("$Periodic") - beam.find("$Nodes"));
  const std::string entities = beam.substr(beam.find("$Entities"), beam.find("$Nodes") - beam.find("$Entities"));
  check({
      {with(beam, "$Periodic", nodes + "$Periodic"), ":51:1:", "$Nodes stands twice in the file",
       "Save the mesh again"},
      {with(beam, nodes, ""), ":22:1:", "$Nodes must stand before $Elements", save_again},
      {with(with(beam, entities, ""), "$Periodic", entities + "$Periodic"),
       ":42:1:", "$Entities must stand before $Nodes", save_again},
      {with(beam, "$Periodic", "$PartitionedEntities"), ":51:1:", "divided into partitions", "NbPartitions = 0"},
      {with(beam, "$Periodic", "17"), ":51:1:", "a section like $Nodes is wanted here, found \"17\"", save_again},
  });
}

TEST_CASE("groups that cannot be parts are told", "[unit][gmsh]") {
  const std::string second_top = "4 8 110 113 114";
  const std::string alone = with(with(plate, "2 1 3 2\n3 1 2 5 4\n4 2 3 6 5\n", ""), "2 4 1 4", "1 2 1 4");
  check({
      {with(beam, second_top, "4 8 110 113 112"), ":62:1:", "group \"wet top\" is not a side of any hexahedron",
       "only surfaces that bound the solid"},
      {with(beam, second_top, "4 8 110 113 99"), ":62:1:", "is not a side of any hexahedron", "Coherence"},
      {with(beam, second_top, "4 3 4 8 110"), ":62:1:", "lies between 2 elements", "on the outside of the solid"},
      {with(beam, second_top, "4 8 111 102 110"), ":62:1:", "stands twice in the file", "delete one of the two"},
      {with(plate, "2 3 2\n", "2 2 5\n", "$Elements"), ":30:1:", "this line of group \"3\" lies between 2 elements",
       "only curves"},
      {with(plate, "2 3 2\n", "2 3 5\n", "$Elements"),
       ":30:1:", "this line of group \"3\" is not a side of any quadrilateral", "only curves"},
      {with(beam, "\"beam\"", "\"foot\""), ":8:1:", "two groups are called \"foot\", and one of them is of volumes",
       "Physical Volume(\"foot volumes\", 1)"},
      {with(beam, "3\n0 4", "4\n1 6 \"edge\"\n0 4"), ":6:1:", "group \"edge\" of curves has no elements",
       "delete Physical Curve 6"},
      {with(beam, "1 1 3 1\n1 0 0 0 1 4 \n", "1 2 3 1\n1 0 0 0 1 4\n6 0 0 0 1 0 0 1 33 0\n"),
       ":13:1:", "group \"33\" of curves has no elements", "that are meshed"},
      {with(beam, "15 1\n1 1\n", "15 1\n1 99\n"), ":57:1:", "group \"foot\" of points has a node here that no element",
       "embed them (Point{...} In Volume{...})"},
      {alone, ":", "there are no hexahedra in the file, nor quadrilaterals", "put the solid into one"},
      {with(plate, "1 0 1e-17", "1 0 0.5"), ":20:1:", "do not lie in the plane z = 0, for here z = 0.5", "gmsh -3"},
  });
}
