// Structures in time: steps, energies, damping, held loads.

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/held_load_answer.hpp"
#include "fem/march.hpp"
#include "fem/modes.hpp"
#include "tests/beams.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double pi = std::numbers::pi;
const Material rubbery{2.5e6, 0.3, 1200};

/// A cantilever of 4 x 1 elements, or 4 x 1 x 1.
Solid block(int dim, const SolidOptions& options = {}) {
  return {box_mesh(dim, {0, 0, 0}, {0.4, 0.1, 0.1}, {4, 1, 1}), rubbery, options};
}

Supports clamped(const Solid& solid) {
  Supports supports;
  clamp(supports, solid.dim(), nodes_of_part(solid.mesh(), "left"));
  return supports;
}

/// All modes of the free unknowns: omega [rad/s] and shapes.
struct AllModes {
  Vector omega;
  Eigen::MatrixXd shapes;
};

AllModes all_modes(const Solid& solid, const Supports& supports) {
  const std::vector<int> free = free_unknowns(supports, solid.unknowns());
  const Eigen::MatrixXd k = Eigen::MatrixXd(solid.tangent(Vector::Zero(solid.unknowns())))(free, free);
  const Eigen::MatrixXd m = Vector(solid.mass()(free)).asDiagonal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(k, m);
  AllModes all{modes.eigenvalues().cwiseMax(0).cwiseSqrt(), Eigen::MatrixXd::Zero(solid.unknowns(), free.size())};
  all.shapes(free, Eigen::all) = modes.eigenvectors();
  return all;
}

double change_of_balance(March& march, int steps, int calls, double& swing) {
  const double first = march.energies().balance();
  double worst = 0;
  for (int call = 0; call < calls; ++call) {
    march.advance(steps);
    worst = std::max(worst, std::abs(march.energies().balance() - first));
    swing = std::max(swing, march.displacement().lpNorm<Eigen::Infinity>());
  }
  return worst;
}

}  // namespace

TEST_CASE("the critical step is 2 / omega_max", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    for (const Kinematics kinematics : all_kinematics) {
      const Solid solid = block(dim, {.kinematics = kinematics});
      const double exact = all_modes(solid, clamped(solid)).omega.maxCoeff();
      const double found = highest_frequency(solid, clamped(solid));
      CHECK(found >= exact * (1 - 1e-6));
      CHECK(found <= exact * (1 + 1e-3));
    }
  }
  const Plate paper = polycarbonate(0.003, Sides::free, {.element = ElementKind::full});
  CHECK(critical_step(paper.solid, paper.supports) == Approx(4.44e-7).epsilon(2e-3));
  Supports everything;
  const Solid solid = block(2);
  for (int i = 0; i < solid.unknowns(); ++i) everything.held.push_back(i);
  CHECK(std::isinf(critical_step(solid, everything)));
}

TEST_CASE("a step above the critical one is refused and the limit named", "[unit][structure]") {
  const Solid solid = block(2);
  const double limit = critical_step(solid, clamped(solid));
  CHECK_NOTHROW(March(solid, clamped(solid), {}, {.step = 0.99 * limit}));
  CHECK_THROWS_WITH(March(solid, clamped(solid), {}, {.step = 1.01 * limit}), Catch::Contains("2/omega_max"));
  CHECK_THROWS_AS(March(solid, clamped(solid), {}, {.step = 0}), CaseError);
  CHECK_THROWS_WITH(March(solid, clamped(solid), {}, {.step = limit / 2, .damping = -1}), Catch::Contains("damping"));
}

TEST_CASE("discrete energy of free vibration: to round-off when linear, to 1e-4 else", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    for (const ElementKind kind : all_kinds) {
      for (const Kinematics kinematics : all_kinematics) {
        const bool small = kinematics == Kinematics::small;
        const Solid solid(box_mesh(dim, {0, 0, 0}, {0.4, 0.02, 0.03}, {12, 1, 1}), rubbery,
                          {.element = kind, .kinematics = kinematics});
        const double step = 0.5 * critical_step(solid, clamped(solid));
        // The tip swings by a third of the length.
        const Vector v = displacement_of(solid.mesh(), [](const Place& x) { return Place{0, 14 * x[0] * x[0], x[0]}; });
        March march(solid, clamped(solid), {}, {.step = step}, {}, v);
        const double all = march.energies().balance();
        double swing = 0;
        const double change = change_of_balance(march, 100, 100, swing);
        CHECK(change < (small ? 1e-10 : 1e-4) * all);
        CHECK(swing > 0.1);
      }
    }
  }
}

TEST_CASE("energy with loads, damping and moving supports", "[unit][structure]") {
  const Solid solid = block(2, {.kinematics = Kinematics::small});
  Supports supports = clamped(solid);
  move(supports, 2, nodes_of_part(solid.mesh(), "left"), 1, [](double t) { return 0.01 * std::sin(60 * t); });
  Loads loads;
  loads.add(gravity_pattern(solid, {0, -9.8, 0}));
  loads.add(nodal_pattern(solid, 9, {0, 3, 0}), [](double t) { return std::cos(40 * t); });
  const double step = 0.3 * critical_step(solid, supports);
  March march(solid, supports, loads, {.step = step, .damping = 30});
  march.advance(5, nodal_pattern(solid, 4, {0, 1, 0}));
  double swing = 0;
  CHECK(change_of_balance(march, 50, 50, swing) < 1e-11 * (march.energies().lost + march.energies().kinetic));
  CHECK(march.energies().lost > 0);
  CHECK(march.time() == Approx(2505 * step));
  CHECK(march.displacement()[1] == Approx(0.01 * std::sin(60 * march.time())));
}

TEST_CASE("damping: one mode decays at the exact rate of the recurrence", "[unit][structure]") {
  const Plate plate = polycarbonate(0.003, Sides::held, {.kinematics = Kinematics::small});
  const Modes modes = lowest_modes(plate.solid, plate.supports, 1);
  const double alpha = 426, omega = 2 * pi * modes.frequencies[0], h = 4e-7;
  March march(plate.solid, plate.supports, {}, {.step = h, .damping = alpha}, 1e-4 * modes.shapes.col(0));
  const Vector weights = plate.solid.mass().cwiseProduct(modes.shapes.col(0));
  // u = e^(-alpha t / 2) (cos w t + alpha / (2 w) sin w t), w^2 = omega^2 - alpha^2 / 4; second order in h.
  const double w = std::sqrt(omega * omega - alpha * alpha / 4);
  for (int call = 0; call < 10; ++call) {
    march.advance(2000);
    const double t = march.time();
    const double exact = std::exp(-alpha * t / 2) * (std::cos(w * t) + alpha / (2 * w) * std::sin(w * t));
    CHECK(weights.dot(march.displacement()) == Approx(1e-4 * exact).margin(1e-4 * 1e-6));
  }
  CHECK(damping_of(0.414, 81.93) == Approx(426).epsilon(1e-3));
}

TEST_CASE("time is second order", "[unit][structure]") {
  const Solid solid = block(2, {.kinematics = Kinematics::corotational});
  const double step = 0.8 * critical_step(solid, clamped(solid));
  const Vector v = displacement_of(solid.mesh(), [](const Place& x) { return Place{0, 30 * x[0] * x[0], 0}; });
  Loads loads;
  loads.add(nodal_pattern(solid, 9, {0, 20, 0}), [](double t) { return 1 + std::sin(300 * t); });
  const auto place = [&](int refined) {
    March march(solid, clamped(solid), loads, {.step = step / refined, .damping = 50}, {}, v);
    march.advance(40 * refined);
    return march.displacement();
  };
  const Vector exact = place(64);
  const double coarse = (place(2) - exact).norm(), middle = (place(4) - exact).norm(), fine = (place(8) - exact).norm();
  CHECK(std::log2(coarse / middle) == Approx(2).margin(0.15));
  CHECK(std::log2(middle / fine) == Approx(2).margin(0.15));
}

TEST_CASE("reactions hold the weight, and what is thrown keeps its momentum", "[unit][structure]") {
  const Solid solid = block(3);
  Loads loads;
  loads.add(gravity_pattern(solid, {0, 0, -9.8}));
  const double step = 0.5 * critical_step(solid, clamped(solid));
  March resting(solid, clamped(solid), loads, {.step = step, .damping = 200});
  resting.advance(20000);
  double sum = 0;
  for (int i = 2; i < solid.unknowns(); i += 3) sum += resting.reaction()[i];
  CHECK(sum == Approx(9.8 * solid.mass().sum() / 3).epsilon(1e-4));

  // Free in space, with a spin: the momentum stays, the centre goes straight on.
  const Vector v = displacement_of(solid.mesh(), [](const Place& x) { return Place{1 - 200 * x[1], 200 * x[0], 2}; });
  March flying(solid, {}, {}, {.step = step}, {}, v);
  const auto momentum = [&] { return solid.mass().dot(flying.velocity().cwiseProduct(Vector::Ones(v.size()))); };
  const double before = momentum();
  flying.advance(5000);
  CHECK(momentum() == Approx(before).epsilon(1e-10));
}

TEST_CASE("the answer of a held load is that of the steps, and never against it", "[unit][structure]") {
  const Solid solid = block(2);
  const Supports supports = clamped(solid);
  const AllModes modes = all_modes(solid, supports);
  const double h = 1.9 / modes.omega.maxCoeff();
  const Eigen::MatrixXd loads = solid.mass().asDiagonal() * modes.shapes;
  for (const int n : {1, 2, 3, 7, 46}) {
    const Eigen::MatrixXd a = held_load_answer(solid, supports, loads.sparseView(), {.step = h}, n);
    CHECK((a - a.transpose()).norm() == 0);
    for (int j = 0; j < a.cols(); ++j) {
      const double omega = modes.omega[j], theta = 2 * std::asin(omega * h / 2);
      const double exact = (1 - std::cos(n * theta)) / (omega * omega);
      CHECK(a(j, j) >= -1e-14 * a.norm());
      CHECK(a(j, j) == Approx(exact).margin(1e-11 * a.norm()));
      for (int i = 0; i < j; ++i) CHECK(std::abs(a(i, j)) < 1e-11 * a.norm());
    }
  }
}

TEST_CASE("the answer of a held load with damping, against marches of linear and other bodies", "[unit][structure]") {
  const Solid solid = block(3);
  const Supports supports = clamped(solid);
  const MarchOptions options{.step = 0.5 * critical_step(solid, supports), .damping = 100};
  Eigen::SparseMatrix<double> p(solid.unknowns(), 3);
  p.insert(14, 0) = 1, p.insert(28, 1) = 1, p.insert(29, 1) = -2, p.insert(58, 2) = 1;
  const Eigen::MatrixXd a = held_load_answer(solid, supports, p, options, 30);
  CHECK(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(a).eigenvalues().minCoeff() > 0);
  const Eigen::Vector3d amount(1e-4, -2e-4, 3e-4), answer = a * amount;
  for (const Kinematics kinematics : all_kinematics) {
    const Solid body = block(3, {.kinematics = kinematics});
    March march(body, supports, {}, options);
    march.advance(30, p * amount);
    const double same = kinematics == Kinematics::small ? 1e-12 : 1e-5;
    CHECK((p.transpose() * march.displacement() - answer).norm() < same * answer.norm());
  }
}

TEST_CASE("a whole load in the first step drives stiff modes against it", "[unit][structure]") {
  const Solid solid = block(2);
  const Supports supports = clamped(solid);
  const AllModes modes = all_modes(solid, supports);
  const int j = static_cast<int>(modes.omega.size()) - 1;
  const double omega = modes.omega[j], h = 1.13 / omega;
  const Vector load = solid.mass().cwiseProduct(modes.shapes.col(j));
  // The motion that has had the load before takes all of it in the first step.
  const auto least = [&](bool whole) {
    double least = 1;
    for (int n = 1; n <= 12; ++n) {
      const Solid small = block(2, {.kinematics = Kinematics::small});
      March march(small, supports, {}, {.step = h});
      if (whole) march.advance(0, load);
      march.advance(n, load);
      least = std::min(least, load.dot(march.displacement()) * omega * omega);
    }
    return least;
  };
  CHECK(least(false) >= 0);
  CHECK(least(true) == Approx(-0.21).margin(0.005));
}

TEST_CASE("a step can be taken back", "[unit][structure]") {
  const Solid solid = block(2);
  March march(solid, clamped(solid), {}, {.step = 0.5 * critical_step(solid, clamped(solid))});
  const Vector load = nodal_pattern(solid, 9, {0, 5, 0});
  march.advance(20, load);
  const March::State kept = march.state();
  march.advance(20, load);
  const Vector there = march.displacement();
  march.set_state(kept);
  march.advance(20, 2 * load);
  CHECK((march.displacement() - there).norm() > 0.01 * there.norm());
  march.set_state(kept);
  march.advance(20, load);
  CHECK(march.displacement() == there);
}
