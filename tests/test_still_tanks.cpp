// Water at rest in tanks of many shapes: it stays in, and it stays level.
#include <iostream>

#include "app/fill.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

Interior inside_of(const Scene& scene) {
  return scene.dimension == 2 ? Interior(scene.polylines.at(0).points) : Interior(scene.meshes.at(0).mesh);
}

// Coarse: l0 = 6 mm where the case has 4 mm.
const std::vector<std::string> coarse{"mps.spacing=0.006", "mps.time_step=0.00069"};

// For `times` sqrt(H / g), H = 0.08 m.
void stays_still(const std::string& path, double times, const std::vector<std::string>& settings = {}) {
  constexpr double H = 0.08;
  const Scene scene = scene_of("hydrostatic/" + path, settings);
  const Interior inside = inside_of(scene);
  const std::size_t up = scene.dimension - 1;
  Watched run(scene, [&](const Point& x) { return !inside.holds(x); });
  const int particles = run.simulation.fluid().particles.count;
  double height = 0;
  int samples = 0;
  const double end = times * std::sqrt(H / 9.81);
  while (run.simulation.time() < end) {
    run.step();
    if (run.simulation.steps() % 50 != 0 || run.simulation.time() < end / 2) continue;
    height += centroid_of(run.simulation)[up];
    ++samples;
  }
  const double level = level_of(inside, height / samples), l0 = scene.mps.spacing;
  std::cout << path << ": " << particles << " particles, " << times << " sqrt(H/g): mean level " << level << " m of "
            << scene.fluid.level << " (" << (level - scene.fluid.level) / l0 << " l0), fastest " << run.fastest
            << " m/s, energy " << run.energy << ", gain " << run.gain << ", stopped at walls " << run.stopped
            << ", outside " << run.outside << '\n';
  CHECK(std::fabs(level - scene.fluid.level) < 0.5 * l0);
  CHECK(run.outside == 0);
  CHECK(run.stopped == 0);
  CHECK(run.simulation.fluid().particles.count == particles);
  CHECK(std::isfinite(run.fastest));
}

}  // namespace

TEST_CASE("a closed shape is filled with as many particles as have room, spread evenly", "[unit][fill]") {
  for (const std::string path : {"turned.toml", "corners.toml", "turned_3d.toml", "v_tank.toml"}) {
    INFO(path);
    const Scene scene = scene_of("hydrostatic/" + path);
    const Interior inside = inside_of(scene);
    const FluidSimulation simulation(scene);
    const auto& fluid = simulation.fluid();
    CHECK(fluid.particles.count ==
          std::lround(inside.measure_below(scene.fluid.level) / std::pow(scene.mps.spacing, scene.dimension)));
    for (const Point& x : places_of(simulation)) {
      REQUIRE(inside.holds(x));
      REQUIRE(x[scene.dimension - 1] < scene.fluid.level);
      CHECK(inside.distance(x) > 0.25 * scene.mps.spacing);
    }
    const auto n = host(fluid.particles.number_density);
    double most = 0;
    for (int i = 0; i < fluid.particles.count; ++i) most = std::max(most, n(i) / fluid.density.reference.n0);
    CHECK(most < 1.06);
  }
}

TEST_CASE("still tank turned by 17 degrees, coarse", "[stability][hydrostatic]") {
  stays_still("turned.toml", 100, coarse);
}
TEST_CASE("still tank with corners of 40 and 120 degrees, coarse", "[stability][hydrostatic]") {
  stays_still("corners.toml", 100, coarse);
}
TEST_CASE("still tanks in 3-D, shortly", "[stability][hydrostatic]") {
  stays_still("turned_3d.toml", 5);
  stays_still("v_tank.toml", 5);
}

TEST_CASE("still tank turned by 17 degrees", "[stability][full]") { stays_still("turned.toml", 100); }
TEST_CASE("still tank with corners of 40 and 120 degrees", "[stability][full]") { stays_still("corners.toml", 100); }
TEST_CASE("still tank in 3-D turned by 17 degrees", "[stability][full]") { stays_still("turned_3d.toml", 100); }
TEST_CASE("still V-shaped tank from an STL file", "[stability][full]") { stays_still("v_tank.toml", 100); }
