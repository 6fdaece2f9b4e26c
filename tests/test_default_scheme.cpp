// The parts of the default scheme: rows that a still fluid solves to the last digit, gradients that are exact for linear
// fields, smoothing that is blind to smooth flow, and a wall load that does the fluid's work.
#include <cmath>

#include "app/scheme.hpp"
#include "kernels/acceleration.hpp"
#include "kernels/motion.hpp"
#include "kernels/operators/rigid_walls.hpp"
#include "tests/still_water.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// Largest entry of A p - b over those whose place `counts`, over K n0 rho g l0.
template <class F>
double worst_row(const Fluid& fluid, const Survey& found, F counts) {
  PressureSystem system({});
  system.assemble(fluid, found.rhs, found.diagonal, found.fixed);
  const ScalarField Ap("greenwater::test_Ap", fluid.particles.id.extent(0));
  system.apply(fluid.particles.pressure, Ap);
  const auto product = host(Ap), b = host(found.rhs);
  const auto x = host(fluid.particles.position);
  double worst = 0;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (counts(x(i, fluid.particles.dim - 1)))
      worst = std::max(worst, std::fabs(static_cast<double>(product(i) - b(i))));
  return worst / (system.factor() * fluid.gradient.reference.n0 * fluid.rho * g * l0);
}

}  // namespace

TEST_CASE("still water solves the rows to the last digit, from the lattice up to its surface", "[unit][default]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, 0);
    set_pressure(fluid, [&](const auto& x) { return depth_pressure(fluid, x); });
    CHECK(worst_row(fluid, surveyed(fluid), [](coord) { return true; }) < 1e-6);  // weights are kept as floats
  }
}

TEST_CASE("still water solves the rows however particles lie, away from the surface", "[unit][default]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, jitter);
    set_pressure(fluid, [&](const auto& x) { return depth_pressure(fluid, x); });
    const Survey found = surveyed(fluid);
    const coord deep = 1 - 1.2 * radius * l0;
    CHECK(worst_row(fluid, found, [&](coord y) { return y < deep; }) < 1e-5);
    // Near it the level that each particle estimates differs.
    CHECK(worst_row(fluid, found, [](coord) { return true; }) < 0.5);
  }
}

TEST_CASE("the pressure's gradient is exact for a linear pressure, at walls and at the surface", "[unit][default]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, jitter);
    set_pressure(fluid, [&](const auto& x) { return depth_pressure(fluid, x); });
    Survey found = surveyed(fluid);
    accelerate(fluid, found, {}, dt);
    const auto a = host(fluid.particles.acceleration);
    const auto x = host(fluid.particles.position);
    for (int i = 0; i < fluid.particles.count; ++i) {
      const bool below = x(i, dim - 1) < 1 - 1.2 * radius * l0;
      for (int d = 0; d < dim; ++d)
        CHECK(std::fabs(a(i, d) + fluid.gravity[d]) <
              (below ? 1e-5 * g : 0.6 * g));  // what pressure does undoes gravity
    }
  }
}

TEST_CASE("grad u is exact for a linear flow inside", "[unit][default]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid =
        fluid_at(dim == 2 ? lattice(16, 16, l0, 0, 0, jitter) : shaken(12, 12, 12, jitter), {}, standard(dim, radius));
    set_velocity(fluid, [](const auto& x) {
      return std::array<double, 3>{2 * x[0] - 3 * x[1] + x[2], 5 * x[0] + x[1], x[2] - x[0]};
    });
    const double expected[3][3] = {{2, -3, 1}, {5, 1, 0}, {-1, 0, 1}};
    const Survey found = surveyed(fluid);
    const auto gradient = host(found.velocity_gradient);
    const auto s = host(found.surface);
    int inside = 0;
    for (int i = 0; i < fluid.particles.count; ++i) {
      if (s(i) > 0) continue;
      ++inside;
      for (int d = 0; d < dim; ++d)
        for (int e = 0; e < dim; ++e) CHECK(gradient(i, d * dim + e) == Approx(expected[d][e]).margin(1e-5));
    }
    CHECK(inside > fluid.particles.count / 8);
  }
}

TEST_CASE("smoothing leaves linear flow alone and keeps momentum", "[unit][default]") {
  SmoothingOptions smoothing;
  smoothing.speed = 1;
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid =
        fluid_at(dim == 2 ? lattice(14, 14, l0, 0, 0, jitter) : shaken(8, 8, 8, jitter), {}, standard(dim, radius));
    const auto flow = [](const auto& x) { return std::array<double, 3>{2 * x[0] - 3 * x[1], 5 * x[0] + x[1], x[2]}; };
    set_velocity(fluid, flow);
    Survey found = surveyed(fluid);
    accelerate(fluid, found, smoothing, dt);
    const auto s = host(found.surface);
    auto a = host(fluid.particles.acceleration);
    const auto near = entries_of(fluid);
    for (int i = 0; i < fluid.particles.count; ++i) {
      bool inside = s(i) == 0;
      for (const Entry& entry : near[i]) inside = inside && s(entry.j) == 0;
      if (inside)
        for (int d = 0; d < dim; ++d) CHECK(std::fabs(a(i, d)) < 1e-5);
    }

    std::mt19937 generator(3);
    std::uniform_real_distribution<double> any(-1, 1);
    set_velocity(fluid, [&](const auto&) {
      return std::array<double, 3>{any(generator), any(generator), any(generator)};
    });
    found = surveyed(fluid);
    accelerate(fluid, found, smoothing, dt);
    a = host(fluid.particles.acceleration);
    double largest = 0;
    for (int d = 0; d < dim; ++d) {
      double sum = 0;
      for (int i = 0; i < fluid.particles.count; ++i) {
        sum += a(i, d);
        largest = std::max(largest, std::fabs(static_cast<double>(a(i, d))));
      }
      CHECK(std::fabs(sum) < 1e-6 * largest * fluid.particles.count);
    }
    CHECK(largest > 0.1);  // it did something
  }
}

// Water that meets a wall that comes towards it may leave particles on the very wall. The quotient of their speed over the
// distance to their own image has no bound; smoothing once threw a whole neighbourhood off with it.
TEST_CASE("a particle that lies on a wall and runs into it moves nobody faster than itself", "[unit][default]") {
  for (const coord height : {1e-2, 1e-4, 1e-6, 0.0}) {
    INFO("it lies " << height << " l0 above the floor");
    auto x = lattice(12, 10, l0, 0, 0, 0);
    const std::size_t one = 6;
    REQUIRE(x[one][1] == Approx(l0 / 2));
    x[one][1] = height * l0;
    Fluid fluid = fluid_at(x, tank_2d(1.2, 2), standard(2, 3.1));
    set_velocity(fluid, [&](const auto& at) { return std::array<real, 3>{0, at[1] < l0 / 4 ? real(-1) : real(0), 0}; });
    Survey found = surveyed(fluid);
    SmoothingOptions smoothing;
    smoothing.speed = 1;
    // w |du| r / max(r, nearest)^2 / n^0 of the image has w r < r_e and du = 2 m/s; where a stencil is poor it is taken dim
    // times. As much again is left to all the others.
    const double most = 2 * 2 * 3.1 * 2 / (std::pow(nearest_quotient, 2) * fluid.gradient.reference.n0 * l0);
    accelerate(fluid, found, smoothing, dt);
    const auto a = host(fluid.particles.acceleration), gradient = host(found.velocity_gradient);
    for (int i = 0; i < fluid.particles.count; ++i) {
      CHECK(std::hypot(a(i, 0), a(i, 1)) * dt <= 1);
      for (int k = 0; k < 4; ++k) CHECK(std::fabs(gradient(i, k)) <= most);
    }
  }
}

TEST_CASE("the wall's reaction does the fluid's work, and a constant pressure gives p times the area",
          "[unit][default]") {
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
    const double power = force[0] * v[0] + force[1] * v[1] + force[2] * v[2];
    CHECK(power == Approx(work).epsilon(1e-9));
  }
  Fluid fluid = tank(2, 3.1, 0);
  fluid.gravity[1] = 0;
  set_pressure(fluid, [](const auto&) { return 1000; });
  const auto force = wall_reaction(fluid, surveyed(fluid, options), 0);
  CHECK(force[0] == Approx(0).margin(1e-6));
  CHECK(force[1] == Approx(-1000 * 1.2).epsilon(1e-6));  // on the floor
}

TEST_CASE("what pushes a wall is what the wall does to the divergence, place by place", "[unit][default]") {
  SurveyOptions options;
  options.loads = true;
  options.keeps_volume = false;                           // what is not linear in the walls' speed
  const auto speed = [](const std::array<coord, 3>& x) {  // turns and bends each wall in its own way
    return std::array<double, 3>{0.3 + 0.5 * x[1] - x[2], 0.4 * x[0] - 0.2, 0.7 - 0.6 * x[0]};
  };
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    Fluid fluid = tank(dim, radius, jitter);
    for (real& g_d : fluid.gravity) g_d = 0;
    for (WallFace& face : fluid.faces.faces)
      for (int e = 0; e < dim; ++e) face.corner[e].velocity = speed(face.corner[e].position);
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), l0);
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
    const Survey found = surveyed(fluid, options);
    const auto b = host(found.rhs);
    std::vector<double> divergence(fluid.particles.count, 0);
    for (const WallPush& push : wall_pushes(fluid, found, 0))
      divergence[push.particle] += push.area * dot(push.normal, speed(push.place)) / std::pow(l0, dim);
    // The fluid rests: all divergence is the wall's.
    for (int i = 0; i < fluid.particles.count; ++i)
      CHECK(divergence[i] == Approx(-b(i) * dt / fluid.rho).epsilon(1e-9).margin(1e-9));
  }
}

TEST_CASE("drops that nobody is near fly as the law of falling says", "[unit][default]") {
  Fluid fluid = fluid_at({{0, 0, 0}, {3, 0, 0}, {3.05, 0.05, 0}}, {}, standard(2, 3.1));
  fluid.gravity[1] = -g;
  set_velocity(fluid, [](const auto&) { return std::array<double, 3>{1, 2, 0}; });
  Effects none;
  DefaultOptions options;
  options.reference_speed = 1;
  const auto scheme = make_default(options);
  const int steps = 50;
  for (int k = 0; k < steps; ++k) scheme->step(fluid, none, dt);
  const auto u = host(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i) {
    CHECK(u(i, 0) == Approx(1).epsilon(1e-12));
    CHECK(u(i, 1) == Approx(2 - g * steps * dt).epsilon(1e-9));
  }
}

TEST_CASE("the way out of disorder undoes the stiffest one and no more", "[unit][default]") {
  for (const auto& [dim, radius, jitter] : kinds) {
    INFO(dim << "-D, radius " << radius);
    const auto table = make_lattice_table({static_cast<real>(radius * l0), 0}, dim, l0);
    CHECK(table.missing[0] > table.missing[1]);
    CHECK(table.missing[1] >= table.missing[2]);
    SurveyOptions options;
    options.shift_rate = 1;
    options.shift_limit = 1;
    // Rows that stand apart and close in turn along x: short waves are the stiffest.
    const double amplitude = 1e-3 * l0;
    Positions at = dim == 2 ? lattice(20, 20, l0) : shaken(12, 12, 12, 0);
    for (auto& x : at) x[0] += amplitude * (static_cast<int>(x[0] / l0) % 2 == 0 ? 1 : -1);
    const Fluid fluid = fluid_at(at, {}, standard(dim, radius));
    const Survey found = surveyed(fluid, options);
    const auto disorder = host(found.disorder);
    const auto s = host(found.surface);
    const auto x = host(fluid.particles.position);
    double most = 0;
    for (int i = 0; i < fluid.particles.count; ++i) {
      if (s(i) > 0) continue;
      const double off = x(i, 0) / l0 - std::floor(x(i, 0) / l0) - 0.5;
      const double undone = -disorder(i, 0) / (off * l0);
      CHECK(undone > 0);
      most = std::max(most, undone);
    }
    CHECK(most <= 1 + 1e-3);
    CHECK(most > 0.3);
  }
}

TEST_CASE("shifting leaves a lattice alone that a wave has bent", "[unit][default]") {
  const double k = 2 * std::acos(-1.0) / (32 * l0), amplitude = 0.4 * l0;  // at the top
  auto at = lattice(64, 64, l0, -32 * l0, -32 * l0);
  for (auto& x : at) {  // as a standing wave does: free of divergence and of rotation
    const double grown = amplitude * std::exp(k * (x[1] - 32 * l0));
    const auto [cosine, sine] = std::pair(std::cos(k * x[0]), std::sin(k * x[0]));
    x[0] -= grown * sine;
    x[1] += grown * cosine;
  }
  Fluid fluid = fluid_at(at, {}, standard(2, 3.1));
  SurveyOptions options;
  options.shift_rate = 1;
  Survey found = surveyed(fluid, options);
  accelerate(fluid, found, {}, dt);
  const auto disorder = host(found.disorder), shift = host(found.shift);
  const auto x = host(fluid.particles.position);
  double seen = 0, done = 0;
  for (int i = 0; i < fluid.particles.count; ++i) {
    if (std::fabs(x(i, 0)) > 20 * l0 || std::fabs(x(i, 1)) > 20 * l0) continue;  // away from the surface
    for (int d = 0; d < 2; ++d) {
      seen = std::max(seen, std::fabs(static_cast<double>(disorder(i, d))));
      done = std::max(done, std::fabs(static_cast<double>(shift(i, d))));
    }
  }
  CHECK(seen > 1e-5 * l0);
  CHECK(done < 0.1 * seen);
}

TEST_CASE("a default scheme that neither shifts nor keeps apart launches and holds nothing for it", "[unit][default]") {
  Fluid fluid = tank(2, 3.1, 0.1);
  Effects none;
  DefaultOptions options;
  options.reference_speed = 1;
  options.shifting = 0;
  options.separation = 0;
  const Ears ears;
  const auto scheme = make_default(options);
  scheme->step(fluid, none, dt);
  CHECK(ears.launched("survey"));
  CHECK_FALSE(ears.launched("collision"));
  CHECK_FALSE(ears.allocated("collision"));
  CHECK_FALSE(ears.allocated("survey_shift"));
  CHECK_FALSE(ears.allocated("survey_disorder"));
  CHECK_FALSE(ears.allocated("divergence_correction"));
}
