// Viscous flow between walls to which the fluid sticks, against the series of its start from rest.
#include <iostream>

#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// Morris, Fox and Zhu, J. Comput. Phys. 136:214 (1997): width [m], viscosity [m^2/s], force [m/s^2], speed of the lid [m/s].
constexpr double L = 1e-3, nu = 1e-6, F = 1e-4, V = 1.25e-5;

double poiseuille(double y, double t) {
  double u = F * y * (L - y) / (2 * nu);
  for (int k = 0; k < 50; ++k) {
    const double m = (2 * k + 1) * M_PI;
    u -= 4 * F * L * L / (nu * m * m * m) * std::sin(m * y / L) * std::exp(-m * m / (L * L) * nu * t);
  }
  return u;
}

double couette(double y, double t) {
  double u = V * y / L;
  for (int k = 1; k < 200; ++k) {
    const double m = k * M_PI;
    u += 2 * V / m * (k % 2 == 0 ? 1 : -1) * std::sin(m * y / L) * std::exp(-nu * m * m / (L * L) * t);
  }
  return u;
}

// In the middle third of the channel, at the times that the paper shows.
void follows(const std::string& path, double (*series)(double y, double t)) {
  FluidSimulation simulation(scene_of("channel/" + path));
  for (const double at : {0.0225, 0.045, 0.1125, 0.225}) {
    while (simulation.time() < at * (1 - 1e-9)) simulation.step();
    const auto u = host(simulation.fluid().particles.velocity);
    const auto places = places_of(simulation);
    double square = 0, worst = 0, fastest = 0;
    int count = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i][0] < 4 * L / 3 || places[i][0] > 8 * L / 3) continue;
      const double exact = series(places[i][1], simulation.time()), error = u(i, 0) - exact;
      square += error * error;
      worst = std::max(worst, std::fabs(error));
      fastest = std::max(fastest, exact);
      ++count;
    }
    REQUIRE(count > 400);
    const double rms = std::sqrt(square / count);
    std::cout << path << " at " << simulation.time() << " s: rms error " << rms / fastest << ", largest "
              << worst / fastest << " of the fastest, " << fastest << " m/s\n";
    CHECK(rms < 0.03 * fastest);
  }
  CHECK(simulation.fluid().particles.count == 1600);
}

}  // namespace

TEST_CASE("Poiseuille flow from rest", "[validation][viscosity]") { follows("poiseuille.toml", poiseuille); }
TEST_CASE("Couette flow from rest", "[validation][viscosity]") { follows("couette.toml", couette); }
