// Elements of structures: what holds for each of them, whatever its kind.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "fem/solid.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Material rubbery{2.5e6, 0.3, 1200};

Eigen::Matrix3d turn(int dim, double angle) {
  const Eigen::Vector3d axis = dim == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1, 2, 3).normalized();
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// u that takes X to A X + c.
Vector affine(const SolidMesh& mesh, const Eigen::Matrix3d& a) {
  return displacement_of(mesh, [&](const Place& x) {
    const Eigen::Vector3d from(x[0], x[1], x[2]), u = a * from - from + Eigen::Vector3d(0.3, -0.2, 0.1);
    return Place{u[0], u[1], u[2]};
  });
}

Eigen::Matrix3d stretch(int dim, double size) {
  Eigen::Matrix3d a;
  a << 1 + size, 0.4 * size, 0.3 * size, -0.2 * size, 1 - 0.5 * size, 0.6 * size, 0.1 * size, 0.7 * size,
      1 + 0.8 * size;
  if (dim == 2) a.row(2) << 0, 0, 1, a.col(2) << 0, 0, 1;
  return a;
}

std::vector<SolidOptions> every_option() {
  std::vector<SolidOptions> all;
  for (const ElementKind kind : all_kinds)
    for (const Kinematics kinematics : all_kinematics) all.push_back({kind, kinematics, Plane::strain, 0.7});
  return all;
}

bool outer(const Place& x, int dim) {
  bool is = false;
  for (int d = 0; d < dim; ++d) is = is || x[d] == 0 || x[d] == (d == 0 ? 3 : 2);
  return is;
}

/// Newton's steps on the inner nodes, the outer ones staying where u has them.
Vector settled(const Solid& solid, Vector u) {
  const int dim = solid.dim();
  std::vector<int> inner;
  for (int i = 0; i < solid.unknowns(); ++i)
    if (!outer(solid.mesh().nodes[i / dim], dim)) inner.push_back(i);
  Vector f(solid.unknowns());
  for (int step = 0; step < 8; ++step) {
    solid.internal_force(u, f);
    const Eigen::MatrixXd k = Eigen::MatrixXd(solid.tangent(u))(inner, inner);
    u(inner) -= k.llt().solve(f(inner));
  }
  return u;
}

}  // namespace

TEST_CASE("patch test: a distorted mesh takes constant strain exactly", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = distorted_box(dim, 0.25);
    for (const SolidOptions& options : every_option()) {
      // Linear: a gradient of any size. Corotational: a turned stretch, so that each element sees the same frame.
      const Solid solid(mesh, rubbery, options);
      const bool small = options.kinematics == Kinematics::small;
      const Eigen::Matrix3d a = small ? stretch(dim, 0.03) : Eigen::Matrix3d(turn(dim, 0.8) * stretch(dim, 0.03));
      const Vector exact = affine(mesh, a);
      Vector shaken = exact;
      const Vector noise = random_vector(solid.unknowns(), 0.01);
      for (int i = 0; i < solid.unknowns(); ++i)
        if (!outer(mesh.nodes[i / dim], dim)) shaken[i] += noise[i];
      CHECK((settled(solid, shaken) - exact).lpNorm<Eigen::Infinity>() < 1e-11);
      const auto stress = solid.stress(exact);
      for (const auto& s : stress)
        for (int c = 0; c < 6; ++c) CHECK(s[c] == Approx(stress[0][c]).margin(1e-4));
      for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
        const auto s = solid.stress(exact, static_cast<int>(e), {0.9, -1, dim == 2 ? 0 : 0.3});
        for (int c = 0; c < 6; ++c) CHECK(s[c] == Approx(stress[0][c]).margin(1e-4));
      }
    }
  }
}

TEST_CASE("stress of a uniform stretch, by formula", "[unit][structure]") {
  const auto [lambda, mu] = lame(rubbery);
  const SolidMesh mesh = crooked_box(3, 0.2);
  const Eigen::Matrix3d f = turn(3, 1.1) * stretch(3, 0.04);
  const Eigen::Matrix3d green = (f.transpose() * f - Eigen::Matrix3d::Identity()) / 2;
  const Eigen::Matrix3d right = (f.transpose() * f).inverse();
  const double j = f.determinant(), l = lambda, m = mu;
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const auto expect_stress = [&](const Solid& solid, const Eigen::Matrix3d& cauchy) {
    const auto s = solid.stress(affine(mesh, f))[2];
    const double exact[6] = {cauchy(0, 0), cauchy(1, 1), cauchy(2, 2), cauchy(0, 1), cauchy(1, 2), cauchy(2, 0)};
    for (int c = 0; c < 6; ++c) CHECK(s[c] == Approx(exact[c]).margin(1e-6));
  };
  for (const ElementKind kind : all_kinds) {
    const SolidOptions options{kind, Kinematics::total_lagrangian};
    expect_stress(Solid(mesh, rubbery, options), f * (l * green.trace() * one + 2 * m * green) * f.transpose() / j);
    Material neo = rubbery;
    neo.law = Law::neo_hookean;
    expect_stress(Solid(mesh, neo, options), f * (m * (one - right) + l * std::log(j) * right) * f.transpose() / j);
  }
}

TEST_CASE("a rigid rotation makes no force and no energy", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = crooked_box(dim, 0.2);
    for (const SolidOptions& options : every_option()) {
      if (options.kinematics == Kinematics::small) continue;
      const Solid solid(mesh, rubbery, options);
      Vector f(solid.unknowns());
      for (const double angle : {0.4, 1.6, 3.1}) {
        const Vector u = affine(mesh, turn(dim, angle));
        solid.internal_force(u, f);
        CHECK(f.lpNorm<Eigen::Infinity>() < 1e-13 * rubbery.young);
        CHECK(std::abs(solid.strain_energy(u)) < 1e-14 * rubbery.young);
      }
    }
  }
}

TEST_CASE("force is the gradient of the energy, and the tangent that of the force", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = crooked_box(dim, 0.2);
    for (const SolidOptions& options : every_option()) {
      for (const Law law : {Law::linear, Law::neo_hookean}) {
        if (law == Law::neo_hookean && options.kinematics != Kinematics::total_lagrangian) continue;
        Material material = rubbery;
        material.law = law;
        const Solid solid(mesh, material, options);
        const int n = solid.unknowns();
        const Vector u = affine(mesh, turn(dim, 0.9)) + random_vector(n, 0.04);
        const Vector way = random_vector(n, 1).reverse();
        Vector f(n), before(n), after(n);
        solid.internal_force(u, f);
        const double h = 1e-5;
        solid.internal_force(u - h * way, before);
        solid.internal_force(u + h * way, after);
        const double slope = (solid.strain_energy(u + h * way) - solid.strain_energy(u - h * way)) / (2 * h);
        CHECK(std::abs(f.dot(way) - slope) < 1e-7 * f.norm() * way.norm());
        const Vector change = (after - before) / (2 * h), product = solid.tangent(u) * way;
        CHECK((product - change).norm() < 1e-7 * change.norm());
      }
    }
  }
}

TEST_CASE("forces of a deformed body have no sum and no moment", "[unit][structure]") {
  const SolidMesh mesh = crooked_box(3, 0.2);
  for (const SolidOptions& options : every_option()) {
    if (options.kinematics == Kinematics::small) continue;
    const Solid solid(mesh, rubbery, options);
    const Vector u = affine(mesh, turn(3, 0.9)) + random_vector(solid.unknowns(), 0.1);
    Vector f(solid.unknowns());
    solid.internal_force(u, f);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = sum;
    for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
      const Eigen::Vector3d x = Eigen::Vector3d(mesh.nodes[n].data()) + u.segment<3>(3 * n),
                            force = f.segment<3>(3 * n);
      sum += force;
      moment += x.cross(force);
    }
    CHECK(sum.norm() < 1e-12 * f.norm());
    CHECK(moment.norm() < 1e-12 * f.norm());
  }
}

TEST_CASE("stiffness: symmetric, positive, and exactly the rigid motions cost nothing", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = crooked_box(dim, 0.2);
    for (const SolidOptions& options : every_option()) {
      const Solid solid(mesh, rubbery, options);
      const Eigen::MatrixXd k = solid.tangent(Vector::Zero(solid.unknowns()));
      CHECK((k - k.transpose()).norm() < 1e-14 * k.norm());
      const Vector values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
      const int rigid = dim == 2 ? 3 : 6;
      CHECK(values.head(rigid).lpNorm<Eigen::Infinity>() < 1e-12 * values.maxCoeff());
      CHECK(values[rigid] > 1e-4 * values.maxCoeff());
    }
  }
}

TEST_CASE("lumped mass adds up to that of the body", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const Solid solid(distorted_box(dim, 0.25), rubbery, {.thickness = 0.7});
    const double exact = rubbery.density * 6 * (dim == 2 ? 0.7 : 2);
    CHECK(solid.mass().minCoeff() > 0);
    CHECK(solid.mass().sum() == Approx(dim * exact).epsilon(1e-13));
  }
}

TEST_CASE("one body or a row of them, shared shapes or not: the same forces", "[unit][structure]") {
  // Counts about a multiple of the lanes: packs with empty lanes, full ones, and a second; shifted a little, so that nothing is shared.
  for (const int count : {1, 7, 8, 9, 17}) {
    const SolidMesh plain = box_mesh(3, {0, 0, 0}, {1.0 * count, 1, 1}, {count, 1, 1});
    SolidMesh shifted = plain;
    const Vector shift = random_vector(3 * static_cast<int>(plain.nodes.size()), 1e-9);
    for (std::size_t n = 0; n < plain.nodes.size(); ++n)
      for (int d = 0; d < 3; ++d) shifted.nodes[n][d] += shift[3 * n + d];
    for (const Kinematics kinematics : all_kinematics) {
      const Solid a(plain, rubbery, {.kinematics = kinematics}), b(shifted, rubbery, {.kinematics = kinematics});
      const Vector u = random_vector(a.unknowns(), 0.05);
      Vector fa(a.unknowns()), fb(a.unknowns());
      a.internal_force(u, fa);
      b.internal_force(u, fb);
      CHECK((fa - fb).norm() < 1e-7 * fa.norm());
      CHECK(a.strain_energy(u) == Approx(b.strain_energy(u)).epsilon(1e-7));
    }
  }
}

TEST_CASE("bodies that cannot be are refused, with place and cure", "[unit][structure]") {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {2, 1, 1}, {2, 1, 1});
  const auto refused = [&](const SolidMesh& body, const Material& material, const SolidOptions& options,
                           const std::string& text) {
    CHECK_THROWS_WITH(Solid(body, material, options), Catch::Contains(text));
    CHECK_THROWS_AS(Solid(body, material, options), CaseError);
  };
  refused(mesh, {2.5e6, 0.3, -1}, {}, "density");
  refused(mesh, {0, 0.3, 1200}, {}, "Young");
  refused(mesh, {2.5e6, 0.5, 1200}, {}, "0.499");
  refused(mesh, {2.5e6, -1, 1200}, {}, "Poisson");
  refused(mesh, {2.5e6, NAN, 1200}, {}, "Poisson");
  refused(mesh, {2.5e6, 0.3, 1200, Law::neo_hookean}, {}, "total-Lagrangian");
  refused(SolidMesh{}, rubbery, {}, "no elements");

  SolidMesh bad = mesh;
  std::swap_ranges(bad.elements[1].begin(), bad.elements[1].begin() + 4, bad.elements[1].begin() + 4);
  refused(bad, rubbery, {}, "element 2 with nodes at (1, 0, 1), (2, 0, 1)");
  refused(bad, rubbery, {}, "inverted");
  bad = mesh;
  bad.nodes[bad.elements[0][6]] = bad.nodes[bad.elements[0][7]];
  refused(bad, rubbery, {}, "degenerate");
  bad = mesh;
  bad.elements[0][3] = 99;
  refused(bad, rubbery, {}, "node 100");
  bad = mesh;
  bad.nodes.push_back({5, 6, 7});
  refused(bad, rubbery, {}, "(5, 6, 7)");

  const SolidMesh flat = box_mesh(2, {0, 0, 0}, {2, 1, 0}, {2, 1, 1});
  refused(flat, rubbery, {.thickness = 0}, "thickness");
  refused(flat, rubbery, {.element = ElementKind::mean_dilatation, .plane = Plane::stress}, "plane stress");
  bad = flat;
  std::reverse(bad.elements[0].begin(), bad.elements[0].begin() + 4);
  refused(bad, rubbery, {}, "anti-clockwise");
}
