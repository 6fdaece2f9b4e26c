// Structures that deflect far, and order in space.

#include <cmath>
#include <iostream>

#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/march.hpp"
#include "fem/static_solution.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// Tip of a cantilever of length 1 under a dead load, in its lengths: sideways and back (Mattiasson, IJNME 17:145, 1981).
struct Elastica {
  double load;  // P L^2 / E I, or q L^3 / E I
  double sideways, back;
};

constexpr Elastica tip_loads[] = {
    {1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}};
constexpr Elastica even_loads[] = {{1, 0.12347, 0}, {5, 0.49591, 0}, {10, 0.70020, 0}};

constexpr double slenderness = 0.01;

/// Mean displacement of the end.
Vector end_of(const Solid& solid, const Vector& u) {
  Vector mean = Vector::Zero(solid.dim());
  const auto& nodes = nodes_of_part(solid.mesh(), "right");
  for (const int n : nodes) mean += u.segment(solid.dim() * n, solid.dim()) / static_cast<double>(nodes.size());
  return mean;
}

Supports clamped(const Solid& solid) {
  Supports supports;
  clamp(supports, solid.dim(), nodes_of_part(solid.mesh(), "left"));
  return supports;
}

Vector solved(const Solid& solid, const Vector& load, int steps) {
  Loads loads;
  loads.add(load);
  const StaticSolution solution = solve_static(solid, clamped(solid), loads, {.load_steps = steps});
  INFO(solution.cause << ' ' << solution.residual);
  CHECK(solution.converged);
  return solution.u;
}

/// Along x, 50 x 1 elements, E I = 1 for a width of 1 (2-D) or of 0.02 (3-D).
Solid slender(int dim, Kinematics kinematics) {
  const double width = dim == 2 ? 1 : 0.02, young = 12 / (std::pow(slenderness, 3) * width);
  return {box_mesh(dim, {0, 0, 0}, {1, slenderness, width}, {50, 1, 1}),
          {young, 0, 1},
          {.kinematics = kinematics, .plane = Plane::stress}};
}

}  // namespace

TEST_CASE("elastica: a tip load", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    for (const Kinematics kinematics : {Kinematics::corotational, Kinematics::total_lagrangian}) {
      if (dim == 3 && kinematics == Kinematics::total_lagrangian) continue;  // as in 2-D, and slow
      const Solid solid = slender(dim, kinematics);
      const double area = slenderness * (dim == 2 ? 1 : 0.02);
      for (const Elastica& exact : tip_loads) {
        const Vector load = traction_pattern(solid, find_part(solid.mesh(), "right")->facets, [&](const Place&) {
          return Place{0, exact.load / area, 0};
        });
        const Vector end = end_of(solid, solved(solid, load, 4));
        std::cout << "  elastica " << dim << "-D, load " << exact.load << ": " << end[1] / exact.sideways << ' '
                  << -end[0] / exact.back << '\n';
        CHECK(end[1] == Approx(exact.sideways).epsilon(0.01));
        CHECK(-end[0] == Approx(exact.back).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("elastica: an even load", "[unit][structure]") {
  for (const Kinematics kinematics : {Kinematics::corotational, Kinematics::total_lagrangian}) {
    const Solid solid = slender(2, kinematics);
    for (const Elastica& exact : even_loads) {
      // As weight: on a face its lever would be half a height off.
      const Vector load = gravity_pattern(solid, {0, exact.load / slenderness, 0});
      const double end = end_of(solid, solved(solid, load, 4))[1];
      std::cout << "  elastica, even load " << exact.load << ": " << end / exact.sideways << '\n';
      CHECK(end == Approx(exact.sideways).epsilon(0.01));
    }
  }
}

TEST_CASE("pressure that follows its facets", "[unit][structure]") {
  // Pressure on a closed outline has no sum, however it is deformed.
  const Solid solid = slender(2, Kinematics::corotational);
  Loads loads;
  loads.add_follower(outer_facets(solid.mesh()), [](double t) { return 3 * t; });
  Vector f(solid.unknowns());
  loads.evaluate(solid, 2, random_vector(solid.unknowns(), 0.004), f);
  double sum[2] = {};
  for (int i = 0; i < solid.unknowns(); ++i) sum[i % 2] += f[i];
  CHECK(f.norm() > 1e-2);
  CHECK(std::abs(sum[0]) < 1e-14);
  CHECK(std::abs(sum[1]) < 1e-14);

  // A follower on one face of a cantilever bends it further than a dead load of the same size, whose lever shortens.
  Loads dead, follower;
  const auto& bottom = find_part(solid.mesh(), "bottom")->facets;
  dead.add(pressure_pattern(solid, bottom, [](const Place&) { return 4.0; }));
  follower.add_follower(bottom, [](double) { return 4.0; });
  const auto end = [&](const Loads& loads) {
    const StaticSolution solution =
        solve_static(solid, clamped(solid), loads, {.load_steps = 8, .max_iterations = 200, .tolerance = 1e-8});
    CHECK(solution.converged);
    return end_of(solid, solution.u);
  };
  const Vector by_dead = end(dead), by_follower = end(follower);
  CHECK(by_follower[0] < by_dead[0] - 0.01);
}

TEST_CASE("bar behind a cylinder under its weight (CSM1)", "[unit][structure]") {
  // Turek and Hron 2006: the clamped end lies on the cylinder of radius 0.05 round (0.2, 0.2).
  SolidMesh mesh = box_mesh(2, {0, 0.19, 0}, {1, 0.21, 0}, {70, 4, 1});
  for (auto& x : mesh.nodes) {
    const double left = 0.2 + std::sqrt(0.05 * 0.05 - (x[1] - 0.2) * (x[1] - 0.2));
    x[0] = left + x[0] * (0.6 - left);
  }
  for (const Kinematics kinematics : {Kinematics::corotational, Kinematics::total_lagrangian}) {
    const Solid solid(mesh, {1.4e6, 0.4, 1000}, {.kinematics = kinematics});
    const Vector u = solved(solid, gravity_pattern(solid, {0, -2, 0}), 2);
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      if (std::hypot(mesh.nodes[n][0] - 0.6, mesh.nodes[n][1] - 0.2) > 1e-9) continue;
      std::cout << "  CSM1: " << u[2 * n] << ' ' << u[2 * n + 1] << '\n';
      CHECK(u[2 * n] == Approx(-7.187e-3).epsilon(0.01));
      CHECK(u[2 * n + 1] == Approx(-66.10e-3).epsilon(0.01));
    }
  }
}

TEST_CASE("a march with damping comes to rest at the static solution", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0, 0}, {0.5, 0.05, 0}, {12, 1, 1}), {1.4e6, 0.4, 1000},
                    {.kinematics = Kinematics::total_lagrangian});
  const Vector weight = gravity_pattern(solid, {0, -4, 0});
  Loads loads;
  loads.add(weight);
  March march(solid, clamped(solid), loads, {.step = 0.7 * critical_step(solid, clamped(solid)), .damping = 15});
  march.advance(20000);
  const Vector rest = solved(solid, weight, 2);
  CHECK(rest.lpNorm<Eigen::Infinity>() > 0.05);
  CHECK((march.displacement() - rest).norm() < 1e-6 * rest.norm());
}

TEST_CASE("nearly incompressible material does not lock with mean dilatation", "[unit][structure]") {
  // A block squeezed between plates that hold its sides, nu = 0.4999, four layers; a fine mesh of incompatible elements.
  const auto sink = [](ElementKind kind, Kinematics kinematics, int refined) {
    const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {1, 0.5, 0}, {8 * refined, 4 * refined, 1});
    const Solid solid(mesh, {1e6, 0.4999, 1000}, {.element = kind, .kinematics = kinematics});
    Supports supports;
    clamp(supports, 2, nodes_of_part(mesh, "bottom"));
    hold(supports, 2, nodes_of_part(mesh, "left"), 0);
    Loads loads;
    loads.add(
        pressure_pattern(solid, find_part(mesh, "top")->facets, [](const Place& x) { return x[0] < 0.5 ? 5e3 : 0; }));
    const StaticSolution solution = solve_static(solid, supports, loads);
    CHECK(solution.converged);
    return -solution.u[2 * nodes_of_part(mesh, "top").front() + 1];
  };
  const double exact = sink(ElementKind::incompatible, Kinematics::small, 4);
  CHECK(sink(ElementKind::mean_dilatation, Kinematics::small, 1) == Approx(exact).epsilon(0.05));
  CHECK(sink(ElementKind::mean_dilatation, Kinematics::total_lagrangian, 1) == Approx(exact).epsilon(0.08));
  CHECK(sink(ElementKind::full, Kinematics::small, 1) < 0.5 * exact);
}

TEST_CASE("space is second order: a cantilever against Timoshenko and Goodier", "[unit][structure]") {
  // Plane stress, unit load at the end spread as the solution has it, its displacement at the foot.
  const double length = 4, height = 1, young = 1000, poisson = 0.3, inertia = 1.0 / 12;
  const auto exact = [&](const Place& at) {
    const double x = at[0], y = at[1] - height / 2, c = 1 / (6 * young * inertia);
    return Place{-c * y * ((6 * length - 3 * x) * x + (2 + poisson) * (y * y - height * height / 4)),
                 c * (3 * poisson * y * y * (length - x) + (4 + 5 * poisson) * height * height * x / 4 +
                      (3 * length - x) * x * x),
                 0};
  };
  for (const ElementKind kind : {ElementKind::full, ElementKind::incompatible}) {
    double error[3];
    for (int level = 0; level < 3; ++level) {
      const int n = 4 << level;
      const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {length, height, 0}, {2 * n, n, 1});
      const Solid solid(mesh, {young, poisson, 1}, {kind, Kinematics::small, Plane::stress});
      Supports supports;
      for (const int node : nodes_of_part(mesh, "left"))
        for (int axis = 0; axis < 2; ++axis)
          move(supports, 2, {node}, axis, [at = exact(mesh.nodes[node])[axis]](double) { return at; });
      Loads loads;
      loads.add(traction_pattern(solid, find_part(mesh, "right")->facets, [&](const Place& x) {
        const double y = x[1] - height / 2;
        return Place{0, (height * height / 4 - y * y) / (2 * inertia), 0};
      }));
      const StaticSolution solution = solve_static(solid, supports, loads);
      CHECK(solution.converged);
      const Vector u = displacement_of(mesh, exact);
      error[level] = (solution.u - u).norm() / u.norm();
    }
    std::cout << "  space, error: " << error[0] << ' ' << error[1] << ' ' << error[2] << '\n';
    CHECK(std::log2(error[0] / error[1]) > 1.8);
    CHECK(std::log2(error[1] / error[2]) > 1.9);
  }
}

TEST_CASE("a structure that nothing holds is said, not guessed", "[unit][structure]") {
  const Solid solid = slender(2, Kinematics::corotational);
  Loads loads;
  loads.add(nodal_pattern(solid, 3, {0, 1, 0}));
  const StaticSolution solution = solve_static(solid, {}, loads);
  CHECK(!solution.converged);
  CHECK_THAT(solution.cause, Catch::Contains("hold the structure"));
}
