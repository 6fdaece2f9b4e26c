// The multigrid: what it is made of against dense matrices, how fast it is, and what happens where it should fail.
#include <Eigen/Sparse>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "kernels/multigrid.hpp"
#include "kernels/pressure_solver.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;
constexpr real water = real(4.5e-10);  // compressibility [1/Pa]

PressureSystem assembled(const Fluid& fluid, real compressibility = water, real dt = real(1e-3),
                         PressureSource source = PressureSource::density) {
  PressureOptions options;
  options.compressibility = compressibility;
  options.source = source;
  PressureSystem system(options);
  system.assemble(fluid, dt);
  return system;
}

WallFaces wide_tank(coord width, coord height) {
  return walls_of({segment(0, 0, width, 0), segment(0, 0, 0, height), segment(width, height, width, 0)});
}

// A column at rest in the left third of a tank.
Fluid column(int nx, coord spacing = l0, coord jitter = 0.1, unsigned seed = 1) {
  const coord width = nx * spacing;
  Fluid fluid =
      fluid_at(lattice(nx, 2 * nx, spacing, 0, 0, jitter, seed), wide_tank(3 * width, 3 * width), {.spacing = spacing});
  mark_surface(fluid, real(0.97));
  return fluid;
}

// The same, fallen: a wedge along the floor with a hole in it.
Positions wedge(int nx, coord spacing, coord jitter, int layers = 1) {
  const coord width = 3 * nx * spacing, height = 2 * nx * spacing;
  Positions x;
  std::mt19937 generator(2);
  std::uniform_real_distribution<coord> shake(-jitter * spacing, jitter * spacing);
  for (int k = 0; k < layers; ++k)
    for (const auto& at : lattice(3 * nx, 2 * nx, spacing)) {
      const coord left = 1 - at[0] / width;
      const bool hole = at[1] > 0.02 * height && std::hypot(at[0] - width / 6, at[1] - 0.3 * height) < 0.08 * height;
      if (hole || at[1] > height * (0.9 * left * left + 0.03)) continue;
      x.push_back({at[0] + shake(generator), at[1] + shake(generator),
                   layers == 1 ? 0 : (k + 0.5) * spacing + shake(generator)});
    }
  return x;
}

Fluid fallen(int nx, coord spacing = l0) {
  const coord width = 3 * nx * spacing;
  Fluid fluid = fluid_at(wedge(nx, spacing, 0.2), wide_tank(width, width), {.spacing = spacing});
  mark_surface(fluid, real(0.97));
  return fluid;
}

// u = (a x, -a y) and some disorder: a source as in a collapse.
void set_falling(Fluid& fluid) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> any(-0.02, 0.02);
  const auto x = host(fluid.particles.position);
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (int d = 0; d < fluid.particles.dim; ++d)
      u(i, d) = static_cast<real>((d == 0 ? 2 : d == 1 ? -2 : 0) * x(i, d) + any(generator));
  Kokkos::deep_copy(fluid.particles.velocity, u);
}

ScalarField zero_pressure(const Fluid& fluid) {
  return ScalarField("greenwater::test_pressure", fluid.particles.id.extent(0));
}

Eigen::VectorXd vector_of(const ScalarField& p, int count) {
  const auto values = host(p);
  Eigen::VectorXd v(count);
  for (int i = 0; i < count; ++i) v(i) = values(i);
  return v;
}

void check_symmetric_and_near_inverse(const Fluid& fluid, double least, double most) {
  const PressureSystem system = assembled(fluid);
  Multigrid multigrid;
  multigrid.update(system);
  const std::vector<int> active = free_particles(fluid);
  REQUIRE(active.size() > 100);
  const Eigen::MatrixXd all = dense(multigrid, fluid);
  const Eigen::MatrixXd M = all(active, active);
  CHECK((M - M.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * M.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd A = test::dense(system)(active, active);
  // Those of M A are those of L^T M L with A = L L^T.
  const Eigen::LLT<Eigen::MatrixXd> factors(A);
  REQUIRE(factors.info() == Eigen::Success);
  const Eigen::MatrixXd L = factors.matrixL();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(L.transpose() * M * L, Eigen::EigenvaluesOnly);
  const Eigen::VectorXd values = solver.eigenvalues();
  INFO("eigenvalues of M A from " << values.minCoeff() << " to " << values.maxCoeff());
  CHECK(values.minCoeff() >= least);
  CHECK(values.maxCoeff() <= most);
}

}  // namespace

namespace {

// P of one axis: how much of node i particle x or node x has, nodes being `step` cells apart.
double hat(double x, int i, double step) { return std::max(0.0, 1 - std::abs(x / step - i)); }

using Sparse = Eigen::SparseMatrix<double>;

struct Nodes {
  int along[3];
  int count() const { return along[0] * along[1] * along[2]; }
};

// Interpolation to places [cells] from nodes `step` cells apart.
Sparse interpolation(const Eigen::MatrixXd& place, const Nodes& nodes, double step) {
  std::vector<Eigen::Triplet<double>> shares;
  for (int row = 0; row < place.rows(); ++row)
    for (int k = 0, column = 0; k < nodes.along[2]; ++k)
      for (int j = 0; j < nodes.along[1]; ++j)
        for (int i = 0; i < nodes.along[0]; ++i, ++column) {
          const double share = hat(place(row, 0), i, step) * hat(place(row, 1), j, step) * hat(place(row, 2), k, step);
          if (share > 0) shares.emplace_back(row, column, share);
        }
  Sparse P(place.rows(), nodes.count());
  P.setFromTriplets(shares.begin(), shares.end());
  return P;
}

Nodes nodes_of(const Level& level) { return {{level.nodes[0], level.nodes[1], level.nodes[2]}}; }

// Where nodes `step` cells apart are [cells].
Eigen::MatrixXd places_of(const Nodes& nodes, double step) {
  Eigen::MatrixXd place(nodes.count(), 3);
  for (int n = 0; n < nodes.count(); ++n) {
    place(n, 0) = step * (n % nodes.along[0]);
    place(n, 1) = step * (n / nodes.along[0] % nodes.along[1]);
    place(n, 2) = step * (n / nodes.along[0] / nodes.along[1]);
  }
  return place;
}

// A level's matrix from its stencils, read where they are.
Eigen::MatrixXd dense(const Level& level, int dim) {
  const Nodes nodes = nodes_of(level);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(nodes.count(), nodes.count());
  const int size = stencil_size(dim), deep = dim == 3 ? reach : 0;
  for (int row = 0; row < nodes.count(); ++row) {
    const int i = row % nodes.along[0], j = row / nodes.along[0] % nodes.along[1],
              k = row / nodes.along[0] / nodes.along[1];
    const int slot = level.slot[(k * nodes.along[1] + j) * level.packs + i / node_lanes];
    const float* entry = level.stencil + slot * size * node_lanes + i % node_lanes;
    for (int z = k - deep; z <= k + deep; ++z)
      for (int y = j - reach; y <= j + reach; ++y)
        for (int x = i - reach; x <= i + reach; ++x, entry += node_lanes) {
          const bool inside =
              x >= 0 && x < nodes.along[0] && y >= 0 && y < nodes.along[1] && z >= 0 && z < nodes.along[2];
          if (inside)
            A(row, (z * nodes.along[1] + y) * nodes.along[0] + x) = *entry;
          else
            CHECK(std::abs(*entry) <= 1e-6);
        }
  }
  return A;
}

void check_galerkin(const Fluid& fluid) {
  const PressureSystem system = assembled(fluid);
  Multigrid multigrid;
  multigrid.update(system);
  const GridShape& grid = fluid.grid.shape();
  const std::vector<int> active = free_particles(fluid);
  const auto x = host(fluid.particles.position);
  Eigen::MatrixXd place = Eigen::MatrixXd::Zero(active.size(), 3);
  for (std::size_t i = 0; i < active.size(); ++i)
    for (int d = 0; d < fluid.particles.dim; ++d) place(i, d) = (x(active[i], d) - grid.origin[d]) / grid.cell;
  const Eigen::MatrixXd first = test::dense(system)(active, active) / system.factor();
  Sparse A = first.sparseView();
  const LevelStack& stack = multigrid.levels().stack();
  REQUIRE(stack.count >= 2);
  double step = 1;
  for (int l = 0; l < stack.count; ++l, step *= 2) {
    INFO("level " << l << " of " << stack.count);
    const Nodes nodes = nodes_of(stack.level[l]);
    const Sparse P = interpolation(place, nodes, step);
    A = Sparse(Sparse(P.transpose()) * A * P);
    const Eigen::MatrixXd exact = A, stored = dense(stack.level[l], fluid.particles.dim);
    CHECK((stored - exact).cwiseAbs().maxCoeff() <= 5e-6 * exact.cwiseAbs().maxCoeff());
    place = places_of(nodes, step);
  }
}

}  // namespace

TEST_CASE("stencils of all levels are the dense product P^T A P", "[unit][multigrid]") {
  if (!on_host) return;
  check_galerkin(column(44));
  check_galerkin(fallen(60));
  Fluid deep = fluid_at(random_cloud(2500, 3, 8, 1.4), {}, {.dim = 3, .spacing = 0.1, .radius = 2.1, .margin = 0.2});
  mark_surface(deep, real(0.7));
  check_galerkin(deep);
}

namespace {

SolveReport solve(const PressureSystem& system, const ScalarField& p, Preconditioning way, real tolerance) {
  SolverOptions options;
  options.preconditioning = way;
  options.cg.tolerance = tolerance;
  options.cg.max_iterations = 20000;
  PressureSystem own = system;
  return make_pressure_solver(options)->solve(own, p);
}

int iterations(const Fluid& fluid, PressureSource source, real tolerance = real(1e-6)) {
  const PressureSystem system = assembled(fluid, water, real(1.15e-4), source);
  const SolveReport report = solve(system, zero_pressure(fluid), Preconditioning::multigrid, tolerance);
  CHECK(report.converged);
  CHECK(report.recovery.empty());
  CHECK(report.residual <= tolerance);
  return report.iterations;
}

// From zero, over both sources: the fewest and the most iterations in a column at rest and a fallen one.
std::array<int, 2> iterations_over(const std::vector<int>& sizes) {
  std::array<int, 2> found = {1000, 0};
  for (const int nx : sizes)
    for (const bool rest : {true, false}) {
      const coord spacing = 0.2 / nx;
      Fluid fluid = rest ? column(nx, spacing) : fallen(nx, spacing);
      set_falling(fluid);
      for (const auto source : {PressureSource::density, PressureSource::divergence}) {
        const int its = iterations(fluid, source);
        INFO(fluid.particles.count << " particles, " << (rest ? "at rest" : "fallen") << ": " << its);
        CHECK(its <= 8);
        found = {std::min(found[0], its), std::max(found[1], its)};
      }
    }
  return found;
}

Fluid fallen_3d(int nx, coord radius) {
  Fluid fluid =
      fluid_at(wedge(nx, 0.2 / nx, 0.2, nx), {}, {.dim = 3, .spacing = 0.2 / nx, .radius = radius, .margin = 0.1});
  mark_surface(fluid, real(0.97));
  set_falling(fluid);
  return fluid;
}

}  // namespace

TEST_CASE("the multigrid is symmetric and near the inverse", "[unit][multigrid]") {
  check_symmetric_and_near_inverse(column(15), 0.75, 1.0001);
  check_symmetric_and_near_inverse(fallen(12), 0.75, 1.0001);
  check_symmetric_and_near_inverse(fallen_3d(7, 2.1), 0.75, 1.0001);
}

TEST_CASE("a multigrid of several levels is symmetric", "[unit][multigrid]") {
  for (const Fluid& fluid : {column(44), fallen(60)}) {
    Multigrid multigrid;
    multigrid.update(assembled(fluid));
    REQUIRE(multigrid.levels().stack().count >= 2);
    check_symmetric(multigrid, fluid);
  }
}

TEST_CASE("iterations are few and do not grow, 1,250 to 20,000 particles", "[unit][multigrid]") {
  const auto [fewest, most] = iterations_over({25, 50, 100});
  CHECK(most - fewest <= 2);
}

TEST_CASE("iterations are few and do not grow, 5,000 to 320,000 particles", "[validation][multigrid][full]") {
  const auto [fewest, most] = iterations_over({50, 100, 200, 400});
  CHECK(most - fewest <= 2);
}

TEST_CASE("iterations in three dimensions are few", "[unit][multigrid]") {
  for (const coord radius : {2.1, 3.1})
    for (const auto source : {PressureSource::density, PressureSource::divergence})
      CHECK(iterations(fallen_3d(12, radius), source) <= 8);
}

TEST_CASE("iterations in three dimensions do not grow, to 200,000 particles", "[validation][multigrid][full]") {
  for (const int nx : {12, 24, 48})
    for (const auto source : {PressureSource::density, PressureSource::divergence})
      CHECK(iterations(fallen_3d(nx, 2.1), source) <= 8);
}

namespace {

void check_equal_to_jacobi(Fluid fluid, PressureSource source) {
  set_falling(fluid);
  const PressureSystem system = assembled(fluid, water, real(1e-3), source);
  const ScalarField p = zero_pressure(fluid), q = zero_pressure(fluid);
  REQUIRE(solve(system, p, Preconditioning::multigrid, real(1e-10)).converged);
  REQUIRE(solve(system, q, Preconditioning::jacobi, real(1e-12)).converged);
  const Eigen::VectorXd found = vector_of(p, fluid.particles.count), exact = vector_of(q, fluid.particles.count);
  CHECK((found - exact).norm() <= 1e-8 * exact.norm());
}

}  // namespace

TEST_CASE("pressure by multigrid and by Jacobi's preconditioner", "[.multigrid_and_jacobi]") {
  for (const auto source : {PressureSource::density, PressureSource::divergence}) {
    check_equal_to_jacobi(column(30), source);
    check_equal_to_jacobi(fallen(30), source);
    check_equal_to_jacobi(fallen_3d(10, 2.1), source);
  }
}

TEST_CASE("the pressure is that of Jacobi's preconditioner, with 1, 2 and 4 threads", "[unit][multigrid][threads]") {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  for (const char* threads : {"1", "2", "4"}) {
    INFO(threads << " threads");
    CHECK(std::system(
              ("OMP_NUM_THREADS=" + std::string(threads) + " '" + self + "' '[.multigrid_and_jacobi]' > /dev/null")
                  .c_str()) == 0);
  }
}

namespace {

// Everything that is asked of a hard system: an answer, or a name for what is wrong, and never a number that is none.
SolveReport check_robust(Fluid& fluid, real compressibility) {
  PressureSystem system = assembled(fluid, compressibility, real(1.15e-4));
  const ScalarField p = zero_pressure(fluid);
  SolverOptions options;
  options.cg.tolerance = real(1e-6);
  const SolveReport report = make_pressure_solver(options)->solve(system, p);
  INFO(report.cause << "; " << report.recovery << "; " << report.iterations << " iterations, residual "
                    << report.residual);
  CHECK(report.converged);
  CHECK(report.residual <= 1e-6);
  CHECK(std::isfinite(vector_of(p, fluid.particles.count).sum()));
  if (report.recovery.empty())
    CHECK(report.cause == "converged");
  else
    CHECK(report.cause != "converged");
  return report;
}

// Takes the surface marks where `free` says so, as if n were high enough there.
template <class Free>
void unmark(Fluid& fluid, Free free) {
  const auto x = host(fluid.particles.position);
  const auto surface = Kokkos::create_mirror(fluid.particles.surface);
  Kokkos::deep_copy(surface, fluid.particles.surface);
  for (int i = 0; i < fluid.particles.count; ++i)
    if (free(x(i, 0), x(i, 1))) surface(i) = 0;
  Kokkos::deep_copy(fluid.particles.surface, surface);
}

// A column, a drop of 7 x 7, three particles, two and one, all far from each other.
Positions column_and_drops() {
  Positions x = lattice(20, 20, l0, 0, 0, 0.1);
  for (const auto& at : lattice(7, 7, l0, 4, 1, 0.1, 2)) x.push_back(at);
  const Positions few = {{5.5, 1, 0}, {5.55, 1.02, 0}, {5.5, 1.06, 0}, {6.5, 1, 0}, {6.56, 1.01, 0}, {7.5, 1, 0}};
  x.insert(x.end(), few.begin(), few.end());
  return x;
}

}  // namespace

TEST_CASE("closed pockets and lone clusters converge or recover with a reason", "[unit][multigrid]") {
  for (const real compressibility : {water, real(0)}) {
    Fluid pocket = fluid_at(column_and_drops(), wide_tank(9, 4), {.spacing = l0});
    mark_surface(pocket, real(0.97));
    SECTION("a drop without a surface") {
      unmark(pocket, [](double x, double) { return x > 3 && x < 5; });
      check_robust(pocket, compressibility);
    }
    SECTION("three particles, two and one") {
      unmark(pocket, [](double x, double) { return x > 5; });
      check_robust(pocket, compressibility);
    }
    SECTION("no surface anywhere") {
      unmark(pocket, [](double, double) { return true; });
      check_robust(pocket, compressibility);
    }
  }
}

TEST_CASE("an incompressible closed box recovers with a reason", "[unit][multigrid]") {
  const WallFaces box = walls_of({segment(0, 0, 1, 0), segment(1, 0, 1, 1), segment(1, 1, 0, 1), segment(0, 1, 0, 0)});
  Fluid fluid = fluid_at(lattice(10, 10, l0, 0, 0, 0.05), box, {.spacing = l0});
  mark_surface(fluid, real(0.5));
  REQUIRE(free_particles(fluid).size() == 100);
  const SolveReport report = check_robust(fluid, 0);
  CHECK_FALSE(report.recovery.empty());
}

TEST_CASE("crowds, pairs at one place and lone particles are solved", "[unit][multigrid]") {
  Positions x = lattice(20, 20, l0, 0, 0, 0.1);
  SECTION("particles at one place") {
    for (int k = 0; k < 40; ++k) x.push_back(x[37 * k % 400]);
  }
  SECTION("three times as dense on one side") {
    for (const auto& at : lattice(26, 35, l0 / std::sqrt(3.0), 0.05, 0.02, 0.1, 3))
      if (at[0] < 1) x.push_back(at);
  }
  SECTION("all in one cell") { x = random_cloud(300, 2, 4, 0.05); }
  SECTION("strewn") { x = random_cloud(400, 2, 5, 3); }
  Fluid fluid = fluid_at(x, wide_tank(4, 4), {.spacing = l0});
  for (const real ratio : {real(0.97), real(0.5), real(0)}) {
    mark_surface(fluid, ratio);
    check_robust(fluid, water);
  }
}

TEST_CASE("one particle, none, and all at the surface", "[unit][multigrid]") {
  Fluid one = fluid_at({{0.5, 0.5, 0}}, {}, {.spacing = l0});
  mark_surface(one, real(0.97));
  CHECK(check_robust(one, water).iterations == 0);
  unmark(one, [](double, double) { return true; });
  check_robust(one, water);
  Fluid none = fluid_at({}, {}, {.spacing = l0});
  CHECK(check_robust(none, water).iterations == 0);
  Fluid thin = fluid_at(lattice(30, 2, l0), {}, {.spacing = l0});
  mark_surface(thin, real(0.97));
  CHECK(check_robust(thin, water).iterations == 0);
}

TEST_CASE("a number that is none leaves the pressure finite and is named", "[unit][multigrid]") {
  for (const auto way : {Preconditioning::multigrid, Preconditioning::jacobi}) {
    Fluid fluid = column(10);
    PressureSystem system = assembled(fluid);
    SolverOptions options;
    options.preconditioning = way;
    const auto solver = make_pressure_solver(options);
    const ScalarField p = zero_pressure(fluid);
    REQUIRE(solver->solve(system, p).converged);
    const Eigen::VectorXd before = vector_of(p, fluid.particles.count);
    const auto b = Kokkos::create_mirror(system.rhs());
    Kokkos::deep_copy(b, system.rhs());
    const int some = free_particles(fluid)[20];
    const real was = b(some);
    b(some) = std::nan("");
    Kokkos::deep_copy(system.rhs(), b);
    const SolveReport report = solver->solve(system, p);
    CHECK_FALSE(report.converged);
    CHECK(report.cause == "not a number");
    CHECK(vector_of(p, fluid.particles.count) == before);

    b(some) = was;
    Kokkos::deep_copy(system.rhs(), b);
    Kokkos::deep_copy(p, std::nan(""));
    CHECK(solver->solve(system, p).converged);
    CHECK((vector_of(p, fluid.particles.count) - before).norm() <= 1e-6 * before.norm());
  }
}

TEST_CASE("particles come and go, and the multigrid forgets where they were", "[unit][multigrid]") {
  Multigrid kept;
  for (const int nx : {44, 10, 50, 5, 44}) {
    const WallFaces walls = wide_tank(16, 16);
    Fluid fluid = fluid_at(lattice(nx, 2 * nx, l0, 0.2 * nx, 0, 0.1), walls, {.spacing = l0});
    mark_surface(fluid, real(0.97));
    check_forgets(kept, assembled(fluid), fluid);
  }
}

TEST_CASE("a steady solve allocates nothing, and Jacobi's way makes no multigrid", "[unit][multigrid]") {
  Fluid fluid = column(20);
  PressureSystem system = assembled(fluid);
  const auto solver = make_pressure_solver({});
  const ScalarField p = zero_pressure(fluid);
  solver->solve(system, p);
  {
    Ears ears;
    Kokkos::deep_copy(p, real(0));
    solver->solve(system, p);
    CHECK(ears.launched("greenwater::grid_small_levels"));
    CHECK(ears.allocations == std::vector<std::string>{});
  }
  Ears ears;
  solve(system, zero_pressure(fluid), Preconditioning::jacobi, real(1e-6));
  CHECK(ears.launched("greenwater::precondition_jacobi"));
  CHECK_FALSE(ears.launched("grid"));
  CHECK_FALSE(ears.allocated("grid"));
}
