// Structures and geometries in one case: supports that move with a geometry, contact, accelerations.

#include <cmath>

#include "app/motion.hpp"
#include "app/structure_simulation.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"
#include "tests/structure_text.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// A short plate in 2-D, of quadrilaterals, and whatever follows.
std::string plate_and(const std::string& more, const std::string& of_plate = "") {
  return R"(format = 1
[case]
name = "small"
[time]
end = 0.01
step = 0.0001
[[structure]]
name = "plate"
base = [0.6, 0.0]
height = 0.1
thickness = 0.01
young = 1e7
density = 1200.0
poisson = 0.37
)" + of_plate +
         R"(
[structure.fem]
divisions = [1, 5]
)" + more;
}

const std::string tank = "[geometry.tank]\ntype = \"box\"\nmin = [0.0, 0.0]\nmax = [1.0, 0.5]\n";
const std::string rolls = "[geometry.tank.motion]\nrotation = \"20*t + 1000*t^2\"\nabout = [0.5, 0.1]\n";
const std::string on_tank = "weight = false\n[[structure.support]]\npart = \"bottom\"\nwith = \"tank\"\n";

/// A block of quadrilaterals or hexahedra, 1 mm above the floor of the tank.
std::string block(const std::string& divisions, const std::string& of_block, const std::string& more) {
  return R"(format = 1
[case]
name = "block"
[time]
end = 0.04
step = 0.0001
[[structure]]
name = "block"
shape = "box"
min = [0.1, 0.001]
max = [0.15, 0.051]
young = 1e6
density = 1200.0
poisson = 0.3
)" + of_block +
         "[structure.fem]\ndivisions = " + divisions + '\n' + more;
}

void march_to_end(StructureSimulation& simulation, double end) {
  while (simulation.time() < end * (1 - 1e-9)) simulation.step();
}

}  // namespace

TEST_CASE("the foot of a plate goes where the tank goes that it stands in", "[unit][structure]") {
  for (const std::string& push : {std::string(), std::string("velocity = [\"1 + 100*t\", \"-2\"]\n"),
                                  std::string("displacement = [0, \"3*t\"]\n")}) {
    const Scene scene = scene_of_text(plate_and(tank + rolls + push, on_tank));
    StructureSimulation simulation(scene);
    const Motion motion(*scene.boxes.at(0).motion);
    march_to_end(simulation, 0.005);
    const March& march = simulation.structure(0).march();
    for (const int node : find_part(scene.structures[0].mesh, "bottom")->nodes) {
      const Point &x = scene.structures[0].mesh.nodes[node], there = motion.at(x, march.time());
      for (int d = 0; d < 2; ++d) CHECK(x[d] + march.displacement()[2 * node + d] == Approx(there[d]).epsilon(1e-12));
    }
  }
  StructureSimulation standing(scene_of_text(plate_and(tank, on_tank)));
  march_to_end(standing, 0.01);
  CHECK(standing.structure(0).march().displacement().isZero(0));
}

TEST_CASE("turning with the tank or accelerations in its frame: the same to the plate", "[unit][structure]") {
  // About its foot, where the tank turns, by a small angle: Euler's acceleration; the centrifugal one is 1e-4 of it.
  const std::string about = "about = [0.6, 0.0]\n", angle = "0.02*(1 - cos(400*t))";
  StructureSimulation turned(
      scene_of_text(plate_and(tank + "[geometry.tank.motion]\n" + about + "rotation = \"" + angle + "\"\n", on_tank)));
  const std::string euler = "0.02*400^2*cos(400*t)";
  StructureSimulation accelerated(
      scene_of_text(plate_and("", "weight = false\n[[structure.load]]\nkind = \"acceleration\"\nacceleration = [\"" +
                                      euler + "*y\", \"-" + euler + "*(x - 0.6)\"]\n")));
  march_to_end(turned, 0.01);
  march_to_end(accelerated, 0.01);
  const SolidMesh& mesh = turned.structure(0).solid().mesh();
  const double alpha = 0.02 * (1 - std::cos(400 * 0.01)), c = std::cos(alpha), s = std::sin(alpha);
  const auto &u = turned.structure(0).march().displacement(), &seen = accelerated.structure(0).march().displacement();
  double most = 0;
  for (const int node : find_part(mesh, "top")->nodes) {
    const double rx = mesh.nodes[node][0] - 0.6, ry = mesh.nodes[node][1];
    const double x = rx + u[2 * node], y = ry + u[2 * node + 1];  // turned back into the frame of the tank
    most = std::max(most, std::abs(seen[2 * node]));
    CHECK(c * x + s * y - rx == Approx(seen[2 * node]).epsilon(0.01));
  }
  CHECK(most > 1e-4);
}

TEST_CASE("a block falls on the floor of a tank that stands or rises", "[unit][structure]") {
  const std::string touches = "[structure.contact]\nwalls = \"tank\"\n", thrown = "velocity = [0, -0.5]\n";
  const std::string probe = "[[probe]]\nname = \"springs\"\nkind = \"structure_energy\"\ncomponent = \"contact\"\n";
  for (const bool wide : {false, true}) {
    for (const bool rises : {false, true}) {
      const std::string motion = rises ? "[geometry.tank.motion]\nvelocity = [0, 0.5]\n" : "";
      const std::string of_block = thrown + (wide ? "width = 0.02\n" : "") + touches;
      const Scene scene = scene_of_text(block(wide ? "[4, 4, 1]" : "[4, 4]", of_block, tank + motion + probe));
      StructureSimulation simulation(scene);
      const March& march = simulation.structure(0).march();
      const double first = march.energies().balance();
      double most = 0, lowest = 1;
      while (simulation.time() < scene.end * (1 - 1e-9)) {
        simulation.step();
        most = std::max(most, simulation.sample(0));
        const double floor = rises ? 0.5 * simulation.time() : 0;
        for (const int node : find_part(scene.structures[0].mesh, "bottom")->nodes)
          lowest =
              std::min(lowest, 0.001 + march.displacement()[simulation.structure(0).solid().dim() * node + 1] - floor);
      }
      CHECK(most > 0.1 * first);  // its fall goes into springs, and into the block
      CHECK(simulation.sample(0) == Approx(0).margin(1e-3 * most));
      CHECK(lowest < 0);
      CHECK(lowest > -0.1 * 0.05);
      CHECK(march.energies().balance() == Approx(first).epsilon(rises ? 0.02 : 0.005));
      CHECK((march.energies().supports > 0) == rises);
    }
  }
}

TEST_CASE("without contact in the case there is none in the march", "[unit][structure]") {
  StructureSimulation simulation(scene_of_text(block("[4, 4]", "velocity = [0, -1]\nweight = false\n", "")));
  march_to_end(simulation, 0.04);
  const March& march = simulation.structure(0).march();
  CHECK(march.state().contact.near.capacity() == 0);
  CHECK(march.displacement()[1] == Approx(-0.04));
}

TEST_CASE("geometries beside structures that cannot be are refused", "[unit][structure][bad]") {
  CHECK(complaint_about(plate_and(tank + rolls, on_tank)).empty());
  const auto check = [&](const std::string& text, const std::vector<std::string>& words) {
    const std::string complaint = complaint_about(text);
    INFO(complaint);
    CHECK(contains(complaint, "case.toml:"));
    for (const std::string& word : words) CHECK(contains(complaint, word));
  };
  check(plate_and(tank), {"[geometry.tank] is about fluid, and there is no [[fluid]]", "structure.support"});
  const std::string touches = "[structure.contact]\nwalls = [\"tank\"]\n";
  CHECK(complaint_about(plate_and(tank, touches)).empty());
  check(plate_and("", touches), {"no geometry to touch", "[geometry.NAME]"});
  check(plate_and(tank, "[structure.contact]\nwalls = [\"tonk\"]\n"), {"tonk", "tank"});
  check(plate_and(tank, "[structure.contact]\n"), {"walls"});
  check(plate_and(tank, touches + "stiffness = 0\n"), {"stiffness"});
  check(plate_and("", on_tank), {"no geometry to move with", "[geometry.NAME]"});
  check(plate_and("[geometry.tonk]\ntype = \"box\"\nmin = [0.0, 0.0]\nmax = [1.0, 0.5]\n", on_tank), {"tank", "tonk"});
  check(plate_and(tank, on_tank + "axes = [\"x\"]\n"), {"along all axes", "delete axes"});
  check(plate_and(tank, on_tank + "displacement = 0.1\n"), {"along all axes", "delete displacement"});
  check(plate_and(tank + "[geometry.tank.motion]\n", on_tank), {"does not say how it moves"});
  check(plate_and(tank + "[geometry.tank.motion]\ndisplacement = [0, \"t > 0.005 ? 1/0 : 0\"]\n", on_tank),
        {"is no finite number after t"});
  check(plate_and("", "[[structure.load]]\nkind = \"acceleration\"\nacceleration = [\"u\", 0]\n"),
        {"variables are x, y"});
  check(plate_and("", "[[structure.load]]\nkind = \"acceleration\"\npart = \"top\"\nacceleration = [1, 0]\n"),
        {"part"});
}
