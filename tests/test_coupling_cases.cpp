// Coupled scenes as users run them: nothing gets through a plate that moves, and a stiff plate is a wall.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numeric>

#include "kernels/sample.hpp"
#include "tests/catch.hpp"
#include "tests/elastic.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// Height of the walls of the structure at x, of those whose normal is nearly upright; the highest.
double plate_at(const FluidSimulation& simulation, double x) {
  const WallFaces& walls = simulation.fluid().faces;
  double height = -1e300;
  for (const WallFace& face : walls.faces) {
    if (!walls.bodies[face.body].bends) continue;
    const auto &a = face.corner[0].position, &b = face.corner[1].position;
    if (std::min(a[0], b[0]) > x || std::max(a[0], b[0]) < x || a[0] == b[0]) continue;
    height = std::max(height, a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]));
  }
  return height;
}

/// Water 0.08 m deep to the left of a plate that is higher than that.
std::string dammed(const std::string& plate) {
  return "format = 1\n[case]\nname = \"dammed\"\n[time]\nend = 1\n"
         "[geometry.tank]\ntype = \"box\"\nmin = [0, 0]\nmax = [0.4, 0.2]\nopen = [\"top\"]\n"
         "[[fluid]]\nname = \"w\"\nregion = { type = \"box\", min = [0, 0], max = [0.2, 0.08] }\n"
         "[mps]\nspacing = 0.004\ntime_step = 4e-4\n" +
         plate;
}

double mean_of_second_half(const std::vector<double>& values) {
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  return std::accumulate(half, values.end(), 0.0) / static_cast<double>(values.end() - half);
}

std::vector<double> sampled(const Scene& scene, double end) {
  FluidSimulation simulation(scene);
  std::vector<double> values;
  while (simulation.time() < end * (1 - 1e-9)) {
    simulation.step();
    values.push_back(simulation.sample(0));
  }
  return values;
}

const std::string plate_size = "base = [0.2, 0]\nbase_side = \"upstream\"\nheight = 0.1\nthickness = 0.003\n";

std::string elastic_dam(double stiffer) {
  return dammed("[[structure]]\nname = \"plate\"\nwidth = 0.2\n" + plate_size +
                text_of("young = ", 3.43e9 * stiffer, "\n") +
                "density = 1200\npoisson = 0.37\n[structure.fem]\ndivisions = [1, 25, 1]\n"
                "[[probe]]\nname = \"force\"\nkind = \"structure_force\"\n");
}

}  // namespace

TEST_CASE("nothing gets through a plate whose middle moves with more than 20 m/s", "[stability][coupling]") {
  for (const char* way : {"default", "aitken"})
    for (const double up : {90.0, -90.0}) {
      INFO(way << ", " << up << " m/s");
      const std::string text = text_of(column_on_plate(1), "[coupling]\nscheme = \"", way, "\"\n");
      FluidSimulation simulation(
          scene_of_text(text, {set_option(text_of("structure.0.velocity=[\"0\", \"", up, "*sin(pi*x)\"]"))}));
      double fastest = 0, before = 0;
      const double dt = simulation.dt();
      std::int64_t through = 0;
      for (int k = 0; k < 150; ++k) {
        simulation.step();
        const double middle = plate_at(simulation, 0.5);
        if (k > 0) fastest = std::max(fastest, std::fabs(middle - before) / dt);
        before = middle;
        for (const Point& x : places_of(simulation))
          through += x[0] < 0 || x[0] > 1 || x[1] < plate_at(simulation, std::clamp(x[0], 0.0, 1.0)) ? 1 : 0;
      }
      CHECK(through == 0);
      CHECK(simulation.facts().lost == 0);
      CHECK(fastest > 20);  // the water takes most of it at once
    }
}

TEST_CASE("a plate a hundred times as stiff feels what a rigid one does", "[validation][coupling]") {
  const double rigid = mean_of_second_half(
      sampled(scene_of_text(dammed("[geometry.plate]\ntype = \"plate\"\n" + plate_size +
                                   "[[probe]]\nname = \"force\"\nkind = \"wall_force\"\nwall = \"plate\"\n"
                                   "reading = \"reaction\"\n")),
              0.05));
  const double stiff = mean_of_second_half(sampled(scene_of_text(elastic_dam(100)), 0.05));
  std::cout << "load of dammed water: rigid " << rigid << ", elastic with 100 E " << stiff << ", rho g h^2 / 2 "
            << 1000 * 9.81 * 0.08 * 0.08 / 2 << " N/m\n";
  CHECK(rigid == Approx(1000 * 9.81 * 0.08 * 0.08 / 2).epsilon(0.03));
  CHECK(stiff == Approx(rigid).epsilon(0.01));
}

TEST_CASE("the paper's scene at 4 mm: peaks come when the paper says, and nothing is lost on the way",
          "[validation][coupling]") {
  const Scene scene = scene_of("dam_break_elastic/quick.toml");
  FluidSimulation simulation(scene);
  const auto probe = [&](const std::string& name) {
    for (std::size_t k = 0; k < scene.probes.size(); ++k)
      if (scene.probes[k].name == name) return k;
    return std::size_t{0};
  };
  const std::size_t tip = probe("displacement_n5");
  double most = 0, when = 0;
  while (simulation.time() < 0.35) {
    simulation.step();
    if (const double u = simulation.sample(tip); std::fabs(u) > std::fabs(most)) {
      most = u;
      when = simulation.time();
    }
  }
  const auto sums = simulation.coupler().ledger(0).sums();
  std::cout << "quick.toml: largest displacement at n5 " << 1e3 * most << " mm at " << when << " s; the fluid's work "
            << sums.by_fluid << " J, mismatch " << sums.mismatch() << " J\n";
  CHECK(when == Approx(0.282).epsilon(0.05));
  CHECK(most > 0);
  CHECK(simulation.facts().lost == 0);
  CHECK(std::fabs(sums.mismatch()) < 1e-2 * std::fabs(sums.by_fluid));
  CHECK(std::fabs(simulation.run_facts().history.back()) < 1e300);
}

TEST_CASE("a gate that stands on the floor opens as one whose end is dry", "[stability][coupling]") {
  const auto gate = [](const std::string& more) {
    return text_of(R"(
format = 1
[case]
name = "gate"
[time]
end = 0.05
[geometry.tank]
type = "polyline"
points = [[0, 0.3], [0, 0], [0.6, 0], [0.6, 0.3]]
[geometry.above]
type = "plate"
base = [0.1, 0.08]
base_side = "upstream"
height = 0.2
thickness = 0.005
[[fluid]]
name = "water"
region = { type = "box", min = [0, 0], max = [0.1, 0.15] }
[mps]
spacing = 0.005
time_step = 2e-4
[[structure]]
name = "gate"
shape = "box"
min = [0.1, 0]
max = [0.105, 0.08]
young = 1.2e7
density = 1100
poisson = 0.4
clamp = ["top"]
)",
                   more, R"(
[structure.fem]
divisions = [2, 20]
[[probe]]
name = "x"
kind = "structure_displacement"
point = [0.1, 0]
component = "x"
[[probe]]
name = "y"
kind = "structure_displacement"
point = [0.1, 0]
component = "y"
)");
  };
  // The lower end slides over the floor, turns, and lifts off.
  FluidSimulation wet(scene_of_text(gate(""))), dry(scene_of_text(gate("wet = [\"left\", \"right\"]")));
  double apart = 0, fastest = 0;
  while (wet.time() < 0.05 * (1 - 1e-9)) {
    wet.step();
    dry.step();
    apart = std::max(apart, std::fabs(wet.sample(0) - dry.sample(0)));
    fastest = std::max<double>(fastest, fluid_sums(wet.fluid(), {}).max_speed);
  }
  std::cout << "gate on a floor: tip at (" << wet.sample(0) << ", " << wet.sample(1) << ") m, with its end dry ("
            << dry.sample(0) << ", " << dry.sample(1) << ") m, apart by " << apart << " m; fastest particle " << fastest
            << " m/s\n";
  CHECK(wet.sample(0) > 0.015);
  CHECK(wet.sample(1) > 0.002);
  CHECK(apart < 0.01 * wet.sample(0));
  CHECK(fastest < std::sqrt(2 * 9.81 * 0.15));
  CHECK(wet.facts().lost == 0);
}

TEST_CASE("oil whose last row is a spacing off the side of a tank that begins to roll stays calm",
          "[stability][moving]") {
  FluidSimulation simulation(scene_of("validation/rolling_beam/case.toml"));
  double fastest = 0;
  while (simulation.time() < 0.06) {
    simulation.step();
    fastest = std::max<double>(fastest, fluid_sums(simulation.fluid(), {}).max_speed);
  }
  CHECK(fastest < 0.6);  // 0.41; it falls by half a spacing on to the beam and the side
}

TEST_CASE("a staggered march that diverges ends with its name and the cure", "[stability][coupling]") {
  FluidSimulation simulation(scene_of("dam_break_elastic/quick.toml", {"coupling.scheme=staggered"}));
  std::string told;
  try {
    while (simulation.time() < 0.3) simulation.step();
  } catch (const NumericsError& error) {
    told = error.what();
  }
  CHECK_THAT(told, Catch::Contains("\"plate\"") && Catch::Contains("\"aitken\""));
}

TEST_CASE("Poli-150 as an elastic plate is Poli-150 as a wall", "[validation][coupling][full]") {
  const std::vector<std::string> fine{"mps.spacing=0.002", "mps.time_step=0.0002", "structure.0.thickness=0.015"};
  const Scene elastic = scene_of("dam_break_elastic/quick.toml", fine);
  Scene rigid = elastic;
  PlateCase plate = *elastic.structures.front().plate;
  rigid.structures.clear();
  rigid.plates.push_back(plate);
  rigid.probes.clear();
  ProbeCase force;
  force.name = "force";
  force.kind = "wall_force";
  force.wall = plate.name;
  force.reading = "reaction";
  rigid.probes.push_back(force);
  ProbeCase front;
  front.name = "front";
  front.kind = "wave_front";
  rigid.probes.push_back(front);

  const auto run = [](const Scene& scene, const std::string& force_name) {
    FluidSimulation simulation(scene);
    double impulse = 0, front_at = 0;
    while (simulation.time() < 0.32 * (1 - 1e-9)) {
      simulation.step();
      for (std::size_t k = 0; k < scene.probes.size(); ++k) {
        if (scene.probes[k].name == force_name && simulation.time() > 0.22)
          impulse += simulation.sample(k) * simulation.dt();
        if (scene.probes[k].name == "front" && simulation.time() < 0.22) front_at = simulation.sample(k);
      }
    }
    return std::pair{impulse, front_at};
  };
  const auto [bending, front_1] = run(elastic, "plate_force");
  const auto [standing, front_2] = run(rigid, "force");
  std::cout << "Poli-150, 0.22 to 0.32 s: impulse elastic " << bending << ", rigid " << standing << " N s/m; front "
            << front_1 << " and " << front_2 << " m\n";
  CHECK(bending == Approx(standing).epsilon(0.01));
  CHECK(front_1 == Approx(front_2).epsilon(0.01));
}
