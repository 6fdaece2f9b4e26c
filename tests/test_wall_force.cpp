// The force on rigid walls that the fluid's divergence gives (reading "reaction") is that of the pressure at them.

#include <cmath>
#include <iostream>
#include <map>
#include <string>

#include "tests/case_text.hpp"
#include "tests/catch.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double gravity = 9.81, rho = 1000;

/// A tank with a floor of 0.4 m, an upright side and a slope at 45 degrees, with water 0.2 m deep.
std::string sloping_tank(const std::string& scheme) {
  std::string text = text_of(R"(
format = 1
[case]
name = "slope"
[time]
end = 1
[geometry.side]
type = "polyline"
points = [[0, 0.3], [0, 0]]
[geometry.floor]
type = "polyline"
points = [[0, 0], [0.4, 0]]
[geometry.slope]
type = "polyline"
points = [[0.4, 0], [0.7, 0], [0.7, 0.3]]
closed = true
[[fluid]]
name = "water"
packing = "relaxed"
region = { type = "box", min = [0, 0], max = [0.6, 0.2], without = ["slope"] }
[mps]
spacing = 0.01
time_step = 1e-3
scheme = ")",
                             scheme, "\"\n");
  for (const char* wall : {"floor", "side", "slope"})
    for (const char* reading : {"reaction", "neumann"})
      text +=
          text_of("[[probe]]\nname = \"", wall, "_", reading, "\"\nkind = \"wall_force\"\nwall = \"", wall,
                  "\"\nreading = \"", reading, "\"\ncomponent = \"", std::string(wall) == "floor" ? "y" : "x", "\"\n");
  return text;
}

/// Mean of each probe from `from` to `to` [s].
std::map<std::string, double> means(const Scene& scene, double from, double to) {
  FluidSimulation simulation(scene);
  std::map<std::string, double> mean;
  int counted = 0;
  while (simulation.time() < to * (1 - 1e-9)) {
    simulation.step();
    if (simulation.time() < from) continue;
    ++counted;
    for (std::size_t k = 0; k < scene.probes.size(); ++k) mean[scene.probes[k].name] += simulation.sample(k);
  }
  for (auto& [name, value] : mean) value /= counted;
  return mean;
}

}  // namespace

TEST_CASE("the reaction of floor, side and slope is the force of the pressure fitted there", "[validation][walls]") {
  for (const char* scheme : {"default", "high"}) {
    INFO(scheme);
    auto mean = means(scene_of_text(sloping_tank(scheme)), 0.2, 0.5);
    for (const char* wall : {"floor", "side", "slope"}) {
      INFO(wall);
      const double reaction = mean[text_of(wall, "_reaction")], fitted = mean[text_of(wall, "_neumann")];
      const double at_rest = rho * gravity * 0.2 * (std::string(wall) == "floor" ? 0.4 : 0.1);
      std::cout << scheme << ", " << wall << ": reaction " << reaction << ", fitted " << fitted << " N/m, ratio "
                << reaction / fitted << ", that of 0.2 m of water " << at_rest << " N/m\n";
      CHECK(reaction == Approx(fitted).epsilon(0.005));
    }
  }
}

TEST_CASE("a floor that goes up and down with half of g bears the water's weight and inertia", "[validation][walls]") {
  constexpr double omega = 4 * M_PI, depth = 0.2;
  for (const char* scheme : {"default", "high"}) {
    INFO(scheme);
    FluidSimulation simulation(scene_of_text(text_of(R"(
format = 1
[case]
name = "lift"
[time]
end = 1
[geometry.tank]
type = "box"
min = [0, 0]
max = [0.4, 0.3]
open = ["top"]
[geometry.tank.motion]
displacement = ["0", "0.5*9.81*(1-cos(4*pi*t))/(4*pi)^2"]
[[fluid]]
name = "water"
region = { type = "box", min = [0, 0], max = [0.4, 0.2] }
[mps]
spacing = 0.01
time_step = 1e-3
scheme = ")",
                                                     scheme, R"("
[[probe]]
name = "force"
kind = "wall_force"
wall = "tank"
reading = "reaction"
component = "y"
)")));
    double mean = 0, rms = 0, exact_mean = 0;
    int steps = 0;
    const double dt = simulation.dt(), weight = rho * gravity * depth * 0.4;
    while (simulation.time() < 1 * (1 - 1e-9)) {
      simulation.step();
      const double exact = -weight * (1 + 0.5 * std::cos(omega * (simulation.time() - dt / 2)));
      const double force = simulation.sample(0);
      mean += force;
      exact_mean += exact;
      rms += (force - exact) * (force - exact);
      ++steps;
    }
    rms = std::sqrt(rms / steps) / weight;
    std::cout << scheme << ", floor with half of g: mean over exact " << mean / exact_mean << ", rms of the difference "
              << rms << " of the weight\n";
    CHECK(mean == Approx(exact_mean).epsilon(0.003));
    CHECK(rms < 0.02);
  }
}
