// Stress anywhere in a body, and places in its mesh.

#include <cmath>
#include <random>

#include "fem/mesh_place.hpp"
#include "fem/shape_functions.hpp"
#include "fem/static_solution.hpp"
#include "tests/beams.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

template <int Dim>
Place place_at(const SolidMesh& mesh, const MeshPlace& at) {
  element::Point<Dim> xi;
  for (int d = 0; d < Dim; ++d) xi[d] = at.xi[d];
  const element::Functions<Dim> n(xi);
  Place x{};
  for (int a = 0; a < 1 << Dim; ++a)
    for (int d = 0; d < Dim; ++d) x[d] += n.shape[a] * mesh.nodes[mesh.elements[at.element][a]][d];
  return x;
}

Place place_at(const SolidMesh& mesh, const MeshPlace& at) {
  return mesh.dim == 2 ? place_at<2>(mesh, at) : place_at<3>(mesh, at);
}

/// A plate of one element through its thickness h along x, clamped at y = 0, with a force along x at its tip; in 2-D
/// plane stress, 1 m wide.
struct Cantilever {
  static constexpr double h = 0.003, length = 0.1, force = 0.01;
  Solid solid;
  double width;
  Vector u;

  Cantilever(int dim, Kinematics kinematics)
      : solid(dim == 2 ? Solid(box_mesh(2, {0, 0, 0}, {h, length, 0}, {1, 100, 1}), {3.43e9, 0.37, 1200},
                               {.kinematics = kinematics, .plane = Plane::stress})
                       : polycarbonate(h, Sides::beam, {.kinematics = kinematics}).solid),
        width(dim == 2 ? 1 : 0.2) {
    Supports supports;
    if (dim == 2)
      clamp(supports, 2, nodes_of_part(solid.mesh(), "bottom"));
    else
      supports = polycarbonate(h, Sides::beam).supports;
    Loads loads;
    const auto& tip = nodes_of_part(solid.mesh(), dim == 2 ? "top" : "back");
    for (const int node : tip) loads.add(nodal_pattern(solid, node, {force / static_cast<double>(tip.size()), 0, 0}));
    const StaticSolution solution = solve_static(solid, supports, loads);
    CHECK(solution.converged);
    u = solution.u;
  }

  double along(double x, double y) const {
    const MeshPlace at = place_in_mesh(solid.mesh(), {x, y, solid.dim() == 2 ? 0 : width / 2});
    return solid.stress(u, at.element, at.xi)[1];
  }
};

}  // namespace

TEST_CASE("bending stress at the faces of a plate one element thick", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    for (const Kinematics kinematics : all_kinematics) {
      const Cantilever beam(dim, kinematics);
      const double h = Cantilever::h, y = 0.0505, inertia = beam.width * h * h * h / 12;
      const double face = Cantilever::force * (Cantilever::length - y) * h / (2 * inertia);  // M h / (2 I)
      CHECK(beam.along(0, y) == Approx(face).epsilon(0.01));
      CHECK(beam.along(h, y) == Approx(-face).epsilon(0.01));
      CHECK(beam.along(h / 4, y) == Approx(face / 2).epsilon(0.01));
      CHECK(beam.along(h / 2, y) == Approx(0).margin(0.01 * face));
    }
  }
}

TEST_CASE("natural coordinates 0 are the centre", "[unit][structure]") {
  const SolidMesh mesh = crooked_box(3, 0.2);
  for (const ElementKind kind : all_kinds) {
    for (const Kinematics kinematics : all_kinematics) {
      const Solid solid(mesh, {2.5e6, 0.3, 1200}, {kind, kinematics});
      const Vector u = random_vector(solid.unknowns(), 0.01);
      CHECK(solid.stress(u, 3, {0, 0, 0}) == solid.stress(u)[3]);
      CHECK(solid.stress(u, 3, {0.5, 0, 0}) != solid.stress(u)[3]);
    }
  }
}

TEST_CASE("the mean of the stress in an element is that of its force", "[unit][structure]") {
  // u.f = the integral of stress and strain, for a linear gradient of any u: with modes, against those too.
  const SolidMesh mesh = crooked_box(3, 0.2);
  for (const ElementKind kind : all_kinds) {
    const Solid solid(mesh, {2.5e6, 0.3, 1200}, {kind, Kinematics::small});
    const Vector u = random_vector(solid.unknowns(), 0.01);
    Vector f(solid.unknowns());
    solid.internal_force(u, f);
    const Vector stretch = displacement_of(mesh, [](const Place& x) { return Place{x[1], 0.5 * x[0], 0.2 * x[2]}; });
    double power = 0;
    for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
      for (int p = 0; p < 8; ++p) {
        const auto c = element::corner<3>(p);
        const std::array<double, 3> xi{c[0] / std::sqrt(3), c[1] / std::sqrt(3), c[2] / std::sqrt(3)};
        const element::Functions<3> n(xi);
        Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
        for (int a = 0; a < 8; ++a)
          for (int d = 0; d < 3; ++d)
            for (int k = 0; k < 3; ++k) j(d, k) += n.slope[a][k] * mesh.nodes[mesh.elements[e][a]][d];
        const auto s = solid.stress(u, e, xi);
        power += j.determinant() * (1.5 * s[3] + 0.2 * s[2]);
      }
    }
    CHECK(power == Approx(stretch.dot(f)));
  }
}

TEST_CASE("places in a mesh are found, and those outside are brought to it", "[unit][structure]") {
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> amount(-0.99, 0.99);
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = crooked_box(dim, 0.2);
    for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
      MeshPlace at{e, {}};
      for (int d = 0; d < dim; ++d) at.xi[d] = amount(generator);
      const MeshPlace found = place_in_mesh(mesh, place_at(mesh, at));
      CHECK(found.element == e);
      for (int d = 0; d < 3; ++d) CHECK(found.xi[d] == Approx(at.xi[d]).margin(1e-10));
    }
  }
  const SolidMesh box = box_mesh(3, {0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  const MeshPlace outside = place_in_mesh(box, {-5, 0.25, 2.5});
  CHECK(outside.element == 6);
  CHECK(outside.xi == std::array<double, 3>{-1, -0.5, 1});
  CHECK(place_in_mesh(box, {1, 0.5, 0.5}).element == 0);  // two share it
}
