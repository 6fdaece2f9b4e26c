// Structures from case files: what is understood, what is refused, and runs against published figures.

#include <cmath>
#include <limits>

#include "app/structure_simulation.hpp"
#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/modes.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"
#include "tests/structure_text.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

Scene plate_scene(const std::string& name) {
  CaseFile file(std::string(GREENWATER_SOURCE_DIR) + "/cases/plate/" + name + ".toml", {});
  return read_scene(file);
}

/// A short plate of 1 x 10 x 1 elements, and whatever follows.
std::string small_plate(const std::string& fem = "", const std::string& more = "") {
  return R"(format = 1
[case]
name = "small"
[time]
end = 0.001
step = 0.0001
[[structure]]
name = "plate"
base = [0.6, 0.0]
height = 0.1
width = 0.2
thickness = 0.003
young = 3.43e9
density = 1200.0
poisson = 0.37
)" + more +
         R"(
[structure.fem]
divisions = [1, 10, 1]
)" + fem +
         R"(
[output]
every_time = 0.0005
)";
}

std::string replaced(std::string text, const std::string& before, const std::string& after) {
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  return text.replace(at, before.size(), after);
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

int count_of(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Marched to its end.
StructureSimulation finished(const std::string& name) {
  const Scene scene = plate_scene(name);
  StructureSimulation simulation(scene);
  while (simulation.time() < scene.end * (1 - 1e-9)) simulation.step();
  return simulation;
}

std::pair<Point, Point> bounds_of(const MeshPart& part, const SolidMesh& mesh) {
  Point low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const int node : part.nodes) {
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], mesh.nodes[node][d]);
      high[d] = std::max(high[d], mesh.nodes[node][d]);
    }
  }
  return {low, high};
}

}  // namespace

TEST_CASE("a stress probe on the face of a plate reads the bending stress there", "[unit][structure]") {
  // Bent to a curvature of 0.0002 1/m, with no strain across the width: E / (1 - nu^2) times 0.0001 h at the faces.
  const std::string bent =
      "base_side = \"upstream\"\ndisplacement = [\"0.0001 * y^2\", \"-0.0002 * (x - 0.6015) * y\"]\n";
  std::string text = small_plate("", bent);
  for (const std::string side : {"middle", "left", "right"})
    text += "[[probe]]\nname = \"" + side + "\"\nkind = \"structure_stress\"\ncomponent = \"yy\"\n" +
            "height_fraction = 0.55\n" + (side == "middle" ? "" : "side = \"" + side + "\"\n");
  StructureSimulation simulation(scene_of_text(text));
  const double face = 3.43e9 / (1 - 0.37 * 0.37) * 0.0001 * 0.003;
  CHECK(simulation.sample(0) == Approx(0).margin(0.01 * face));
  CHECK(simulation.sample(1) == Approx(face).epsilon(0.01));
  CHECK(simulation.sample(2) == Approx(-face).epsilon(0.01));
  CHECK(contains(complaint_about(replaced(text, "side = \"left\"", "side = \"lef\"")), "left"));
}

TEST_CASE("the paper's plate: mesh, substeps, and its frequencies in the plan", "[unit][structure]") {
  const Scene scene = plate_scene("poli30");
  CHECK_FALSE(scene.has_fluid);
  StructureSimulation simulation(scene);
  const Structure& plate = simulation.structure(0);
  CHECK(plate.solid().mesh().nodes.size() == 404);
  CHECK(plate.solid().mesh().elements.size() == 100);
  CHECK(plate.substeps() == 460);
  CHECK(plate.solid().mass().sum() / 3 == Approx(1200 * 0.003 * 0.1 * 0.2));
  const std::string plan = joined(simulation.plan());
  CHECK(count_of(plan, " Hz dry") == 3);
  CHECK(contains(plan, "460 substeps"));
  // alpha / (2 omega): 426 / (4 pi 86.29)
  CHECK(contains(plan, "f1 = 86.291 Hz dry, 100 % along x, damped with 0.393 of critical"));
}

TEST_CASE("a plate stands where the case puts it, in 2-D and 3-D scenes", "[unit][structure]") {
  for (const bool in_space : {false, true}) {
    std::string text = small_plate("", "angle = 0.1\n");
    if (in_space) {
      text = replaced(text, "name = \"small\"", "name = \"small\"\ndimension = 3");
      text = replaced(text, "base = [0.6, 0.0]", "base = [0.6, 0.0, 0.0]");
    }
    const Scene scene = scene_of_text(text);
    const SolidMesh& mesh = scene.structures.at(0).mesh;
    const std::size_t up = in_space ? 2 : 1, across = in_space ? 1 : 2;
    const auto [foot_low, foot_high] = bounds_of(*find_part(mesh, "bottom"), mesh);
    const auto [top_low, top_high] = bounds_of(*find_part(mesh, "top"), mesh);
    CHECK(foot_low[across] == Approx(-0.1));
    CHECK(foot_high[across] == Approx(0.1));
    CHECK((foot_low[0] + foot_high[0]) / 2 == Approx(0.6));
    CHECK((top_low[0] + top_high[0]) / 2 == Approx(0.6 + 0.1 * std::sin(0.1)));
    CHECK((top_low[up] + top_high[up]) / 2 == Approx(0.1 * std::cos(0.1)));
    CHECK(find_part(mesh, "left")->facets.size() == 10);
    const auto [left_low, left_high] = bounds_of(*find_part(mesh, "left"), mesh);
    CHECK(left_low[0] < foot_high[0] - 0.0029);
    const StructureSimulation simulation(scene);  // no element is inside out
    CHECK(simulation.structure(0).solid().mass().sum() / 3 == Approx(0.072));
    CHECK(simulation.structure(0).solid().strain_energy(simulation.structure(0).march().displacement()) == 0);
  }
}

TEST_CASE("elastica, from its case file", "[unit][structure]") {
  StructureSimulation simulation = finished("elastica");
  CHECK(simulation.sample(0) == Approx(-0.38763).epsilon(0.01));  // Mattiasson 1981
  CHECK(simulation.sample(1) == Approx(-0.71379).epsilon(0.01));
  CHECK(simulation.structure(0).march().energies().kinetic < 1e-6);  // it rests
}

TEST_CASE("CSM1, from its case file", "[unit][structure]") {
  StructureSimulation simulation = finished("csm1");
  CHECK(simulation.sample(0) == Approx(-7.187e-3).epsilon(0.01));  // Turek and Hron 2006
  CHECK(simulation.sample(1) == Approx(-66.10e-3).epsilon(0.01));
}

TEST_CASE("a clamped plate under water, from its case file", "[unit][structure]") {
  StructureSimulation simulation = finished("clamped");
  const double young = 67.5e9, nu = 0.34, h = 0.05, p = (1000 * 2 + 2700 * h) * 9.8;
  const double thin = p * 12 * (1 - nu * nu) / (384 * young * h * h * h);
  CHECK(thin == Approx(6.853e-5).epsilon(1e-3));  // as published
  // p L^2 / (8 G h) of shear beside it, even over the height as the element has it.
  CHECK(simulation.sample(0) == Approx(-thin - p * 2 * (1 + nu) / (8 * young * h)).epsilon(0.005));
}

TEST_CASE("a plate let go swings to rest and loses what it had to damping", "[unit][structure]") {
  StructureSimulation simulation(plate_scene("poli30"));
  const Energies before = simulation.structure(0).march().energies();
  CHECK(simulation.sample(0) == Approx(0.0005));
  for (int k = 0; k < 60; ++k) simulation.step();
  const Energies after = simulation.structure(0).march().energies();
  CHECK(after.balance() == Approx(before.balance()).epsilon(1e-4));
  CHECK(after.lost > 0.7 * before.balance());
}

TEST_CASE("supports that move, loads in time, and what the foot feels", "[unit][structure]") {
  const std::string shaken = small_plate("", R"toml(clamp = []
weight = false
[[structure.support]]
part = "bottom"
axes = ["y", "z"]
[[structure.support]]
part = "bottom"
axes = ["x"]
displacement = "1e-4 * sin(2000 * t)"
)toml");
  StructureSimulation moving(scene_of_text(shaken));
  for (int k = 0; k < 5; ++k) moving.step();
  const auto& u = moving.structure(0).march().displacement();
  for (const int node : find_part(moving.structure(0).solid().mesh(), "bottom")->nodes)
    CHECK(u[3 * node] == Approx(1e-4 * std::sin(2000 * moving.time())).epsilon(1e-9));

  const std::string pushed = small_plate("damping_ratio = 0.7\n", R"(weight = false
[[structure.load]]
part = "top"
kind = "force"
force = [2.0, 0.0]
factor = "t < 0.0005 ? 0 : 1"
)") + "[[probe]]\nname = \"shear\"\nkind = \"structure_reaction\"\npart = \"bottom\"\n";
  StructureSimulation force(scene_of_text(replaced(pushed, "end = 0.001", "end = 0.1")));
  for (int k = 0; k < 5; ++k) force.step();
  CHECK(force.sample(0) == 0);
  for (int k = 0; k < 800; ++k) force.step();
  CHECK(force.sample(0) == Approx(-2.0).epsilon(1e-3));
}

TEST_CASE("structures that cannot be are refused, with place and cure", "[unit][structure][bad]") {
  const std::string good = small_plate();
  CHECK(complaint_about(good).empty());
  const auto check = [&](const std::string& text, const std::vector<std::string>& words) {
    const std::string complaint = complaint_about(text);
    INFO(complaint);
    CHECK(contains(complaint, "case.toml:"));
    for (const std::string& word : words) CHECK(contains(complaint, word));
  };
  check(small_plate("time_step = 1e-5\n"), {"is not below the critical step", "2/omega_max", "take less"});
  check(replaced(good, "1200.0", "-1200.0"), {"density"});
  check(replaced(good, "0.37", "0.5"), {"poisson = 0.5", "0.499", "mean_dilatation"});
  check(replaced(good, "thickness = 0.003\n", ""), {"needs a thickness"});
  check(small_plate("", "clamp = \"botom\"\n"), {"botom", "bottom"});
  check(small_plate("expected_nodes = 43\n"), {"has 44, not expected_nodes = 43"});
  check(small_plate("damping_ratio = 0.1\ndamping_alpha = 3.0\n"), {"keep one"});
  check(replaced(good, "[1, 10, 1]", "[1, 10, 1, 1]"), {"has 4 numbers"});
  check(small_plate("", "law = \"neo_hookean\"\n"), {"total_lagrangian"});
  check(good + "[mps]\nspacing = 0.01\n", {"[mps]", "no [[fluid]]"});
  check(replaced(good, "step = 0.0001", "step = 0.1"), {"time.step", "longer than the run"});
  check(good + "[[probe]]\nname = \"p\"\nkind = \"wall_force\"\n", {"wall_force", "structure_displacement"});
  check(small_plate("", "[[structure.support]]\nmin = [5.0, 5.0]\nmax = [6.0, 6.0]\n"), {"no node"});
  check(small_plate("", "[[structure.load]]\npart = \"left\"\nkind = \"pressure\"\npressure = \"y\"\nfollows = true\n"),
        {"one number"});
}

TEST_CASE("materials and sizes beyond what numbers hold are refused, with place and cure", "[unit][structure][bad]") {
  const std::string good = small_plate();
  const auto check = [&](const std::string& text, const std::string& word) {
    const std::string complaint = complaint_about(text);
    INFO(complaint);
    CHECK(contains(complaint, "case.toml:"));
    CHECK(contains(complaint, word));
    CHECK(contains(complaint, "a real material"));
  };
  for (const char* young : {"1e308", "1e200", "1.7e308"})
    for (const char* kinematics : {"small", "corotational", "total_lagrangian"})
      check(replaced(small_plate(text_of("kinematics = \"", kinematics, "\"\n")), "3.43e9", young), "over its mass");
  check(replaced(good, "1200.0", "1e-308"), "young = 3.43e+09 Pa, density = 1e-308");
  check(replaced(good, "1200.0", "1e-320"), "density = ");
}

TEST_CASE("what is not a finite number comes to no eigenvalue solver", "[unit][structure]") {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {0.01, 0.1, 0.1}, {1, 4, 4});
  Supports supports;
  clamp(supports, 3, find_part(mesh, "bottom")->nodes);
  for (const double young : {1e308, 1e250, std::numeric_limits<double>::infinity()}) {
    INFO(young);
    const Solid solid(mesh, {young, 0.3, 1000});
    CHECK_THROWS_AS(critical_step(solid, supports), NumericsError);
    if (young > 1e300) CHECK_THROWS_AS(lowest_modes(solid, supports, 3), NumericsError);
  }
  const Solid soft(mesh, {1e6, 0.3, 1000});
  Eigen::VectorXd torn = Eigen::VectorXd::Zero(soft.unknowns());
  torn[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(highest_frequency(soft, supports, torn), NumericsError);
  CHECK_THROWS_AS(lowest_modes(soft, supports, 3, torn), NumericsError);
  CHECK_THROWS_AS(Solid(mesh, {1e6, 0.3, 1e-322}), CaseError);
  CHECK_THROWS_AS(Solid(mesh, {1e6, 0.3, std::numeric_limits<double>::infinity()}), CaseError);
}

TEST_CASE("a structure that nothing holds may run, but is told of", "[unit][structure][bad]") {
  StructureSimulation simulation(scene_of_text(small_plate("", "clamp = []\n")));
  CHECK(contains(joined(simulation.plan()), "held nowhere and loaded"));
  for (int k = 0; k < 10; ++k) simulation.step();
  const auto& u = simulation.structure(0).march().displacement();
  CHECK(u[1] == Approx(-9.81 * 0.001 * 0.001 / 2).epsilon(0.01));
}

TEST_CASE("a structure from Gmsh, and its run folder", "[unit][structure][program]") {
  const TemporaryFolder folder;
  write_text(folder / "bar.msh", R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "foot"
3 2 "bar"
$EndPhysicalNames
$Entities
0 0 1 1
1 0 0 0 0 1 1 1 1 0
1 0 0 0 1 1 1 1 2 1 1
$EndEntities
$Nodes
1 12 1 12
3 1 0 12
1
2
3
4
5
6
7
8
9
10
11
12
0 0 0
0 100 0
0 100 100
0 0 100
100 0 0
100 100 0
100 100 100
100 0 100
200 0 0
200 100 0
200 100 100
200 0 100
$EndNodes
$Elements
2 3 1 3
2 1 3 1
1 1 2 3 4
3 1 5 2
2 1 2 3 4 5 6 7 8
3 5 6 7 8 9 10 11 12
$EndElements
)");
  const std::string text = R"(format = 1
[case]
name = "bar"
dimension = 3
[time]
end = 0.002
step = 0.001
[[structure]]
name = "bar"
shape = "mesh"
file = "bar.msh"
unit = "mm"
young = 1e6
density = 1000.0
poisson = 0.3
clamp = "foot"
[output]
every_time = 0.001
[[probe]]
name = "tip"
kind = "structure_displacement"
point = [0.2, 0.05, 0.05]
component = "z"
)";
  write_text(folder / "case.toml", text);
  if (!program_is_there()) return;
  const Answer checked = run_program({"check", "case.toml"}, folder);
  INFO(checked.out << checked.err);
  CHECK(checked.code == 0);
  CHECK(contains(checked.out, "12 nodes, 2 hexahedra"));
  CHECK(contains(checked.out, "mass 2 kg"));
  CHECK(count_of(checked.out, " Hz") == 3);
  const Answer ran = run_program({"run", "case.toml", "-o", "out"}, folder);
  CHECK(ran.code == 0);
  for (const char* file : {"DONE", "history.csv", "results.h5", "paraview/bar.pvd", "paraview/bar/bar_000002.vtu"})
    CHECK(std::filesystem::exists(folder / "out" / file));
  CHECK(contains(text_in(folder / "out" / "probes" / "tip.csv"), "displacement_z[m]"));
  CHECK(contains(text_in(folder / "out" / "history.csv"), "balance_bar[J]"));

  write_text(folder / "bar.msh", text_in(folder / "bar.msh").substr(0, 300));
  const Answer cut = run_program({"check", "case.toml"}, folder);
  CHECK(cut.code == 2);
  CHECK(contains(cut.err, "bar.msh:"));
}
