// Surfaces from STL files: what is read, what is refused and how it is said, what is mended.

#include <cctype>
#include <numbers>

#include "app/scene_parts.hpp"
#include "core/interior.hpp"
#include "core/mesh_faults.hpp"
#include "io/case_file.hpp"
#include "io/stl.hpp"
#include "tests/catch.hpp"
#include "tests/meshes.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Place named{"case.toml", 12, 8, 1, nullptr};

std::string bad_stl(const std::string& name) {
  return std::string(GREENWATER_SOURCE_DIR) + "/tests/cases_bad/stl/" + name + ".stl";
}

/// [geometry.tank] of a case beside which the file lies, or that names it in full.
MeshCase mesh_of(const std::filesystem::path& file, const std::string& keys = {}) {
  const std::string text = "[geometry.tank]\nfile = \"" + file.filename().string() + "\"\n" + keys;
  CaseFile case_file(text, (file.parent_path() / "case.toml").string(), {});
  Section tank = case_file.root().table("geometry").table("tank");
  MeshCase mesh = read_mesh("tank", tank);
  case_file.finish();
  return mesh;
}

std::string complaint_about(const std::filesystem::path& file, const std::string& keys = {}) {
  try {
    mesh_of(file, keys);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

struct Bad {
  std::string file, keys, place, what, cure;
};

const std::string mend_would = "repair = \"mend\" in [geometry.tank] would mend this";
const std::string mend_would_not = "mend it in the program that made it";

const std::vector<Bad> bad_files{
    {"cut_short", "", "cut_short.stl:27:1: error: ", "ends within triangle 4", "copy or export it again"},
    {"nan_vertex", "", "nan_vertex.stl:13:16: error: ", "triangle 2: the coordinate nan is not a usable", "mend it in"},
    {"empty", "", "empty.stl: error: ", "the file is empty", "export the surface again"},
    {"no_triangles", "", "no_triangles.stl: error: ", "no triangles in the file", "export the surface again"},
    {"not_stl", "", "not_stl.stl: error: ", "no STL file", "this begins with \"# Wavefront\""},
    {"four_corners", "", "four_corners.stl:14:7: error: ", "more than three corners", "split faces into triangles"},
    {"hole", "closed = true",
     "hole.stl: error: ", "1 hole: 3 edges, 4.24264 round, about (0.333333, 0.333333, 0.333333)",
     "closed = true wants none: fill them, or leave closed out"},
    {"hole", "closed = true\nrepair = \"mend\"", "hole.stl: error: ", "1 hole: 3 edges", mend_would_not},
    {"flipped", "", "flipped.stl: error: ", "3 pairs of neighbours face opposite ways; the first: triangles 1 and 4",
     mend_would},
    {"inside_out", "", "inside_out.stl: error: ", "is inside out: its triangles face inwards", mend_would},
    {"sliver", "", "sliver.stl: error: ",
     "1 triangle is a sliver, with a height below 1e-6 of the longest edge: triangle 4", mend_would},
    {"no_area", "", "no_area.stl: error: ", "1 triangle has two corners at the same place", mend_would},
    {"three_on_an_edge", "", "three_on_an_edge.stl: error: ",
     "1 edge belongs to more than two triangles: from (1, 0, 0) to (0, 0, 0) for triangles 1, 2 and 5", mend_would_not},
    {"three_on_an_edge", "repair = \"mend\"", "three_on_an_edge.stl: error: ", "more than two triangles",
     mend_would_not},
};

coord volume_of(const TriangleMesh& mesh) { return Interior(mesh).measure(); }

bool is_good(const TriangleMesh& mesh) { return find_faults(mesh).sound() && find_faults(mesh).closed(); }

/// All words of the faults in one text.
std::string faults_in(const TriangleMesh& mesh) {
  std::string text;
  for (const std::string& words : find_faults(mesh).words) text += words + '\n';
  return text;
}

}  // namespace

TEST_CASE("bad STL files are refused with place and cure", "[unit][mesh]") {
  for (const Bad& bad : bad_files) {
    const std::string answer = complaint_about(bad_stl(bad.file), bad.keys);
    INFO(answer);
    CHECK(contains(answer, bad.place));
    CHECK(contains(answer, bad.what));
    CHECK(contains(answer, bad.cure));
    CHECK(contains(answer, "case.toml:2:8: the file is named here"));
  }
}

TEST_CASE("bad binary STL files are refused with byte and cure", "[unit][mesh]") {
  const TemporaryFolder folder;
  const std::string good = stl_binary(box_mesh({0, 0, 0}, {1, 1, 1}));
  std::string absurd = good, nan = good;
  absurd.replace(80, 4, "\xFF\xFF\xFF\xFF");
  nan.replace(84 + 50 * 2 + 12 + 4 * 4, 4, std::string("\0\0\xC0\x7F", 4));  // y of the second corner of triangle 3
  const std::vector<std::array<std::string, 3>> slips{
      {good.substr(0, 300),
       "cut short after triangle 4: byte 80 announces 12 triangles, which need 684 bytes, but the "
       "file has 300",
       "copy or export it again"},
      {absurd, "no STL file, or a damaged one: byte 80 announces 4294967295 triangles", "export the surface again"},
      {nan, "triangle 3 of 12 (byte 212): corner 2 has the coordinate nan", "mend it in the program"},
      {good + "more", "longer than its triangles", "export the surface again"},
      {good.substr(0, 80) + std::string(4, '\0'), "no triangles in the file", "export the surface again"},
      {"PNG\r\n\x1a\n", "no STL file", "export the surface again"},
  };
  for (const auto& [bytes, what, cure] : slips) {
    write_text(folder / "bad.stl", bytes);
    const std::string answer = complaint_about(folder / "bad.stl");
    INFO(answer);
    CHECK(contains(answer, "bad.stl: error: "));
    CHECK(contains(answer, what));
    CHECK(contains(answer, cure));
  }
  CHECK(contains(complaint_about(folder / "none.stl"), "case.toml:2:8: error: there is no file"));
}

TEST_CASE("text and binary STL give the same mesh, whatever the title says", "[unit][mesh]") {
  const TemporaryFolder folder;
  const TriangleMesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  std::string upper = stl_text(box);
  for (char& c : upper) c = c == '\n' ? c : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::string& bytes : {stl_text(box), stl_binary(box), stl_binary(box, "solid tank"), upper,
                                   "\r\n " + stl_text(box) + stl_text({}), "solid\n" + stl_text(box).substr(11)}) {
    write_text(folder / "box.stl", bytes);
    const TriangleMesh mesh = read_stl(folder / "box.stl", named);
    CHECK(mesh.vertices.size() == 8);
    CHECK(mesh.triangles.size() == 12);
    CHECK(is_good(mesh));
    CHECK(volume_of(mesh) == Approx(6));
  }
}

TEST_CASE("a mesh is scaled, turned, then moved", "[unit][mesh]") {
  const TemporaryFolder folder;
  write_text(folder / "box.stl", stl_text(box_mesh({0, 0, 0}, {100, 200, 300})));
  const MeshCase mesh =
      mesh_of(folder / "box.stl", "unit = \"mm\"\nturn = \"90 deg\"\naxis = [0, 0, 2]\nmove = [1, 0, 0.5]\n");
  const MeshBounds bounds = bounds_of(mesh.mesh);
  const std::array<coord, 3> low{0.8, 0, 0.5}, high{1, 0.1, 0.8};
  for (std::size_t d = 0; d < 3; ++d) {
    CHECK(bounds.low[d] == Approx(low[d]).margin(1e-15));
    CHECK(bounds.high[d] == Approx(high[d]).margin(1e-15));
  }
  CHECK(mesh.repairs.empty());
  CHECK(contains(complaint_about(folder / "box.stl", "unit = \"ft\""), "unit cannot be \"ft\""));
  CHECK(contains(complaint_about(folder / "box.stl", "axis = [0, 0, 0]"), "has no direction"));
  CHECK(contains(complaint_about(folder / "box.stl", "scale = 2"), "unknown key \"scale\""));
}

TEST_CASE("what can be mended is mended, and told", "[unit][mesh]") {
  const std::vector<std::array<std::string, 2>> mended{
      {"flipped", "turned 1 triangle"},
      {"inside_out", "turned 4 triangles"},
      {"sliver", "undid 1 triangle as slivers"},
      {"no_area", "took out 1 triangle without area"},
  };
  for (const auto& [file, done] : mended) {
    const MeshCase mesh = mesh_of(bad_stl(file), "closed = true\nrepair = \"mend\"");
    INFO(file);
    REQUIRE(mesh.repairs.size() == 1);
    CHECK(contains(mesh.repairs.front(), done));
    CHECK(is_good(mesh.mesh));
    CHECK(volume_of(mesh.mesh) == Approx(1.0 / 6));
  }
  CHECK(mesh_of(bad_stl("hole")).mesh.triangles.size() == 3);
}

TEST_CASE("an open tank is sound but not closed", "[unit][mesh]") {
  VTank tank{std::numbers::pi / 6, 0.8, 2.5};
  CHECK(is_good(v_tank_mesh(tank)));
  CHECK(is_good(turned(v_tank_mesh(tank), {1, 1, 0}, 0.4)));
  tank.open_top = true;
  const MeshFaults faults = find_faults(v_tank_mesh(tank));
  CHECK(faults.sound());
  REQUIRE(faults.holes.size() == 1);
  CHECK(faults.holes[0].edges == 4);
  CHECK(faults.holes[0].length == Approx(2 * 2.5 + 4 * tank.half_width()));
  CHECK(faults.holes[0].centre[2] == Approx(0.8));
}

TEST_CASE("faults of a mesh are named and mended", "[unit][mesh]") {
  const TriangleMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  SECTION("a triangle twice") {
    TriangleMesh mesh = box;
    mesh.triangles.push_back({1, 0, 2});
    CHECK(contains(faults_in(mesh), "1 triangle stands at the place of another: triangle 1 and again triangle 13"));
    mend(mesh);
    CHECK(is_good(mesh));
  }
  SECTION("a cavity that faces outwards") {
    TriangleMesh mesh = together(box, box_mesh({0.2, 0.2, 0.2}, {0.4, 0.4, 0.4}));
    CHECK(contains(faults_in(mesh), "the part with triangle 13 at (0.266667, 0.266667, 0.2) is a cavity"));
    mend(mesh);
    CHECK(is_good(mesh));
    CHECK(volume_of(mesh) == Approx(1 - 0.008));
  }
  SECTION("vertices on the edge of a triangle, and slivers in their place") {
    // The lid has its edge at y = 0 in pieces, the side below does not.
    TriangleMesh mesh = box;
    for (const coord x : {0.25, 0.5, 0.75}) mesh.vertices.push_back({x, 0, 1});
    mesh.triangles.erase(mesh.triangles.begin() + 2);
    for (const auto& [from, to] : {std::pair{4, 8}, {8, 9}, {9, 10}, {10, 5}}) mesh.triangles.push_back({from, to, 6});
    CHECK(contains(faults_in(mesh), "3 vertices lie on an edge that does not end there (T-junction); the first: "));
    TriangleMesh with_slivers = mesh;
    for (const auto& [a, b, c] : {std::array{5, 9, 4}, {4, 9, 8}, {9, 5, 10}})
      with_slivers.triangles.push_back({c, b, a});
    for (TriangleMesh* broken : {&mesh, &with_slivers}) {
      CHECK(!is_good(*broken));
      const auto done = mend(*broken);
      INFO(faults_in(*broken));
      CHECK(!done.empty());
      CHECK(is_good(*broken));
      CHECK(broken->triangles.size() == 18);
      CHECK(volume_of(*broken) == Approx(1));
    }
  }
  SECTION("a needle") {
    TriangleMesh mesh = box;
    mesh.vertices.push_back({1e-7, 0, 0});  // beside vertex 0
    mesh.triangles[4] = {8, 1, 4};
    mesh.triangles[0] = {8, 2, 1};
    mesh.triangles.push_back({0, 8, 4});
    mesh.triangles.push_back({0, 2, 8});
    CHECK(contains(faults_in(mesh), "2 triangles are slivers"));
    mend(mesh);
    CHECK(is_good(mesh));
    CHECK(mesh.triangles.size() == 12);
  }
  SECTION("half of the triangles turned") {
    TriangleMesh mesh = sphere_mesh({0, 0, 0}, 1, 12);
    for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
    CHECK(contains(faults_in(mesh), "face opposite ways"));
    mend(mesh);
    CHECK(is_good(mesh));
  }
  SECTION("one side only") {
    TriangleMesh mesh;
    constexpr int around = 20;
    for (int i = 0; i < around; ++i) {
      const coord a = 2 * std::numbers::pi * i / around;
      for (const coord side : {-0.3, 0.3}) {
        const coord r = 1 + side * std::cos(a / 2);
        mesh.vertices.push_back({r * std::cos(a), r * std::sin(a), side * std::sin(a / 2)});
      }
    }
    for (int i = 0; i < around; ++i) {
      const int a = 2 * i, b = 2 * i + 1, next = i + 1 < around ? 2 * i + 2 : 1, top = i + 1 < around ? 2 * i + 3 : 0;
      mesh.triangles.push_back({a, next, b});
      mesh.triangles.push_back({b, next, top});
    }
    mend(mesh);
    CHECK(contains(faults_in(mesh), "has one side only"));
  }
  SECTION("nothing left") {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    mesh.triangles = {{0, 1, 2}};
    mend(mesh);
    CHECK(contains(faults_in(mesh), "there is no triangle with an area"));
  }
}
