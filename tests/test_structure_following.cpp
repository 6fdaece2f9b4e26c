// Supports that move as a rigid body, and accelerations of the whole body.

#include <cmath>
#include <numbers>

#include "fem/critical_step.hpp"
#include "fem/march.hpp"
#include "fem/static_solution.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Material rubbery{2.5e6, 0.3, 1200};
const Place about{-0.1, 0.01, 0};  // on the axis of the beam, so that it is not bent

Solid beam(int dim) { return {box_mesh(dim, {0, 0, 0}, {0.4, 0.02, 0.03}, {12, 1, 1}), rubbery}; }

Eigen::Affine3d turned_by(double angle) {
  const Eigen::Vector3d centre(about.data());
  return Eigen::Translation3d(centre) * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
         Eigen::Translation3d(-centre);
}

Vector turned(const SolidMesh& mesh, double angle) {
  return displacement_of(mesh, [angle](const Place& x) {
    const double c = std::cos(angle) - 1, s = std::sin(angle), rx = x[0] - about[0], ry = x[1] - about[1];
    return Place{c * rx - s * ry, s * rx + c * ry, 0};
  });
}

}  // namespace

TEST_CASE("a beam on a wall that turns at constant speed turns with it, whole turns long", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const Solid solid = beam(dim);
    const double omega = 5, turn_time = 2 * std::numbers::pi / omega;
    Supports supports;
    // At rest before the first instant, as a geometry of a case is.
    follow(supports, solid.mesh(), nodes_of_part(solid.mesh(), "left"),
           [omega](double t) { return turned_by(omega * std::max(t, 0.0)); });
    const int steps = static_cast<int>(std::ceil(turn_time / (0.5 * critical_step(solid, supports))));
    // It begins without the stretch that turning gives it, rho omega^2 / E (r L^2 / 2 + L^3 / 3) = 3.5e-4 m, and so swings
    // to twice of that.
    const Vector v = displacement_of(solid.mesh(), [&](const Place& x) {
      return Place{-omega * (x[1] - about[1]), omega * (x[0] - about[0]), 0};
    });
    March march(solid, supports, {}, {.step = turn_time / steps}, {}, v);
    const double first = march.energies().balance();
    for (int quarter = 1; quarter <= 4; ++quarter) {
      march.advance(quarter * steps / 4 - (quarter - 1) * steps / 4);
      const Vector rigid = turned(solid.mesh(), omega * march.time());
      for (const int i : supports.held) CHECK(march.displacement()[i] == Approx(rigid[i]).margin(1e-12));
      CHECK((march.displacement() - rigid).lpNorm<Eigen::Infinity>() < 8e-4);
      CHECK(march.energies().balance() == Approx(first).epsilon(1e-5));
    }
  }
}

TEST_CASE("supports that begin with a velocity have it at once", "[unit][structure]") {
  const Solid solid = beam(2);
  Supports supports;
  follow(supports, solid.mesh(), nodes_of_part(solid.mesh(), "left"),
         [](double t) { return turned_by(t > 0 ? 3 * t + 2 * t * t : 0); });
  const double h = 0.5 * critical_step(solid, supports);
  const March march(solid, supports, {}, {.step = h});
  for (const int node : nodes_of_part(solid.mesh(), "left"))
    CHECK(march.velocity()[2 * node + 1] == Approx((3 - 4 * h / 2) * -about[0]).epsilon(1e-4));
}

TEST_CASE("an even acceleration of the body is its weight; one in a straight line of time is exact",
          "[unit][structure]") {
  const Solid solid = beam(3);
  Loads loads;
  loads.add_acceleration([](double t, Vector& a) {
    for (Eigen::Index i = 0; i < a.size(); i += 3) {
      a[i] = 1;
      a[i + 1] = -2;
      a[i + 2] = 3 + 4 * t;
    }
  });
  CHECK_FALSE(loads.steady());
  loads.prepare(solid, 1, 3);
  Vector f(solid.unknowns());
  for (const double t : {1.0, 1.7, 3.0}) {
    loads.evaluate(solid, t, Vector::Zero(solid.unknowns()), f);
    CHECK((f - gravity_pattern(solid, {1, -2, 3 + 4 * t})).norm() < 1e-14 * f.norm());
  }
  Supports supports;
  clamp(supports, 3, nodes_of_part(solid.mesh(), "left"));
  Loads weight;
  weight.add(gravity_pattern(solid, {1, -2, 3 + 4 * 0.5}));
  const Vector same = solve_static(solid, supports, weight, {.time = 0.5}).u;
  CHECK((solve_static(solid, supports, loads, {.time = 0.5}).u - same).norm() < 1e-10 * same.norm());
}

TEST_CASE("a body thrown about by an acceleration, second order in the length of a call", "[unit][structure]") {
  const Solid solid = beam(2);
  const double h = 0.25 * critical_step(solid, {}), end = 256 * h, rate = 4 / end;
  // As a rigid body: u = (t - sin(rate t) / rate) / rate along both axes.
  Loads loads;
  loads.add_acceleration([rate](double t, Vector& a) { a.setConstant(std::sin(rate * t)); });
  const double exact = (end - std::sin(rate * end) / rate) / rate;
  const auto wrong = [&](int steps_in_a_call) {
    March march(solid, {}, loads, {.step = h});
    for (int step = 0; step < 256; step += steps_in_a_call) march.advance(steps_in_a_call);
    CHECK((march.displacement().array() - march.displacement()[0]).matrix().norm() < 1e-9 * exact);
    return std::abs(march.displacement()[0] - exact);
  };
  const double coarse = wrong(64), middle = wrong(32), fine = wrong(16);
  CHECK(std::log2(coarse / middle) == Approx(2).margin(0.15));
  CHECK(std::log2(middle / fine) == Approx(2).margin(0.15));
  CHECK(fine < 0.01 * exact);
}
