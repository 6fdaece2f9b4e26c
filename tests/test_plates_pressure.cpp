// The pressure with plates that are wet on both sides: as few iterations as without, the same pressure, and nothing of it
// where there is no such plate.
#include <cmath>

#include "kernels/conjugate_gradient.hpp"
#include "kernels/multigrid.hpp"
#include "kernels/pressure_solver.hpp"
#include "tests/shapes.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// A column of 0.2 m x 0.4 m with or without a plate in it.
struct Scene {
  int nx = 50;                                   // particles across
  std::vector<std::array<coord, 2>> plate = {};  // its corners
  coord jitter = 0.1;
};

std::vector<std::array<coord, 2>> upright(coord x, coord height) { return {{x, 0}, {x, height}}; }

std::vector<std::array<coord, 2>> bent(coord x) {
  std::vector<std::array<coord, 2>> corners;
  for (int k = 0; k <= 10; ++k) corners.push_back({x + 0.0002 * k * k, 0.006 * k});
  return corners;
}

Fluid column(const Scene& scene) {
  const coord spacing = 0.2 / scene.nx;
  std::vector<WallFace> faces = {segment(0, 0, 0.2, 0), segment(0, 0, 0, 0.6), segment(0.2, 0.6, 0.2, 0)};
  for (std::size_t k = 1; k < scene.plate.size(); ++k)
    faces.push_back(segment(scene.plate[k - 1][0], scene.plate[k - 1][1], scene.plate[k][0], scene.plate[k][1], 1));
  Fluid fluid = fluid_at(lattice(scene.nx, 2 * scene.nx, spacing, 0, 0, scene.jitter), walls_of(faces),
                         {.spacing = spacing, .margin = 0.05});
  mark_surface(fluid, real(0.97));
  return fluid;
}

void add_plate(WallFaces& walls, coord x, coord y0, coord y1, coord height) {
  add_rectangle(walls, {x, y0, 0}, {x, y1, 0}, {x, y1, height}, {x, y0, height}, 1);
}

// A box of n^3 particles, 0.2 m wide, filled up to 0.2 m.
Fluid box(
    int n, const std::function<void(WallFaces&)>& add = [](WallFaces&) {}) {
  const coord spacing = 0.2 / n;
  WallFaces walls = open_box(0.2, 0.2, 0.25);
  add(walls);
  Positions x = lattice_3d(n, n, n, spacing);
  std::mt19937 generator(1);
  std::uniform_real_distribution<coord> shake(-0.1 * spacing, 0.1 * spacing);
  for (auto& at : x)
    for (coord& c : at) c += shake(generator);
  Fluid fluid = fluid_at(x, walls, {.dim = 3, .spacing = spacing, .radius = 2.1, .margin = 0.02});
  mark_surface(fluid, real(0.97));
  return fluid;
}

enum class Push { sideways, any };

// Sideways the water presses on one side of a plate and pulls at the other.
PressureSystem assembled(Fluid& fluid, Push push = Push::sideways) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (int d = 0; d < fluid.particles.dim; ++d)
      u(i, d) = static_cast<real>(push == Push::any ? any(generator) : d == 0 ? 1 : -0.5);
  Kokkos::deep_copy(fluid.particles.velocity, u);
  PressureOptions options;
  options.compressibility = real(4.5e-10);
  options.source = PressureSource::divergence;
  PressureSystem system(options);
  system.assemble(fluid, static_cast<real>(0.115 * fluid.spacing));
  return system;
}

ScalarField zero_pressure(const Fluid& fluid) {
  return ScalarField("greenwater::test_pressure", fluid.particles.id.extent(0));
}

int iterations(Fluid& fluid, Push push = Push::sideways) {
  const PressureSystem system = assembled(fluid, push);
  Multigrid multigrid;
  multigrid.update(system);
  const SolveReport report =
      ConjugateGradient({.tolerance = real(1e-6)}).solve(system, multigrid, zero_pressure(fluid));
  CHECK(report.converged);
  return report.iterations;
}

// Not more than without a plate but for one or two, and eight at most as there.
void check_iterations(int nx, const std::vector<std::array<coord, 2>>& plate) {
  for (const auto push : {Push::sideways, Push::any}) {
    Fluid bare = column({nx}), parted = column({nx, plate});
    const int without = iterations(bare, push), with = iterations(parted, push);
    INFO(nx << " across, plate from x = " << plate.front()[0] << " to height " << plate.back()[1] << ": " << with
            << " iterations, without it " << without);
    CHECK(with <= without + 2);
    CHECK(with <= 8);
  }
}

// M is symmetric, positive, and so near the inverse as without a plate.
void check_preconditioner(Fluid fluid) {
  const PressureSystem system = assembled(fluid);
  Multigrid multigrid;
  multigrid.update(system);
  const std::vector<int> active = free_particles(fluid);
  REQUIRE(active.size() > 300);
  const Eigen::MatrixXd M = dense(multigrid, fluid)(active, active);
  CHECK((M - M.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * M.cwiseAbs().maxCoeff());
  const Eigen::LLT<Eigen::MatrixXd> factors(dense(system)(active, active));
  REQUIRE(factors.info() == Eigen::Success);
  const Eigen::MatrixXd L = factors.matrixL();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(L.transpose() * M * L, Eigen::EigenvaluesOnly);
  const double least = solver.eigenvalues().minCoeff(), most = solver.eigenvalues().maxCoeff();
  INFO("eigenvalues of M A from " << least << " to " << most);
  CHECK(least >= 0.7);
  CHECK(most <= 1.0001);
}

}  // namespace

TEST_CASE("with plates the multigrid is symmetric and near the inverse", "[unit][plates][multigrid]") {
  check_preconditioner(column({18, upright(0.0873, 0.1)}));
  check_preconditioner(column({18, upright(0.1019, 0.6)}));
  check_preconditioner(column({18, upright(0.0451, 0.6), 0.3}));
  check_preconditioner(column({18, bent(0.0873)}));
  check_preconditioner(box(9, [](WallFaces& walls) { add_plate(walls, 0.0873, 0, 0.2, 0.25); }));
}

TEST_CASE("with plates a multigrid of several levels is symmetric", "[unit][plates][multigrid]") {
  for (const auto& plate : {upright(0.0873, 0.1), upright(0.1019, 0.6)}) {
    Fluid fluid = column({44, plate});
    Multigrid multigrid;
    multigrid.update(assembled(fluid));
    REQUIRE(multigrid.levels().stack().count >= 2);
    check_symmetric(multigrid, fluid);
  }
}

TEST_CASE("a plate wet on both sides costs hardly an iteration, 5,000 and 20,000 particles",
          "[unit][plates][multigrid]") {
  for (const int nx : {50, 100})
    for (const coord x : {0.0451, 0.0873, 0.162}) {
      check_iterations(nx, upright(x, 0.06));
      check_iterations(nx, upright(x, 0.6));
    }
  check_iterations(50, bent(0.0873));
  check_iterations(50, {{0.08, 0.1}, {0.1, 0.157}});
}

TEST_CASE("a plate wet on both sides costs hardly an iteration, to 320,000 particles",
          "[validation][plates][multigrid][full]") {
  for (const int nx : {50, 100, 200, 400})
    for (const coord x : {0.03, 0.0451, 0.0622, 0.0817, 0.0951, 0.1104, 0.1333, 0.162}) {
      check_iterations(nx, upright(x, 0.06));
      check_iterations(nx, upright(x, 0.6));
    }
}

TEST_CASE("the pressure on both sides of a plate is that of a dense solve", "[unit][plates][multigrid]") {
  for (const coord height : {0.1, 0.6}) {
    Fluid fluid = column({18, upright(0.0873, height), 0.2});
    PressureSystem system = assembled(fluid);
    SolverOptions options;
    options.cg.tolerance = real(1e-11);
    const ScalarField p = zero_pressure(fluid);
    const SolveReport report = make_pressure_solver(options)->solve(system, p);
    REQUIRE(report.converged);
    CHECK(report.recovery.empty());
    const std::vector<int> active = free_particles(fluid);
    const auto rhs = host(system.rhs()), found = host(p);
    Eigen::VectorXd b(active.size()), x(active.size());
    for (std::size_t k = 0; k < active.size(); ++k) {
      b(k) = rhs(active[k]);
      x(k) = found(active[k]);
    }
    const Eigen::VectorXd exact = dense(system)(active, active).ldlt().solve(b);
    CHECK((x - exact).norm() <= 1e-8 * exact.norm());
  }
}

TEST_CASE("in three dimensions a plate costs hardly an iteration", "[unit][plates][multigrid]") {
  Fluid bare = box(20);
  const int without = iterations(bare);
  for (const coord x : {0.062, 0.0873}) {
    Fluid plate = box(20, [&](WallFaces& walls) { add_plate(walls, x, 0.05, 0.13, 0.06); });
    Fluid barrier = box(20, [&](WallFaces& walls) { add_plate(walls, x, 0, 0.2, 0.25); });
    CHECK(iterations(plate) <= without + 1);
    CHECK(iterations(barrier) <= without + 1);
  }
}

TEST_CASE("a plate that moves, comes and goes leaves nothing behind in the multigrid", "[unit][plates][multigrid]") {
  Multigrid kept;
  for (const coord x : {0.0873, 0.0895, 0.15, -1.0, 0.05, 0.0873}) {
    Fluid fluid = x < 0 ? column({44}) : column({44, upright(x, x < 0.1 ? 0.6 : 0.1)});
    check_forgets(kept, assembled(fluid), fluid);
  }
}

TEST_CASE("without a plate wet on both sides nothing is split", "[unit][plates][multigrid]") {
  const auto solve = [](Fluid& fluid) {
    const PressureSystem system = assembled(fluid);
    Multigrid multigrid;
    multigrid.update(system);
    ConjugateGradient({}).solve(system, multigrid, zero_pressure(fluid));
  };
  Fluid bare = column({25}), parted = column({25, upright(0.0873, 0.06)}), deep = box(8);
  Fluid dry = column({25, {{0.3, 0}, {0.3, 0.2}}});
  for (Fluid* fluid : {&bare, &deep, &dry}) {
    Ears ears;
    solve(*fluid);
    CHECK(ears.launched("greenwater::grid_small_levels"));
    CHECK_FALSE(ears.launched("split"));
    CHECK_FALSE(ears.allocated("split"));
  }
  Ears ears;
  solve(parted);
  CHECK(ears.launched("greenwater::split_small_levels"));
  CHECK(ears.allocated("greenwater::split_side"));
}

TEST_CASE("a steady solve with a plate allocates nothing", "[unit][plates][multigrid]") {
  Fluid fluid = column({25, upright(0.0873, 0.06)});
  PressureSystem system = assembled(fluid);
  const auto solver = make_pressure_solver({});
  const ScalarField p = zero_pressure(fluid);
  solver->solve(system, p);
  Ears ears;
  Kokkos::deep_copy(p, real(0));
  solver->solve(system, p);
  CHECK(ears.launched("greenwater::split_find_sides"));
  CHECK(ears.allocations == std::vector<std::string>{});
}
