// What is not asked for is not there; what is asked for does what it says.
#include <cmath>

#include "app/scheme.hpp"
#include "kernels/motion.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;

WallFaces tank() {
  WallFaces walls;
  walls.bodies = {{"tank"}};
  walls.faces = {segment(0, 0, 2, 0), segment(0, 0, 0, 3), segment(2, 3, 2, 0)};
  return walls;
}

Fluid water() {
  Fluid fluid = fluid_at(lattice(20, 10, l0, 0, 0, 0.02), tank(), {.spacing = l0});
  fluid.gravity[1] = -10;
  return fluid;
}

ClassicOptions classic() {
  ClassicOptions options;
  options.pressure.diagonal_factor = real(1.05);
  return options;
}

bool ours_or_a_library(const std::string& label) {
  // Kokkos Kernels and Kokkos itself name their own.
  return label.rfind("greenwater::", 0) == 0 || label.rfind("KokkosBlas::", 0) == 0 || label.rfind("Kokkos::", 0) == 0;
}

void set_velocity(Fluid& fluid, const std::function<std::array<double, 2>(double, double)>& field) {
  const auto x = host(fluid.particles.position);
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i) {
    const auto value = field(x(i, 0), x(i, 1));
    u(i, 0) = static_cast<real>(value[0]);
    u(i, 1) = static_cast<real>(value[1]);
  }
  Kokkos::deep_copy(fluid.particles.velocity, u);
}

ForceField constant_force(double x, double y) {
  return [x, y](const auto&, const auto&, double) { return std::array<double, 3>{x, y, 0}; };
}

double kinetic_energy(const Fluid& fluid) {
  const auto u = host(fluid.particles.velocity);
  double sum = 0;
  for (int i = 0; i < fluid.particles.count; ++i) sum += (u(i, 0) * u(i, 0) + u(i, 1) * u(i, 1)) / 2;
  return sum;
}

}  // namespace

TEST_CASE("an absent effect launches nothing and holds nothing", "[unit][effects]") {
  const auto scheme = make_classic(classic());
  Effects none;
  Fluid fluid = water();
  Ears ears;
  for (int k = 0; k < 3; ++k) scheme->step(fluid, none, real(1e-3));
  REQUIRE(ears.launched("greenwater::predict"));
  for (const char* absent : {"viscosity", "collision", "body_force"}) {
    CHECK_FALSE(ears.launched(absent));
    CHECK_FALSE(ears.allocated(absent));
  }
}

TEST_CASE("a scene without walls makes no images", "[unit][effects]") {
  const auto scheme = make_classic(classic());
  Effects none;
  Ears ears;
  Fluid fluid = fluid_at(lattice(10, 10, l0), {}, {.spacing = l0});
  scheme->step(fluid, none, real(1e-3));
  CHECK_FALSE(ears.launched("image"));
  CHECK_FALSE(ears.allocated("image"));
  CHECK_FALSE(ears.allocated("greenwater::mirror"));
}

TEST_CASE("every launch and allocation has a name of ours", "[unit][effects]") {
  Ears ears;
  const auto scheme = make_classic(classic());
  Effects effects;
  effects.add(make_viscosity({real(1e-6)}));
  effects.add(make_collision({}));
  effects.add(make_body_force(constant_force(1, 0)));
  Fluid fluid = water();
  effects.prepare(fluid);
  for (int k = 0; k < 2; ++k) scheme->step(fluid, effects, real(1e-3));
  REQUIRE(ears.launched("greenwater::viscosity"));
  REQUIRE(ears.launched("greenwater::body_force"));
  for (const auto& label : ears.launches) {
    INFO(label);
    CHECK(ours_or_a_library(label));
  }
  for (const auto& label : ears.allocations) {
    INFO(label);
    CHECK(ours_or_a_library(label));
  }
}

TEST_CASE("a steady step allocates nothing", "[unit][effects]") {
  const auto scheme = make_classic(classic());
  Effects effects;
  effects.add(make_viscosity({real(1e-6)}));
  effects.add(make_collision({}));
  effects.add(make_body_force(constant_force(0.1, 0)));
  Fluid fluid = water();
  effects.prepare(fluid);
  for (int k = 0; k < 5; ++k) scheme->step(fluid, effects, real(1e-3));
  Ears ears;
  for (int k = 0; k < 5; ++k) scheme->step(fluid, effects, real(1e-3));
  CHECK(ears.allocations == std::vector<std::string>{});
}

TEST_CASE("what an effect holds of the fluid is there before the first step, and no step adds to it",
          "[unit][effects]") {
  Effects effects;
  effects.add(make_viscosity({real(1e-6)}));
  effects.add(make_collision({}));
  effects.add(make_body_force(constant_force(0.1, 0)));
  effects.add(make_wall_speeds([](WallFaces&, double) {}));
  effects.add(make_moving_walls([](WallFaces&, double) {}));
  Fluid fluid = water();
  effects.prepare(fluid);
  const std::size_t held = fluid.particles.extras.size();
  REQUIRE(held == 1);
  REQUIRE(fluid.body_force == 0);
  const auto scheme = make_classic(classic());
  for (int k = 0; k < 3; ++k) scheme->step(fluid, effects, real(1e-3));
  CHECK(fluid.particles.extras.size() == held);
  effects.prepare(fluid);  // again is the same
  CHECK(fluid.particles.extras.size() == held);
}

TEST_CASE("viscosity slows a shear wave as it should", "[unit][effects]") {
  // u = (sin(k y), 0) between slipping walls at y = 0 and y = 2, where cos fits: u' = -nu k^2 u.
  WallFaces walls;
  walls.bodies = {{"channel"}};
  walls.faces = {segment(-1, 0, 5, 0), segment(-1, 2, 5, 2)};
  Fluid fluid = fluid_at(lattice(80, 40, 0.05), walls, {.spacing = 0.05});
  const double k = M_PI / 2, nu = 0.1;
  set_velocity(fluid, [&](double, double y) { return std::array<double, 2>{std::cos(k * y), 0}; });
  clear_acceleration(fluid);
  make_viscosity({static_cast<real>(nu)})->apply(fluid, 1);
  const auto x = host(fluid.particles.position);
  const auto a = host(fluid.particles.acceleration);
  int looked_at = 0;
  for (int i = 0; i < fluid.particles.count; ++i) {
    if (x(i, 0) < 0.5 || x(i, 0) > 3.5) continue;
    ++looked_at;
    CHECK(a(i, 0) == Approx(-nu * k * k * std::cos(k * x(i, 1))).epsilon(0.01).margin(1e-4));
    CHECK(a(i, 1) == Approx(0).margin(1e-12));
  }
  CHECK(looked_at > 1000);
}

TEST_CASE("a collision keeps momentum and never makes energy", "[unit][effects]") {
  Fluid fluid = fluid_at(lattice(15, 15, l0, 0, 0, 0.45), {}, {.spacing = l0});
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> any(-1, 1);
  set_velocity(fluid, [&](double, double) { return std::array<double, 2>{any(generator), any(generator)}; });
  const auto momentum = [&] {
    const auto u = host(fluid.particles.velocity);
    std::array<double, 2> sum{};
    for (int i = 0; i < fluid.particles.count; ++i)
      for (int d = 0; d < 2; ++d) sum[d] += u(i, d);
    return sum;
  };
  for (const real restitution : {real(0), real(0.2), real(1)}) {
    const double before = kinetic_energy(fluid);
    const auto start = momentum();
    make_collision({.distance = real(0.85), .restitution = restitution})->apply(fluid, real(1e-3));
    CHECK(kinetic_energy(fluid) <= before * (1 + 1e-12));
    CHECK(momentum()[0] == Approx(start[0]).margin(1e-10));
    CHECK(momentum()[1] == Approx(start[1]).margin(1e-10));
  }
}

TEST_CASE("two particles bounce with their restitution, and one off a wall", "[unit][effects]") {
  Fluid pair = fluid_at({{0, 0, 0}, {0.05, 0, 0}}, {}, {.spacing = l0});
  set_velocity(pair, [](double x, double) { return std::array<double, 2>{x < 0.02 ? 1.0 : -1.0, 0.5}; });
  make_collision({.distance = real(0.85), .restitution = real(0.2), .sweeps = 1})->apply(pair, real(1e-3));
  const auto u = host(pair.particles.velocity);
  for (int i = 0; i < 2; ++i) {
    CHECK(std::fabs(u(i, 0)) == Approx(0.2));
    CHECK(u(i, 1) == Approx(0.5));
  }
  WallFaces wall;
  wall.bodies = {{"floor"}};
  wall.faces = {segment(-1, 0, 1, 0)};
  Fluid one = fluid_at({{0, 0.02, 0}}, wall, {.spacing = l0});
  set_velocity(one, [](double, double) { return std::array<double, 2>{0.3, -1}; });
  make_collision({.distance = real(0.85), .restitution = real(0.2)})->apply(one, real(1e-3));
  CHECK(host(one.particles.velocity)(0, 0) == Approx(0.3));
  CHECK(host(one.particles.velocity)(0, 1) == Approx(0.2));
}

TEST_CASE("a body force drives particles and the images' pressure alike", "[unit][effects]") {
  // Gravity given as a body force balances the same column as gravity itself.
  Fluid fluid = fluid_at(lattice(20, 30, l0), tank(), {.spacing = l0});
  clear_acceleration(fluid);
  const auto force = make_body_force(constant_force(0, -10));
  force->prepare(fluid);
  force->apply(fluid, real(1e-3));
  CHECK(host(fluid.particles.acceleration)(100, 1) == Approx(-10));
  const auto x = host(fluid.particles.position);
  const auto p = Kokkos::create_mirror(fluid.particles.pressure);
  for (int i = 0; i < fluid.particles.count; ++i) p(i) = fluid.rho * 10 * (3 - x(i, 1));
  Kokkos::deep_copy(fluid.particles.pressure, p);
  fluid.rows.near.weight = {};  // those that are kept have seven digits only
  pressure_gradient(fluid);
  const auto a = host(fluid.particles.acceleration);
  for (int i = 0; i < fluid.particles.count; ++i)
    if (x(i, 1) < 2.5) CHECK(a(i, 1) == Approx(10).epsilon(1e-9));
}

TEST_CASE("a particle that flies into a wall is counted and stopped", "[unit][effects]") {
  for (const double speed : {40.0, 1e3, 1e6}) {  // less than a cell a step, more, and absurdly more
    Fluid fluid = fluid_at({{1, 0.5, 0}, {0.03, 0.04, 0}}, tank(), {.spacing = l0});
    set_velocity(fluid, [&](double x, double) {
      return x > 0.5 ? std::array<double, 2>{1, -speed} : std::array<double, 2>{-speed, -speed};
    });
    clear_acceleration(fluid);
    CHECK(predict(fluid, real(1e-2)) == (speed > 40 ? 2 : 1));
    const auto x = host(fluid.particles.position);
    for (int i = 0; i < 2; ++i) {
      CHECK(x(i, 0) > 0);
      CHECK(x(i, 1) > 0);
    }
  }
}
