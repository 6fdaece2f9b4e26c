// The pressure equation: symmetric, positive definite, solved, and refused with its cause when it cannot be.
#include <cmath>

#include "kernels/conjugate_gradient.hpp"
#include "kernels/motion.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;

// A tank with a plate of no thickness and a thick one in it.
WallFaces tank_with_plates() {
  WallFaces walls;
  walls.bodies = {{"tank"}, {"thin"}, {"thick"}};
  walls.faces = {segment(0, 0, 2, 0),           segment(0, 0, 0, 3),          segment(2, 3, 2, 0),
                 segment(0.7, 0, 0.7, 0.8, 1),  segment(1.2, 0, 1.2, 0.5, 2), segment(1.2, 0.5, 1.43, 0.5, 2),
                 segment(1.43, 0.5, 1.43, 0, 2)};
  return walls;
}

Positions cloud_in_tank(int count, unsigned seed) {
  Positions x = random_cloud(count, 2, seed, 2);
  x.erase(std::remove_if(x.begin(), x.end(), [](const auto& p) { return p[0] > 1.2 && p[0] < 1.43 && p[1] < 0.5; }),
          x.end());
  return x;
}

PressureOptions source(PressureSource kind, real C = 1, real compressibility = 0) {
  PressureOptions options;
  options.source = kind;
  options.diagonal_factor = C;
  options.compressibility = compressibility;
  return options;
}

void set_random_velocity(Fluid& fluid, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (int d = 0; d < fluid.particles.dim; ++d) u(i, d) = static_cast<real>(any(generator));
  Kokkos::deep_copy(fluid.particles.velocity, u);
}

Eigen::MatrixXd active_part(const Eigen::MatrixXd& all, const Fluid& fluid) {
  const auto surface = host(fluid.particles.surface);
  std::vector<int> active;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (!surface(i)) active.push_back(i);
  Eigen::MatrixXd part(active.size(), active.size());
  for (std::size_t i = 0; i < active.size(); ++i)
    for (std::size_t j = 0; j < active.size(); ++j) part(i, j) = all(active[i], active[j]);
  return part;
}

void check_symmetric_positive(Fluid& fluid) {
  mark_surface(fluid, real(0.97));
  PressureSystem system(source(PressureSource::density));
  system.assemble(fluid, real(1e-3));
  const Eigen::MatrixXd A = active_part(dense(system), fluid);
  REQUIRE(A.rows() > 20);
  CHECK((A - A.transpose()).cwiseAbs().maxCoeff() <= 1e-15 * A.cwiseAbs().maxCoeff());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A, Eigen::EigenvaluesOnly);
  CHECK(solver.eigenvalues().minCoeff() > 0);
}

}  // namespace

TEST_CASE("the operator is symmetric and positive definite with walls, corners and plates", "[unit][pressure]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    FluidOptions options;
    options.spacing = l0;
    Fluid fluid = fluid_at(cloud_in_tank(500, seed), tank_with_plates(), options);
    check_symmetric_positive(fluid);
  }
  // A lattice in line with the plates: ways that touch their ends to the last bit.
  Fluid aligned = fluid_at(lattice(12, 12, l0), tank_with_plates(), {.spacing = l0});
  check_symmetric_positive(aligned);
  Fluid cloud3 = fluid_at(random_cloud(700, 3, 8), {}, {.dim = 3, .spacing = 0.125});
  check_symmetric_positive(cloud3);
}

TEST_CASE("recomputed weights give the same operator and hold no memory", "[unit][pressure]") {
  Fluid fluid = fluid_at(cloud_in_tank(400, 4), tank_with_plates(), {.spacing = l0});
  mark_surface(fluid, real(0.97));
  PressureSystem system(source(PressureSource::density));
  system.assemble(fluid, real(1e-3));
  const Eigen::MatrixXd kept = dense(system);
  fluid.keep_weights = false;
  CHECK((kept - dense(system)).cwiseAbs().maxCoeff() <= 1e-13 * kept.cwiseAbs().maxCoeff());

  Ears ears;
  NeighborRows lean;
  lean.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  CHECK(lean.near.entries == fluid.rows.near.entries);
  CHECK(ears.allocated("greenwater::row_index"));
  CHECK_FALSE(ears.allocated("weight"));
}

TEST_CASE("conjugate gradients agree with a dense solve", "[unit][pressure]") {
  for (const auto kind : {PressureSource::density, PressureSource::divergence})
    for (const bool jacobi : {true, false}) {
      Fluid fluid = fluid_at(cloud_in_tank(500, 5), tank_with_plates(), {.spacing = l0});
      set_random_velocity(fluid, 6);
      mark_surface(fluid, real(0.97));
      PressureSystem system(source(kind));
      system.assemble(fluid, real(1e-3));
      const auto preconditioner = jacobi ? make_jacobi() : make_identity();
      preconditioner->update(system);
      ConjugateGradient cg({.tolerance = real(1e-13), .max_iterations = 5000});
      const ScalarField p = fluid.particles.pressure;
      const SolveReport report = cg.solve(system, *preconditioner, p);
      REQUIRE(report.converged);
      const int n = fluid.particles.count;
      Eigen::MatrixXd A = dense(system);
      Eigen::VectorXd b(n), x(n);
      const auto surface = host(fluid.particles.surface);
      const auto rhs = host(system.rhs()), found = host(p);
      for (int i = 0; i < n; ++i) {
        if (surface(i)) A(i, i) = 1;
        b(i) = rhs(i);
        x(i) = found(i);
      }
      const Eigen::VectorXd exact = A.ldlt().solve(b);
      CHECK((x - exact).norm() <= 1e-9 * exact.norm());
    }
}

TEST_CASE("a closed cluster without a surface is refused with its cause", "[unit][pressure]") {
  WallFaces box;
  box.bodies = {{"box"}};
  box.faces = {segment(0, 0, 1, 0), segment(1, 0, 1, 1), segment(1, 1, 0, 1), segment(0, 1, 0, 0)};
  Fluid fluid = fluid_at(lattice(10, 10, l0, 0, 0, 0.05), box, {.spacing = l0});
  mark_surface(fluid, real(0.5));
  PressureSystem system(source(PressureSource::density));
  system.assemble(fluid, real(1e-3));
  const auto preconditioner = make_jacobi();
  preconditioner->update(system);
  ConjugateGradient cg({});
  const SolveReport report = cg.solve(system, *preconditioner, fluid.particles.pressure);
  CHECK_FALSE(report.converged);
  CHECK(report.iterations < 500);
  CHECK(std::string(report.cause).find("not positive") != std::string::npos);

  SECTION("and compressible water makes it regular") {
    PressureSystem water(source(PressureSource::density, 1, real(4.5e-10)));
    water.assemble(fluid, real(1e-3));
    preconditioner->update(water);
    CHECK(cg.solve(water, *preconditioner, fluid.particles.pressure).converged);
  }
}

TEST_CASE("a number that is none, and too few iterations, are named", "[unit][pressure]") {
  Fluid fluid = fluid_at(lattice(20, 20, l0, 0, 0, 0.1), {}, {.spacing = l0});
  mark_surface(fluid, real(0.97));
  PressureSystem system(source(PressureSource::density));
  system.assemble(fluid, real(1e-3));
  const auto preconditioner = make_jacobi();
  preconditioner->update(system);
  ConjugateGradient hasty({.max_iterations = 2});
  CHECK(hasty.solve(system, *preconditioner, fluid.particles.pressure).cause == "too many iterations");
  const auto b = Kokkos::create_mirror(system.rhs());
  Kokkos::deep_copy(b, system.rhs());
  b(200) = std::nan("");
  Kokkos::deep_copy(system.rhs(), b);
  ConjugateGradient cg({});
  CHECK(cg.solve(system, *preconditioner, fluid.particles.pressure).cause == "not a number");
}

TEST_CASE("nothing to solve takes no iteration", "[unit][pressure]") {
  Fluid alone = fluid_at({{0, 0, 0}, {5, 5, 0}}, {}, {.spacing = l0});
  mark_surface(alone, real(0.97));
  PressureSystem system(source(PressureSource::density));
  system.assemble(alone, real(1e-3));
  const auto preconditioner = make_jacobi();
  preconditioner->update(system);
  const SolveReport report = ConjugateGradient({}).solve(system, *preconditioner, alone.particles.pressure);
  CHECK(report.converged);
  CHECK(report.iterations == 0);
}

namespace {

// Slope -dp/dy in the middle of a column of water at rest, over rho g, after one predictor and one solve.
double slope_of_column(coord wall_acceleration) {
  const real g = 10, dt = real(1e-3);
  WallFaces walls;
  walls.bodies = {{"tank"}};
  walls.faces = {segment(0, 0, 2, 0), segment(0, 0, 0, 8), segment(2, 8, 2, 0)};
  for (WallFace& face : walls.faces)
    for (WallPoint& corner : face.corner) {
      corner.acceleration = {0, wall_acceleration, 0};
      corner.velocity = {0, wall_acceleration * dt, 0};  // at the end of a step that starts at rest
    }
  Fluid fluid = fluid_at(lattice(20, 60, l0), walls, {.spacing = l0});
  fluid.gravity[1] = -g;
  clear_acceleration(fluid);
  const CoordField x0("greenwater::test_start", fluid.particles.position.extent(0), 2);
  Kokkos::deep_copy(x0, fluid.particles.position);
  predict(fluid, dt);
  Kokkos::deep_copy(fluid.particles.position,
                    x0);  // the equation on the lattice itself: nothing but the source differs
  mark_surface(fluid, real(0.97));
  PressureSystem system(source(PressureSource::divergence));
  system.assemble(fluid, dt);
  const auto preconditioner = make_jacobi();
  preconditioner->update(system);
  REQUIRE(
      ConjugateGradient({.tolerance = real(1e-12)}).solve(system, *preconditioner, fluid.particles.pressure).converged);
  const auto p = by_id(fluid, fluid.particles.pressure);
  const auto at = [&](int row) { return p[row * 20 + 10]; };
  return (at(20) - at(40)) / (20 * l0) / (fluid.rho * g);
}

}  // namespace

TEST_CASE("a still column has slope rho g, one accelerated upwards by g has 2 rho g", "[unit][pressure]") {
  CHECK(slope_of_column(0) == Approx(1).epsilon(1e-3));
  CHECK(slope_of_column(10) == Approx(2).epsilon(1e-3));
}

TEST_CASE("the pressure gradient of a still column in balance is g, down to the floor", "[unit][pressure]") {
  WallFaces walls;
  walls.bodies = {{"tank"}};
  walls.faces = {segment(0, 0, 2, 0), segment(0, 0, 0, 8), segment(2, 8, 2, 0)};
  // Kept weights are floats: half a unit of their last digit is 6e-8.
  for (const auto& [wall_acceleration, kept, precision] :
       {std::tuple{0.0, false, 1e-9}, {10.0, false, 1e-9}, {0.0, true, 6e-8}, {10.0, true, 6e-8}}) {
    for (WallFace& face : walls.faces)
      for (WallPoint& corner : face.corner) corner.acceleration = {0, wall_acceleration, 0};
    Fluid fluid = fluid_at(lattice(20, 30, l0), walls, {.spacing = l0});
    if (!kept) fluid.rows.near.weight = {};
    fluid.gravity[1] = -10;
    const auto x = host(fluid.particles.position);
    const auto p = Kokkos::create_mirror(fluid.particles.pressure);
    for (int i = 0; i < fluid.particles.count; ++i) p(i) = fluid.rho * (10 + wall_acceleration) * (3 - x(i, 1));
    Kokkos::deep_copy(fluid.particles.pressure, p);
    pressure_gradient(fluid);
    const auto a = host(fluid.particles.acceleration);
    for (int i = 0; i < fluid.particles.count; ++i)
      if (x(i, 1) < 3 - 3.1 * l0) {
        CHECK(a(i, 0) == Approx(0).margin(1e-9));
        CHECK(a(i, 1) == Approx(10 + wall_acceleration).epsilon(precision));
      }
  }
}
