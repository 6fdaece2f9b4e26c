// How long steps are: what each limit says, how steps follow each other, and the speed that they go by.

#include <limits>

#include "core/check.hpp"
#include "kernels/speed.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double l0 = 0.004;  // [m] of hydrostatic/tank.toml

/// A fluid whose particle i has the speed speed(i), in turning directions.
Fluid moving_fluid(int count, int dim, const std::function<double(int)>& speed) {
  Fluid fluid = fluid_at(random_cloud(count, dim, 3), {}, {.dim = dim});
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < count; ++i) {
    u(i, 0) = static_cast<real>(speed(i) * std::cos(i));
    u(i, dim - 1) = static_cast<real>(speed(i) * std::sin(i));
  }
  Kokkos::deep_copy(fluid.particles.velocity, u);
  return fluid;
}

/// A still tank with steps that adapt and could be long.
Scene adaptive_tank(std::vector<std::string> settings = {}) {
  settings.insert(settings.begin(), {"mps.adaptive=true", "mps.time_step=0.01", "effects.viscosity.kinematic=1e-9"});
  return scene_of("hydrostatic/tank.toml", settings);
}

/// The first step of that.
double first_step(const std::vector<std::string>& settings) { return FluidSimulation(adaptive_tank(settings)).dt(); }

}  // namespace

TEST_CASE("the bulk's speed is that of uniform motion, and not that of a drop", "[unit][speed]") {
  for (const int dim : {2, 3}) {
    const Fluid uniform = moving_fluid(5000, dim, [](int) { return 3.0; });
    CHECK(max_speed(uniform) == Approx(3));
    CHECK(bulk_speed(uniform) == Approx(3).epsilon(1e-3));
    CHECK(bulk_speed(uniform) <= max_speed(uniform));
    const Fluid drop = moving_fluid(5000, dim, [](int i) { return i == 17 ? 50.0 : 3.0; });
    CHECK(max_speed(drop) == Approx(50));
    CHECK(bulk_speed(drop) == Approx(3).epsilon(0.2));
    const Fluid jet = moving_fluid(5000, dim, [](int i) { return i < 50 ? 50.0 : 3.0; });
    CHECK(bulk_speed(jet) == Approx(50).epsilon(0.05));
  }
}

TEST_CASE("the bulk's speed goes evenly with the speeds", "[unit][speed]") {
  // Speeds from 0 to 1: the thousandth fastest has 0.999 of the highest.
  CHECK(bulk_speed(moving_fluid(20000, 2, [](int i) { return i / 19999.0; })) == Approx(0.999).epsilon(1e-3));
  // Drops that are faster and faster pull no one along.
  for (double fastest = 3; fastest < 700; fastest *= 1.3) {
    const double speed = bulk_speed(moving_fluid(5000, 2, [&](int i) { return i == 17 ? fastest : 3 * i / 4999.0; }));
    CHECK(speed <= 3 * 1.2);
    CHECK(speed >= 3 / 1.2);
  }
}

TEST_CASE("speeds of nobody, of those at rest, and of one", "[unit][speed]") {
  CHECK(max_speed(moving_fluid(0, 2, {})) == 0);
  CHECK(bulk_speed(moving_fluid(0, 3, {})) == 0);
  CHECK(bulk_speed(moving_fluid(100, 2, [](int) { return 0.0; })) == 0);
  CHECK(bulk_speed(moving_fluid(1, 3, [](int) { return 2.0; })) == Approx(2).epsilon(1e-3));
}

TEST_CASE("a speed that is no number is not overlooked", "[unit][speed]") {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), infinite}) {
    const Fluid fluid = moving_fluid(3000, 2, [&](int i) { return i == 1234 ? wrong : 1.0; });
    CHECK(std::isnan(max_speed(fluid)));
    CHECK(std::isnan(bulk_speed(fluid)));
    CHECK(std::isnan(fluid_sums(fluid, {0, 0, 0}).max_speed));
  }
}

TEST_CASE("each limit of the step in turn is the one that counts", "[unit][step_length]") {
  CHECK(first_step({"mps.time_step=\"0.46 ms\""}) == 0.00046);
  CHECK(first_step({}) == Approx(0.25 * std::sqrt(l0 / 9.81)));
  CHECK(first_step({"time.gravity=[0, 0]"}) == 0.01);
  CHECK(first_step({"effects.viscosity.kinematic=0.01"}) == Approx(0.25 * l0 * l0 / (2 * 0.01)));
  CHECK(first_step({"fluid.0.velocity=[3, 0]"}) == Approx(0.25 * l0 / 3).epsilon(1e-3));
  CHECK(first_step({"fluid.0.velocity=[3, 0]", "mps.courant=0.1"}) == Approx(0.1 * l0 / 3).epsilon(1e-3));
  CHECK(first_step({"geometry.tank.motion.velocity=[0, 2]"}) == Approx(0.25 * l0 / 2));
  // The way counts that is gone in the step: 500 t^2 = l0 / 4.
  CHECK(first_step({"geometry.tank.motion.velocity=[\"1000*t\", 0]", "time.end=0.02"}) ==
        Approx(std::sqrt(0.25 * l0 / 500)));
  // A turn about a corner moves the opposite one, a diagonal of sqrt(0.05) m away, fastest.
  CHECK(first_step({"geometry.tank.motion.rotation=\"5*t\"", "geometry.tank.motion.about=[0, 0]"}) ==
        Approx(0.25 * l0 / (5 * std::sqrt(0.05))));
}

TEST_CASE("a step grows only so fast, and shrinks at once", "[unit][step_length]") {
  const Scene scene = adaptive_tank({"mps.growth=1.2"});
  const FluidSimulation simulation(scene);
  const StepLength length(scene);
  CHECK(length.next(simulation.fluid(), 1e-4) == Approx(1.2e-4));
  CHECK(length.next(simulation.fluid(), 1) == length.next(simulation.fluid(), infinite));
}

TEST_CASE("the last step ends at the end, and none is tiny", "[unit][step_length]") {
  for (const char* end : {"0.0231", "0.02301", "0.0229999", "0.00101", "0.000999999"}) {
    const Scene scene =
        scene_of("hydrostatic/tank.toml", {"mps.adaptive=true", "mps.time_step=\"0.9 ms\"",
                                           "fluid.0.velocity=[\"0.1*sin(30*x)\", 0]", std::string("time.end=") + end});
    FluidSimulation simulation(scene);
    double before = infinite, shortest = infinite, sum = 0;
    while (simulation.time() < scene.end) {
      simulation.step();
      CHECK(simulation.dt() <= 0.0009);
      CHECK(simulation.dt() <= 1.1 * before * (1 + 1e-12));
      before = simulation.dt();
      shortest = std::min(shortest, before);
      sum += before;
    }
    INFO(end << " s in " << simulation.steps() << " steps");
    CHECK(simulation.time() == scene.end);
    CHECK(sum == Approx(scene.end).epsilon(1e-12));
    CHECK(shortest > 0.00022);
    CHECK(simulation.facts().dt == before);
  }
}

TEST_CASE("a wall that jumps a little does not stop the run", "[unit][step_length]") {
  FluidSimulation simulation(adaptive_tank({"geometry.tank.motion.displacement=[0, \"t > 0.01 ? -0.003 : 0\"]"}));
  for (int k = 0; k < 4; ++k) simulation.step();
  CHECK(simulation.time() > 0.01);
}

TEST_CASE("fixed steps are what they were: multiples of one, and nobody asks for speeds", "[unit][step_length]") {
  const Scene scene = scene_of("hydrostatic/tank.toml", {"fluid.0.velocity=[\"30*y\", 0]"});
  FluidSimulation simulation(scene);
  const Ears ears;
  for (int k = 1; k <= 7; ++k) {
    simulation.step();
    CHECK(simulation.dt() == 0.00046);
    CHECK(simulation.time() == k * 0.00046);
  }
  CHECK(!ears.launched("max_speed"));
}

TEST_CASE("a velocity that is no number ends a run of adaptive steps too", "[unit][step_length]") {
  FluidSimulation simulation(adaptive_tank({"effects.body_force.acceleration=[\"t > 0.001 ? 0/0 : 0\", 0]"}));
  CHECK_THROWS_AS(
      [&] {
        for (int k = 0; k < 10; ++k) simulation.step();
      }(),
      NumericsError);
  CHECK_THROWS_WITH(FluidSimulation(adaptive_tank({"fluid.0.velocity=[\"x < 0.004 ? 0/0 : 0\", 0]"})),
                    Catch::Contains("a velocity is not a number"));
}
