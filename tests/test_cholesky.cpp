// Factors of stiffness matrices, and modes found with them.

#include <random>

#include "fem/cholesky.hpp"
#include "fem/dissection.hpp"
#include "fem/modes.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Material steel{2e11, 0.3, 7800};

std::vector<Place> places_of(const SolidMesh& mesh) {
  std::vector<Place> places;
  for (const Place& x : mesh.nodes) places.insert(places.end(), mesh.dim, x);
  return places;
}

/// K + a part of M, which has an inverse.
Eigen::SparseMatrix<double> stiffness_of(const Solid& solid, double mass) {
  Eigen::SparseMatrix<double> k = solid.tangent(Vector::Zero(solid.unknowns()));
  for (int i = 0; i < solid.unknowns(); ++i) k.coeffRef(i, i) += mass * solid.mass()[i];
  return k;
}

double error_of(const Eigen::SparseMatrix<double>& k, const std::vector<Place>& places) {
  const Eigen::MatrixXd x = random_vector(2 * static_cast<int>(k.cols()), 1).reshaped(k.cols(), 2);
  const Cholesky factor(k, places);
  REQUIRE(factor.definite());
  return (factor.solve(k * x) - x).norm() / x.norm();
}

SolidMesh two_apart() {
  SolidMesh mesh = box_mesh(3, {0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  const SolidMesh other = mesh;
  const int shift = static_cast<int>(mesh.nodes.size());
  for (Place x : other.nodes) mesh.nodes.push_back({x[0] + 3, x[1], x[2]});
  for (auto element : other.elements) {
    for (int& node : element) node += shift;
    mesh.elements.push_back(element);
  }
  mesh.parts.clear();
  return mesh;
}

}  // namespace

TEST_CASE("factors of a stiffness matrix solve with it", "[unit][structure]") {
  for (const SolidMesh& mesh :
       {box_mesh(3, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}), box_mesh(3, {0, 0, 0}, {2, 3, 1}, {6, 9, 3}),
        box_mesh(3, {0, 0, 0}, {1, 40, 1}, {1, 40, 1}), crooked_box(3, 0.1),
        box_mesh(2, {0, 0, 0}, {1, 2, 0}, {12, 30, 1}), two_apart()}) {
    const Solid solid(mesh, steel);
    CHECK(error_of(stiffness_of(solid, 1e6), places_of(mesh)) < 1e-9);
  }
}

TEST_CASE("places decide about the order of elimination only", "[unit][structure]") {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  auto k = stiffness_of(Solid(mesh, steel), 1e6);
  const std::vector<Place> one_place(k.cols(), Place{1, 2, 3});
  CHECK(error_of(k, one_place) < 1e-9);
  std::vector<Place> mixed = places_of(mesh);
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = {static_cast<double>(i * 7919 % mixed.size()), 0, 0};
  CHECK(error_of(k, mixed) < 1e-9);
  k.coeffRef(100, 100) *= -1;
  CHECK_FALSE(Cholesky(k, places_of(mesh)).definite());
}

TEST_CASE("dissection has every node once, and halves that do not know each other", "[unit][structure]") {
  // A path of 1000 nodes along x.
  element::Graph path{{0}, {}};
  std::vector<Place> places;
  for (int i = 0; i < 1000; ++i) {
    for (const int other : {i - 1, i + 1})
      if (other >= 0 && other < 1000) path.next.push_back(other);
    path.first.push_back(static_cast<int>(path.next.size()));
    places.push_back({0.1 * i, 0, 0});
  }
  std::vector<int> seen(1000, 0);
  for (const element::Separator& separator : element::dissect(path, places)) {
    for (const int n : separator.nodes) ++seen[n];
    if (!separator.halves.empty()) CHECK(separator.nodes.size() == 1);
    CHECK(separator.nodes.size() <= 24);
  }
  CHECK(seen == std::vector<int>(1000, 1));
}

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
