// Light structures in an incompressible fluid: what a staggered march cannot bear, and the others can.

#include <algorithm>
#include <cmath>
#include <iostream>

#include "fem/modes.hpp"
#include "tests/catch.hpp"
#include "tests/elastic.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// Of the first mode of a plate clamped at both ends that closes a column 0.5 m high and 1 m wide: by potential flow with
// p = 0 on top, rho sum over the modes of the column of (c_k^2 / k) tanh(k h), k = n pi / L.
double exact_added_mass(double height) {
  constexpr int terms = 200, points = 4000;
  constexpr double beta = 4.730040745, pi = M_PI;
  const double sigma = (std::cosh(beta) - std::cos(beta)) / (std::sinh(beta) - std::sin(beta));
  const auto shape = [&](double x) {
    return std::cosh(beta * x) - std::cos(beta * x) - sigma * (std::sinh(beta * x) - std::sin(beta * x));
  };
  double modal = 0;
  std::vector<double> part(terms, 0.0);
  for (int i = 0; i < points; ++i) {
    const double x = (i + 0.5) / points, w = shape(x);
    modal += w * w / points;
    for (int n = 0; n < terms; ++n) part[n] += w * std::cos(n * pi * x) / points;
  }
  double mass = part[0] * part[0] * height;
  for (int n = 1; n < terms; ++n) {
    const double k = n * pi;
    mass += 2 * part[n] * part[n] * std::tanh(k * height) / k;
  }
  return 1000 * mass / modal;
}

constexpr double thickness = 0.05, height = 0.5;

constexpr double wet = 50;     // [Hz], whatever the mass: so the step is as long for all
constexpr double periods = 4;  // of it

struct Outcome {
  bool bounded = true;                // the last swings are not twice as large as the first ones
  bool stable = true;                 // nor does it swing faster than half as fast again as it must
  double frequency = 0;               // [Hz]
  double of_mesh = 0;                 // what it must be: of the mesh when dry, over sqrt(1 + ratio) [Hz]
  double passes = 0, iterations = 0;  // mean
  std::string alarm;
};

/// The lowest and highest of a stretch of the way, and its zeros about their middle.
struct Stretch {
  Stretch(const std::vector<double>& way, double from, double to) {
    const auto first = way.begin() + static_cast<int>(from * way.size());
    const auto last = way.begin() + static_cast<int>(to * way.size());
    const auto [low, high] = std::minmax_element(first, last);
    size = (*high - *low) / 2;
    middle = (*high + *low) / 2;
  }
  double size, middle;
};

double frequency_of(const std::vector<double>& way, double dt) {
  const double middle = Stretch(way, 0.25, 1).middle;
  std::vector<double> zeros;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double a = way[k - 1] - middle, b = way[k] - middle;
    if (a * b < 0) zeros.push_back(dt * (static_cast<double>(k) - b / (b - a)));
  }
  return zeros.size() > 2 ? (zeros.size() - 1) / (2 * (zeros.back() - zeros.front())) : 0;
}

/// The column on a plate of which the added mass is `ratio` times its own, left to itself: rings for some wet periods.
/// A march that diverges and then goes to and fro from step to step is bounded, and not stable.
Outcome ring(double ratio, const std::string& way, int steps_per_period, const std::vector<CaseOption>& more = {}) {
  constexpr double poisson = 0.34, beta = 4.730040745;
  const double mass = exact_added_mass(height) / ratio, omega = 2 * M_PI * wet;
  const double stiffness = omega * omega * mass * (1 + ratio), dt = 1 / (wet * steps_per_period);
  const double young = stiffness / std::pow(beta, 4) * 12 * (1 - poisson * poisson) / std::pow(thickness, 3);
  const std::string text =
      text_of(column_on_plate(height), "[[probe]]\nname = \"mid\"\nkind = \"structure_displacement\"\n",
              "point = [0.5, 0]\ncomponent = \"y\"\n[coupling]\nscheme = \"", way, "\"\n");
  std::vector<CaseOption> options{changed("structure.0.density", mass / thickness), changed("structure.0.young", young),
                                  changed("mps.time_step", dt)};
  options.insert(options.end(), more.begin(), more.end());
  Outcome outcome;
  std::vector<double> swing;
  const int steps = static_cast<int>(periods * steps_per_period);
  try {
    FluidSimulation simulation(scene_of_text(text, options));
    const ElasticBody& plate = simulation.coupler().body(0);
    outcome.of_mesh = lowest_modes(*plate.solid, *plate.supports, 1).frequencies[0] / std::sqrt(1 + ratio);
    for (int k = 0; k < steps; ++k) {
      simulation.step();
      swing.push_back(simulation.sample(0));
      outcome.passes += simulation.coupler().passes() / static_cast<double>(steps);
      outcome.iterations += simulation.facts().iterations / static_cast<double>(steps);
      if (outcome.alarm.empty()) outcome.alarm = simulation.coupler().alarm();
    }
  } catch (const std::exception&) {  // walls through each other, numbers that are none
    outcome.bounded = outcome.stable = false;
    return outcome;
  }
  outcome.frequency = frequency_of(swing, dt);
  outcome.bounded = Stretch(swing, 0.5, 1).size < 2 * Stretch(swing, 0, 0.5).size;
  outcome.stable = outcome.bounded && outcome.frequency < 1.5 * wet;
  return outcome;
}

void tell(double ratio, const std::string& how, const Outcome& outcome) {
  std::cout << "added mass ratio " << ratio << ", " << how << ": "
            << (outcome.stable    ? "stable"
                : outcome.bounded ? "bounded"
                                  : "FAILS");
  if (outcome.bounded)
    std::cout << ", " << outcome.frequency << " Hz (thin plate " << wet << ", mesh " << outcome.of_mesh << "), "
              << outcome.passes << " passes, " << outcome.iterations << " iterations a step";
  std::cout << '\n';
}

}  // namespace

TEST_CASE(
    "a plate under a column: joint and repeated marches bear any added mass, the staggered one none above its own",
    "[stability][coupling]") {
  CHECK(exact_added_mass(2) == Approx(1429.9).epsilon(0.001));  // the height of Fourey et al. 2017
  for (const double ratio : {0.1, 0.5, 2.0, 5.0, 20.0, 100.0}) {
    INFO("ratio " << ratio);
    for (const char* way : {"default", "aitken"}) {
      const Outcome outcome = ring(ratio, way, 40);
      tell(ratio, way, outcome);
      CHECK(outcome.stable);
      CHECK(outcome.frequency == Approx(wet).epsilon(0.03));
      CHECK(outcome.frequency == Approx(outcome.of_mesh).epsilon(0.02));
    }
    const Outcome staggered = ring(ratio, "staggered", 40);
    tell(ratio, "staggered", staggered);
    CHECK(staggered.stable == (ratio < 1));
    if (ratio < 1) CHECK(staggered.alarm.empty());
    if (ratio > 1 && staggered.bounded) CHECK_FALSE(staggered.alarm.empty());  // else it has ended before
  }
}

TEST_CASE("a diagonal 1.05 times as large does not make a staggered march of a light structure right",
          "[stability][coupling]") {
  // In one step sound goes 3.5 l0, whatever the step: the plate feels the water that it has reached, and not all of it.
  for (const double C : {1.0, 1.05})
    for (const double ratio : {0.1, 0.5, 2.0, 5.0, 20.0, 100.0}) {
      INFO("ratio " << ratio << ", C = " << C);
      const Outcome outcome =
          ring(ratio, "staggered", 40, {changed("mps.default.diagonal_factor", C), changed("mps.spacing", 0.02)});
      tell(ratio, text_of("staggered, spacing 0.02 m, C = ", C), outcome);
      CHECK(outcome.stable == (ratio < 1));
    }
}

TEST_CASE("the added mass that the solve has is that of potential flow", "[validation][coupling]") {
  for (const int particles : {20, 40}) {
    FluidSimulation simulation(scene_of_text(text_of(column_on_plate(2), "[output]\nhistory_every_steps = 1\n"),
                                             {changed("mps.spacing", 1.0 / particles)}));
    simulation.step();
    const double mass = simulation.coupler().added_mass_ratio(0) * 2700 * 0.05;
    std::cout << particles << " particles along the span: added mass " << mass << " kg/m2, exact "
              << exact_added_mass(2) << '\n';
    CHECK(mass == Approx(exact_added_mass(2)).epsilon(0.003));
  }
}
