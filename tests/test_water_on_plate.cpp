// Deep water at rest on a plate that is far lighter than what goes with it: the load is the weight of the water, in every
// step, and the plate stands where that load puts its mesh.

#include <algorithm>
#include <cmath>
#include <iostream>

#include "fem/static_solution.hpp"
#include "kernels/sample.hpp"
#include "tests/catch.hpp"
#include "tests/elastic.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double height = 2, thickness = 0.05, spacing = 0.05, gravity = 9.81, rho = 1000;
constexpr double added_mass = 1429.9;  // [kg/m2], of the first mode (test_coupling_stability.cpp)

/// Displacement of the middle under rho g height and the plate's own weight, as the same mesh bears them at rest [m].
double middle_at_rest(const ElasticBody& body) {
  const auto& rest = body.surface.rest();
  Eigen::VectorXd at_corners = Eigen::VectorXd::Zero(2 * body.surface.corners());
  for (const auto& face : body.surface.corner_of_face())
    for (int e = 0; e < 2; ++e)
      at_corners[2 * face[e] + 1] -= rho * gravity * height * std::fabs(rest[face[0]][0] - rest[face[1]][0]) / 2;
  Loads loads;
  loads.add(body.surface.on_nodes(at_corners) + gravity_pattern(*body.solid, {0, -gravity, 0}));
  const StaticSolution solution = solve_static(*body.solid, *body.supports, loads);
  REQUIRE(solution.converged);
  return body.surface.at_corners(solution.u).minCoeff();
}

/// Kinetic and potential, this from the plate at rest on [J/m].
double energy_of(const FluidSimulation& simulation) {
  const FluidSums sums = fluid_sums(simulation.fluid(), {});
  return sums.energy();
}

struct Outcome {
  double mean = 0, least = 1e300, most = 0;  // load over weight, from 0.15 s on
  double deflection = 0;                     // mean of then, over that of the mesh at rest
  double first_row = 0;                      // farthest of the lowest particles from half a spacing over the plate [l0]
  double energy = 0;                         // most, above that at the start, over that
  double iterations = 0;                     // mean
};

Outcome stand(double ratio, const std::string& scheme, double jitter, double end) {
  const double mass = added_mass / ratio, calm = 60;  // [1/s], e-fold of the swing, so that 0.15 s are enough
  const std::string text =
      text_of(column_on_plate(height),
              "[[probe]]\nname = \"mid\"\nkind = \"structure_displacement\"\npoint = [0.5, 0]\ncomponent = \"y\"\n",
              "[[probe]]\nname = \"force\"\nkind = \"structure_force\"\ncomponent = \"y\"\n");
  FluidSimulation simulation(
      scene_of_text(text, {changed("structure.0.density", mass / thickness), changed("mps.spacing", spacing),
                           changed("structure.0.fem.damping_alpha", 2 * calm * (1 + ratio)),
                           changed("fluid.0.jitter", jitter), set_option("mps.scheme=" + scheme)}));
  const double weight = rho * gravity * height, at_rest = middle_at_rest(simulation.coupler().body(0));
  const double energy = energy_of(simulation);
  Outcome outcome;
  int steps = 0, counted = 0;
  while (simulation.time() < end * (1 - 1e-9)) {
    simulation.step();
    outcome.iterations += simulation.facts().iterations;
    if (++steps % 50 == 0) outcome.energy = std::max(outcome.energy, energy_of(simulation) / energy - 1);
    if (simulation.time() < 0.15) continue;
    const double load = -simulation.sample(1) / weight;
    outcome.mean += load;
    outcome.least = std::min(outcome.least, load);
    outcome.most = std::max(outcome.most, load);
    outcome.deflection += simulation.sample(0) / at_rest;
    ++counted;
  }
  outcome.mean /= counted;
  outcome.deflection /= counted;
  outcome.iterations /= steps;
  for (const Point& x : places_of(simulation)) {
    const double bent =
        simulation.sample(0) * std::pow(4 * x[0] * (1 - x[0]), 2);  // the plate, nearly; 1e-3 l0 at most
    const double off = (x[1] - bent) / spacing - 0.5;
    if (off < 0.5) outcome.first_row = std::max(outcome.first_row, std::fabs(off));
  }
  return outcome;
}

void check(double ratio, const std::string& scheme, double jitter, double end) {
  INFO("added mass " << ratio << " times the plate's, " << scheme << ", jitter " << jitter);
  const Outcome outcome = stand(ratio, scheme, jitter, end);
  std::cout << "added mass " << ratio << " times the plate's, " << scheme << ", jitter " << jitter << ", " << end
            << " s: load / weight " << outcome.mean << " (" << outcome.least << " to " << outcome.most
            << "), deflection / that of the mesh " << outcome.deflection << ", first row off by " << outcome.first_row
            << " l0, energy " << outcome.energy << ", " << outcome.iterations << " iterations a step\n";
  CHECK(outcome.mean == Approx(1).margin(jitter > 0 ? 0.005 : 0.003));
  CHECK(outcome.least > 0.98);
  CHECK(outcome.most < 1.02);
  CHECK(outcome.deflection == Approx(1).margin(0.01));
  if (jitter > 0) return;  // a start that is not one of rest
  CHECK(outcome.energy < 1e-4);
  CHECK(outcome.first_row < 0.003);
}

}  // namespace

TEST_CASE("a plate bears the weight of the water on it, in every step", "[validation][coupling]") {
  check(37, "default", 0, 0.3);
  check(37, "default", 0.15, 0.3);
}

TEST_CASE("a plate bears the weight of the water on it for a second, whatever it weighs itself",
          "[validation][coupling][full]") {
  for (const char* scheme : {"default", "high"})
    for (const double ratio : {10.0, 37.0, 100.0}) check(ratio, scheme, 0, 1);
  for (const char* scheme : {"default", "high"}) check(37, scheme, 0.15, 1);
}
