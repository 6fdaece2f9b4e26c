// Derivatives by least squares: exact for quadratic fields however particles lie, at walls too; not where they cannot be
// trusted; and a pressure system that is not symmetric, solved.
#include <cmath>

#include "app/scheme.hpp"
#include "core/check.hpp"
#include "kernels/acceleration.hpp"
#include "kernels/biconjugate_gradient.hpp"
#include "kernels/effects/effect.hpp"
#include "kernels/operators/rigid_walls.hpp"
#include "tests/case_text.hpp"
#include "tests/still_water.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord disorder = 0.2;  // x l0

void fit(Fluid& fluid) {
  fit_neighbourhoods(fluid, make_lattice_table(fluid.gradient.weight, fluid.particles.dim, fluid.spacing));
}

// Space filled with particles that lie in disorder, without walls.
Fluid cloud(int dim) {
  const coord radius = dim == 2 ? 3.1 : 2.1;
  Fluid fluid =
      fluid_at(dim == 2 ? lattice(14, 14, l0, 0, 0, disorder) : shaken(9, 9, 9, disorder), {}, standard(dim, radius));
  fit(fluid);
  return fluid;
}

double quadratic(const std::array<coord, 3>& x) {
  return 3 + 2 * x[0] - x[1] + 0.5 * x[2] + 4 * x[0] * x[0] - 2.5 * x[1] * x[1] + x[2] * x[2] + 1.5 * x[0] * x[1] -
         3 * x[1] * x[2];
}
double laplacian_of_quadratic(int dim) { return 8 - 5 + (dim == 3 ? 2 : 0); }
std::array<double, 3> gradient_of_quadratic(const std::array<coord, 3>& x) {
  return {2 + 8 * x[0] + 1.5 * x[1], -1 - 5 * x[1] + 1.5 * x[0] - 3 * x[2], 0.5 + 2 * x[2] - 3 * x[1]};
}

std::array<coord, 3> place(const Fluid& fluid, int i) {
  const auto x = host(fluid.particles.position);
  return {x(i, 0), x(i, 1), fluid.particles.dim == 3 ? x(i, 2) : 0};
}

std::vector<int> fitted(const Fluid& fluid) {
  const auto share = host(fluid.fits.share);
  std::vector<int> list;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (share(i) == 1) list.push_back(i);
  return list;
}

PressureSystem fitted_system(Fluid& fluid, const Survey& found) {
  PressureSystem system({});
  system.assemble(fluid, found.rhs, found.diagonal, found.fixed);
  weigh_rows(fluid, found);
  system.replace_rows(fluid.fits.weight, fluid.fits.diagonal);
  return system;
}

}  // namespace

TEST_CASE("fits are exact for quadratic fields at any disorder", "[unit][high]") {
  for (const int dim : {2, 3}) {
    INFO(dim << "-D");
    Fluid fluid = cloud(dim);
    set_pressure(fluid, quadratic);
    set_velocity(fluid, [](const auto& x) { return std::array<double, 3>{quadratic(x), 0, 2 * quadratic(x)}; });
    Survey found = surveyed(fluid);
    const PressureSystem system = fitted_system(fluid, found);
    const ScalarField Ap("greenwater::test_Ap", fluid.particles.id.extent(0));
    system.apply(fluid.particles.pressure, Ap);
    accelerate(fluid, found, {}, dt);
    const auto product = host(Ap);
    const auto gradient = host(found.velocity_gradient), a = host(fluid.particles.acceleration);
    const auto inside = fitted(fluid);
    CHECK(inside.size() > 20);
    for (const int i : inside) {
      const auto exact = gradient_of_quadratic(place(fluid, i));
      CHECK(product(i) == Approx(-laplacian_of_quadratic(dim)).epsilon(1e-3));  // weights are kept as floats
      for (int d = 0; d < dim; ++d) {
        CHECK(gradient(i, d) == Approx(exact[d]).margin(1e-9));
        CHECK(a(i, d) == Approx(-exact[d] / fluid.rho).margin(1e-12));
      }
      if (dim == 3)
        for (int d = 0; d < 3; ++d) CHECK(gradient(i, 2 * 3 + d) == Approx(2 * exact[d]).margin(1e-9));
    }
  }
}

TEST_CASE("still water solves the fitted rows however particles lie, at walls too", "[unit][high]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, jitter);
    fit(fluid);
    set_pressure(fluid, [&](const auto& x) { return depth_pressure(fluid, x); });
    Survey found = surveyed(fluid);
    const PressureSystem system = fitted_system(fluid, found);
    const ScalarField Ap("greenwater::test_Ap", fluid.particles.id.extent(0));
    system.apply(fluid.particles.pressure, Ap);
    accelerate(fluid, found, {}, dt);
    const auto product = host(Ap), b = host(found.rhs);
    const auto a = host(fluid.particles.acceleration);
    const double scale = system.factor() * fluid.gradient.reference.n0 * fluid.rho * g * l0;
    int beside_walls = 0;
    const auto images = host(fluid.rows.images.number);
    for (const int i : fitted(fluid)) {
      beside_walls += images(i) > 0;
      CHECK(std::fabs(product(i) - b(i)) < 1e-5 * scale);
      for (int d = 0; d < dim; ++d) CHECK(a(i, d) == Approx(d == dim - 1 ? g : 0).margin(1e-9 * g));
    }
    CHECK(beside_walls > 10);
  }
}

TEST_CASE("nobody trusts a fit at the surface, in spray, or of particles in a line", "[unit][high]") {
  Fluid water = tank(2, 3.1, 0);
  fit(water);
  const auto share = host(water.fits.share);
  for (int i = 0; i < water.particles.count; ++i) {
    const coord depth = 1 - place(water, i)[1];
    if (depth < l0) CHECK(share(i) == 0);
    if (depth > 3 * l0) CHECK(share(i) == 1);
  }
  Fluid spray = fluid_at(lattice(3, 1, l0), {}, standard(2, 3.1));
  fit(spray);
  Positions line;
  for (int i = 0; i < 30; ++i) line.push_back({0.11 * l0 * i, 0.01 * l0 * (i % 2), 0});
  Fluid in_line = fluid_at(line, {}, standard(2, 3.1));
  fit(in_line);
  for (const Fluid* fluid : {&spray, &in_line}) {
    const auto of = host(fluid->fits.share);
    const auto a = host(fluid->fits.coefficients);
    for (int i = 0; i < fluid->particles.count; ++i) {
      CHECK(of(i) == 0);
      for (std::size_t k = 0; k < a.extent(1); ++k) CHECK(std::isfinite(a(i, k)));
    }
  }
}

TEST_CASE("with fits too the wall's reaction does the fluid's work", "[unit][high]") {
  SurveyOptions options;
  options.loads = true;
  options.keeps_volume = false;  // what is not linear in the walls' speed
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, jitter);
    fluid.gravity[0] = fluid.gravity[1] = fluid.gravity[2] = 0;
    const std::array<double, 3> v{0.3, -0.2, dim == 3 ? 0.7 : 0};
    for (WallFace& face : fluid.faces.faces)
      for (WallPoint& corner : face.corner)
        for (int d = 0; d < 3; ++d) corner.velocity[d] = v[d];
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), l0);
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
    fit(fluid);
    set_pressure(fluid, [&](const auto& x) { return depth_pressure(fluid, x); });
    const Survey found = surveyed(fluid, options);
    RigidWalls walls;
    walls.watch(0);
    walls.join(fluid, found, found.rhs, dt, SweptVolume::Share::whole);
    // The fluid rests: all divergence is the wall's.
    const auto b = host(found.rhs);
    const auto p = host(fluid.particles.pressure);
    double work = 0;
    for (int i = 0; i < fluid.particles.count; ++i) work += -b(i) * dt / fluid.rho * p(i) * std::pow(l0, dim);
    const auto force = walls.reactions(fluid).front();
    CHECK(force[0] * v[0] + force[1] * v[1] + force[2] * v[2] == Approx(work).epsilon(1e-9));
  }
}

TEST_CASE("biconjugate gradients solve rows that are not symmetric", "[unit][high][pressure]") {
  for (const int dim : {2, 3}) {
    INFO(dim << "-D");
    Fluid fluid = tank(dim, dim == 2 ? 3.1 : 2.1, 0.1);
    fit(fluid);
    set_velocity(fluid, [](const auto& x) { return std::array<double, 3>{x[0] * x[1], -x[1], x[2] * x[0]}; });
    const Survey found = surveyed(fluid);
    const PressureSystem system = fitted_system(fluid, found);
    REQUIRE_FALSE(system.symmetric());
    const int count = fluid.particles.count;
    Eigen::MatrixXd A(count, count);
    Eigen::VectorXd b(count);
    const ScalarField unit("greenwater::test_unit", fluid.particles.id.extent(0)),
        column("greenwater::test_column", fluid.particles.id.extent(0));
    const auto rhs = host(found.rhs);
    for (int j = 0; j < count; ++j) {
      Kokkos::deep_copy(unit, real(0));
      Kokkos::deep_copy(Kokkos::subview(unit, j), real(1));
      system.apply(unit, column);
      const auto values = host(column);
      for (int i = 0; i < count; ++i) A(i, j) = values(i);
      b(j) = rhs(j);
    }
    CHECK((A - A.transpose()).norm() > 0.01 * A.norm());
    const Eigen::VectorXd exact = A.partialPivLu().solve(b);
    const auto jacobi = make_jacobi();
    jacobi->update(system);
    BiconjugateGradient solver(CgOptions{real(1e-11), 0, 2000});
    const SolveReport report = solver.solve(system, *jacobi, fluid.particles.pressure);
    CHECK(report.converged);
    const auto p = host(fluid.particles.pressure);
    for (int i = 0; i < count; ++i) CHECK(p(i) == Approx(exact(i)).margin(1e-7 * exact.cwiseAbs().maxCoeff()));
  }
}

TEST_CASE("the default scheme makes no fits, and knows no edge where space does not repeat itself", "[unit][high]") {
  Effects none;
  for (const bool fits : {false, true}) {
    Fluid fluid = tank(2, 3.1, 0);
    DefaultOptions options;
    options.reference_speed = 1;
    options.fits = fits;
    const auto scheme = make_default(options);
    Ears ears;
    scheme->step(fluid, none, dt);
    CHECK(ears.launched("greenwater::survey"));
    CHECK(fluid.fits.empty() == !fits);
    for (const char* of_fits : {"fit", "bicg", "weigh_rows"}) CHECK(ears.launched(of_fits) == fits);
    CHECK(ears.allocated("fit") == fits);
    CHECK(ears.allocated("bicg") == fits);
    CHECK_FALSE(ears.launched("wrap_positions"));
  }
}

TEST_CASE("a shear wave decays as nu k^2 says, to the fourth order of the spacing with fits",
          "[unit][high][viscosity]") {
  const double k = 2 * M_PI / 2, nu = 1e-3;
  double error[2];
  for (const bool fits : {false, true}) {
    FluidOptions options = standard(2, 3.1);
    options.period = {2, 2, 0};
    Fluid fluid = fluid_at(lattice(20, 20, l0), {}, options);
    set_velocity(fluid, [&](const auto& x) { return std::array<double, 3>{std::sin(k * x[1]), 0, 0}; });
    if (fits) fit(fluid);
    const auto viscosity = make_viscosity({static_cast<real>(nu), true});
    viscosity->apply(fluid, real(1e-9));
    const auto a = host(fluid.particles.acceleration), u = host(fluid.particles.velocity);
    double sum = 0, all = 0;
    for (int i = 0; i < fluid.particles.count; ++i) {
      sum += a(i, 0) * u(i, 0);
      all += u(i, 0) * u(i, 0);
    }
    error[fits] = std::fabs(sum / all / (-nu * k * k) - 1);
  }
  CHECK(error[false] < 0.04);
  CHECK(error[true] < 0.15 * error[false]);
}

TEST_CASE("the scheme high reads the default scheme's table, and refuses weights that are not kept",
          "[unit][high][case]") {
  const auto text = [](const std::string& more) {
    return "format = 1\n[case]\nname = \"h\"\n[time]\nend = 1\n"
           "[[fluid]]\nregion = { type = \"box\", min = [0, 0], max = [1, 1] }\n"
           "[mps]\nscheme = \"high\"\nspacing = 0.1\ntime_step = 1e-3\n" +
           more;
  };
  CHECK(scene_of_text(text("")).mps.parts.smoothing == 0.1);
  CHECK(scene_of_text(text("[mps.default]\nsmoothing = 0.2\n")).mps.parts.smoothing == 0.2);
  CHECK_THROWS_WITH(scene_of_text(text("[mps.pressure]\nweights = \"recomputed\"\n")),
                    Catch::Contains("case.toml:13:11") && Catch::Contains("delete it"));
}
