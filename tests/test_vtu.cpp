// Frames of a solid for ParaView: what stands in the file, and that it moves.

#include "io/paraview.hpp"
#include "tests/vtk_file.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// Node i moves by (i / 8, -i, i / 4), in 2-D without the last; float32 holds all of these exactly.
SolidFrame frame_of(const SolidMesh& mesh, double time) {
  SolidFrame frame;
  frame.time = time;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const auto x = static_cast<double>(i);
    frame.displacement.push_back({x / 8, -x, mesh.dim == 3 ? x / 4 : 0});
    frame.velocity.push_back({1, x, 0});
  }
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    const auto s = static_cast<double>(e);
    frame.stress.push_back({s, s + 1, s + 2, s + 3, s + 4, s + 5});
  }
  return frame;
}

Floats moved(const SolidMesh& mesh, const SolidFrame& frame) {
  Floats places;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    for (std::size_t d = 0; d < 3; ++d) {
      places.push_back(static_cast<float>(mesh.nodes[i][d] + frame.displacement[i][d]));
    }
  }
  return places;
}

}  // namespace

TEST_CASE("a .vtu of hexahedra has nodes where they are, and every array where it says", "[unit][output]") {
  const TemporaryFolder folder;
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {2, 1, 1}, {2, 1, 1});
  SolidFrame frame = frame_of(mesh, 0.25);
  frame.node_data = {{"clamped", "-", 1, Bytes{1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}}};
  frame.element_data = {{"energy", "J", 1, std::vector<double>{0.5, 1.5}},
                        {"element", "-", 1, std::vector<std::int64_t>{7, 8}}};
  Paraview paraview(folder.path(), "beam");
  paraview.write(mesh, frame);
  const VtkFile vtu(folder / "beam/beam_000000.vtu");
  CHECK(vtu.kind == "UnstructuredGrid");
  CHECK(vtu.counts == std::map<std::string, int>{{"Points", 12}, {"Cells", 2}});
  CHECK(vtu.arrays.size() == 11);
  CHECK(vtu.values<double>("FieldData/TimeValue") == std::vector<double>{0.25});
  CHECK(vtu.values<float>("Points/Points") == moved(mesh, frame));
  CHECK(vtu.values<std::int32_t>("Cells/connectivity") == Ints{0, 1, 4, 3, 6, 7, 10, 9, 1, 2, 5, 4, 7, 8, 11, 10});
  CHECK(vtu.values<std::int32_t>("Cells/offsets") == Ints{8, 16});
  CHECK(vtu.values<std::uint8_t>("Cells/types") == Bytes{12, 12});
  const Floats displacement = vtu.values<float>("PointData/displacement");
  REQUIRE(displacement.size() == 36);
  CHECK(Floats(displacement.end() - 3, displacement.end()) == Floats{1.375F, -11, 2.75F});
  CHECK(vtu.values<float>("PointData/velocity").at(34) == 11);
  CHECK(vtu.values<float>("CellData/stress") == Floats{0, 1, 2, 3, 4, 5, 1, 2, 3, 4, 5, 6});
  CHECK(vtu.components.at("CellData/stress") == "6");
  CHECK(vtu.components.at("PointData/velocity") == "3");
  CHECK(vtu.values<std::uint8_t>("PointData/clamped").at(3) == 1);
  CHECK(vtu.types.at("PointData/clamped") == "UInt8");
  CHECK(vtu.values<float>("CellData/energy") == Floats{0.5F, 1.5F});
  CHECK(vtu.values<std::int64_t>("CellData/element") == std::vector<std::int64_t>{7, 8});
}

TEST_CASE("a .vtu of quadrilaterals is flat", "[unit][output]") {
  const TemporaryFolder folder;
  const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {1, 2, 0}, {1, 2, 0});
  SolidFrame frame = frame_of(mesh, 0);
  frame.node_data = {{"force", "N", 2, std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}}};
  write_text(folder / "plate.vtu", vtu_text(mesh, frame));
  const VtkFile vtu(folder / "plate.vtu");
  CHECK(vtu.counts == std::map<std::string, int>{{"Points", 6}, {"Cells", 2}});
  CHECK(vtu.values<float>("Points/Points") == moved(mesh, frame));
  CHECK(vtu.values<std::int32_t>("Cells/connectivity") == Ints{0, 1, 3, 2, 2, 3, 5, 4});
  CHECK(vtu.values<std::int32_t>("Cells/offsets") == Ints{4, 8});
  CHECK(vtu.values<std::uint8_t>("Cells/types") == Bytes{9, 9});
  CHECK(vtu.values<float>("PointData/force") == Floats{0, 1, 0, 2, 3, 0, 4, 5, 0, 6, 7, 0, 8, 9, 0, 10, 11, 0});
}

TEST_CASE("what a frame of a solid does not have is not in the file", "[unit][output]") {
  const TemporaryFolder folder;
  const SolidMesh mesh = box_mesh(3, {1, 2, 3}, {2, 3, 4}, {1, 1, 1});
  write_text(folder / "bare.vtu", vtu_text(mesh, {}));
  const VtkFile bare(folder / "bare.vtu");
  CHECK(bare.arrays.size() == 5);
  const Floats points = bare.values<float>("Points/Points");
  REQUIRE(points.size() == 24);
  CHECK(Floats(points.begin(), points.begin() + 3) == Floats{1, 2, 3});
  write_text(folder / "none.vtu", vtu_text({}, {}));
  const VtkFile none(folder / "none.vtu");
  CHECK(none.counts == std::map<std::string, int>{{"Points", 0}, {"Cells", 0}});
  CHECK(none.values<float>("Points/Points").empty());
}

TEST_CASE("frames of a solid have times", "[unit][output]") {
  const TemporaryFolder folder;
  const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {1, 1, 0}, {1, 1, 0});
  Paraview paraview(folder.path(), "gate");
  paraview.write(mesh, frame_of(mesh, 0));
  paraview.write(mesh, frame_of(mesh, 0.125));
  CHECK(VtkFile(folder / "gate/gate_000001.vtu").values<double>("FieldData/TimeValue") == std::vector<double>{0.125});
  const std::string pvd = text_in(folder / "gate.pvd");
  CHECK(contains(pvd, "timestep=\"0\" part=\"0\" file=\"gate/gate_000000.vtu\""));
  CHECK(contains(pvd, "timestep=\"0.125\" part=\"0\" file=\"gate/gate_000001.vtu\""));
}
