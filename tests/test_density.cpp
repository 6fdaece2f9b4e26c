// The weight function and its sums on the lattice.
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

TEST_CASE("the paper's weight function is finite at 0 and 0 at its radius", "[unit][weight]") {
  const Weight w{real(2.1), real(0.05)};
  CHECK(w(real(0)) == Approx(1 / 0.05 - 1 / 1.05));  // 19.05
  CHECK(w(w.radius) == 0);
  CHECK(w(real(2.1 - 1e-9)) == Approx(0).margin(1e-8));
  CHECK(w(real(3)) == 0);
  const Weight standard{real(2.1), 0};
  CHECK(standard(real(1.05)) == Approx(1));
}

TEST_CASE("lattice constants equal the table", "[unit][weight]") {
  std::ifstream file(std::string(GREENWATER_SOURCE_DIR) + "/tests/reference/mps_constants.csv");
  REQUIRE(file);
  std::string line;
  int rows = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line.rfind("dim", 0) == 0) continue;
    std::replace(line.begin(), line.end(), ',', ';');
    std::istringstream cells(line);
    std::string dim, re, name, neighbours, n0, lambda;
    for (auto* cell : {&dim, &re, &name, &neighbours, &n0, &lambda}) std::getline(cells, *cell, ';');
    const bool standard = name == "std re/r - 1" || name == "std re/r-1";
    if (!standard && name != "paper eq3") continue;  // the table knows kernels that the program does not have
    const coord l0 = 0.004;
    const Weight w{static_cast<real>(std::stod(re) * l0), standard ? real(0) : real(0.05)};
    const Reference lattice = lattice_reference(w, std::stoi(dim), l0);
    INFO(line);
    CHECK(lattice.n0 == Approx(std::stod(n0)).epsilon(1e-6));
    CHECK(lattice.lambda / (l0 * l0) == Approx(std::stod(lambda)).epsilon(1e-6));
    ++rows;
  }
  CHECK(rows >= 8);
}

TEST_CASE("inside a lattice n is n0, at its edge less, and alone 0", "[unit][density]") {
  FluidOptions options;
  Fluid fluid = fluid_at(lattice(11, 11, options.spacing), {}, options);
  const auto n = by_id(fluid, fluid.particles.number_density);
  CHECK(n[60] == Approx(fluid.density.reference.n0).epsilon(1e-12));
  CHECK(n[0] < 0.5 * n[60]);
  mark_surface(fluid, real(0.97));
  const auto surface = by_id(fluid, fluid.particles.surface);
  CHECK(surface[60] == 0);
  CHECK(surface[0] == 1);
  const Fluid alone = fluid_at({{0, 0, 0}}, {}, options);
  CHECK(by_id(alone, alone.particles.number_density)[0] == 0);
}

TEST_CASE("each weight has its own radius, and the rows reach as far as the widest", "[unit][density]") {
  Fluid fluid = fluid_at(lattice(15, 15, 0.1), {}, {.spacing = 0.1, .radius = 3.9});
  fluid.laplacian.weight.radius = real(0.21);
  fluid.density.weight.radius = real(0.31);
  fluid.density.reference = lattice_reference(fluid.density.weight, 2, 0.1);
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  const auto id = host(fluid.particles.id);
  const auto rows = entries_of(fluid);
  for (int i = 0; i < fluid.particles.count; ++i) {
    if (id(i) != 112) continue;   // the middle
    CHECK(rows[i].size() == 44);  // within 3.9 l0
    int within_laplacian = 0;
    for (const Entry& entry : rows[i]) within_laplacian += entry.weight > 0;
    CHECK(within_laplacian == 12);
  }
  CHECK(by_id(fluid, fluid.particles.number_density)[112] == Approx(fluid.density.reference.n0).epsilon(1e-12));
}
