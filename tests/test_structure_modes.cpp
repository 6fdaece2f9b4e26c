// The lowest modes of structures.

#include <cmath>

#include "fem/modes.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Material steel{2e11, 0.3, 7800};

}  // namespace

TEST_CASE("lowest modes of a plate of many elements, against its residual", "[unit][structure]") {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {0.003, 0.1, 0.2}, {1, 30, 30});
  Supports supports;
  clamp(supports, 3, nodes_of_part(mesh, "front"));
  const Solid solid(mesh, {3.43e9, 0.37, 1200});
  const Modes modes = lowest_modes(solid, supports, 5);
  const auto k = solid.tangent(Vector::Zero(solid.unknowns()));
  for (int m = 0; m < 5; ++m) {
    const Vector x = modes.shapes.col(m), inner = k * x;
    const double square = std::pow(2 * std::acos(-1.0) * modes.frequencies[m], 2);
    Vector wrong = inner - square * solid.mass().cwiseProduct(x);
    for (const int i : supports.held) wrong[i] = 0;
    CHECK(wrong.norm() < 1e-6 * inner.norm());
    CHECK(x.dot(solid.mass().cwiseProduct(x)) == Approx(1));
  }
}

TEST_CASE("all modes of a body of few unknowns, held and free", "[unit][structure]") {
  const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {1, 1, 0}, {1, 1, 1});
  const Solid solid(mesh, steel);
  const Modes modes = lowest_modes(solid, {}, 100);
  REQUIRE(modes.frequencies.size() == 8);
  const Eigen::MatrixXd k = solid.tangent(Vector::Zero(8));
  const Vector root = solid.mass().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> exact(root.asDiagonal() * k * root.asDiagonal());
  for (int m = 0; m < 3; ++m) CHECK(modes.frequencies[m] < 1e-2 * modes.frequencies[3]);
  for (int m = 3; m < 8; ++m)
    CHECK(modes.frequencies[m] == Approx(std::sqrt(exact.eigenvalues()[m]) / (2 * std::acos(-1.0))).epsilon(1e-6));
  Supports supports;
  clamp(supports, 2, {0, 1, 2, 3});
  CHECK(lowest_modes(solid, supports, 3).frequencies.size() == 0);
}

TEST_CASE("modes of a state that is not stable", "[unit][structure]") {
  // A column pressed far beyond its buckling load: K has negative values.
  const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {1, 40, 0}, {1, 40, 1});
  Supports supports;
  clamp(supports, 2, nodes_of_part(mesh, "bottom"));
  const Solid solid(mesh, steel, {.kinematics = Kinematics::total_lagrangian});
  const Vector u = displacement_of(mesh, [](const Place& x) { return Place{0, -0.05 * x[1], 0}; });
  const Modes pressed = lowest_modes(solid, supports, 4, u), free = lowest_modes(solid, supports, 4);
  CHECK(pressed.frequencies[0] == 0);
  CHECK(free.frequencies[0] > 0);
}
