// The multigrid: what it is made of against dense matrices, how fast it is, and what happens where it should fail.
#include <cmath>

#include "kernels/refined_cg.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;

PressureSystem assembled(const Fluid& fluid, real dt = real(1e-3), real compressibility = real(4.5e-10)) {
  PressureOptions options;
  options.compressibility = compressibility;
  PressureSystem system(options);
  system.assemble(fluid, dt);
  return system;
}

// A column in the left part of a tank.
Fluid column(int nx, int ny, coord jitter, unsigned seed = 1) {
  WallFaces walls = walls_of({segment(0, 0, 3 * nx * l0, 0), segment(0, 0, 0, 2 * ny * l0),
                              segment(3 * nx * l0, 2 * ny * l0, 3 * nx * l0, 0)});
  Fluid fluid = fluid_at(lattice(nx, ny, l0, 0, 0, jitter, seed), walls, {.spacing = l0});
  mark_surface(fluid, real(0.97));
  return fluid;
}

Eigen::MatrixXd preconditioner(Multigrid& multigrid, const Fluid& fluid) {
  const int n = fluid.particles.count;
  const auto surface = host(fluid.particles.surface);
  FloatField r("greenwater::test_unit", padded(n) + 16), z("greenwater::test_product", padded(n) + 16);
  Eigen::MatrixXd M(n, n);
  for (int j = 0; j < n; ++j) {
    const auto unit = Kokkos::create_mirror(r);
    unit(j) = surface(j) ? 0 : 1;
    Kokkos::deep_copy(r, unit);
    multigrid.apply(r, z);
    const auto column = host(z);
    for (int i = 0; i < n; ++i) M(i, j) = column(i);
  }
  return M;
}

}  // namespace

TEST_CASE("the multigrid is symmetric and near the inverse", "[unit][multigrid]") {
  Fluid fluid = column(20, 25, 0.2);
  const PressureSystem system = assembled(fluid);
  Multigrid multigrid;
  multigrid.update(system);
  const Eigen::MatrixXd M = preconditioner(multigrid, fluid);
  CHECK((M - M.transpose()).cwiseAbs().maxCoeff() <= 1e-6 * M.cwiseAbs().maxCoeff());
  const auto surface = host(fluid.particles.surface);
  std::vector<int> active;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (!surface(i)) active.push_back(i);
  const Eigen::MatrixXd A = dense(system) / system.factor();
  const Eigen::MatrixXd MA = (M * A)(active, active);
  const Eigen::VectorXd values = MA.eigenvalues().real();
  UNSCOPED_INFO(active.size() << " active, eigenvalues of M A " << values.minCoeff() << " ... " << values.maxCoeff());
  CHECK(values.minCoeff() > 0.7);
  CHECK(values.maxCoeff() < 1.3);
  std::printf("%zu active of %d, eigenvalues of M A %g ... %g\n", active.size(), fluid.particles.count,
              values.minCoeff(), values.maxCoeff());
}
