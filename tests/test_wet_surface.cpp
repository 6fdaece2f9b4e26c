// The wet surface of a structure: its walls, and forces on the way back to the nodes.

#include <cmath>

#include "core/check.hpp"
#include "coupling/wet_surface.hpp"
#include "fem/loads.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// A plate 3 mm thick along x, 0.1 m high along y, 0.2 m wide along z, wet but for its foot and its sides.
SolidMesh plate(int across) { return box_mesh(3, {0, 0, -0.1}, {0.003, 0.1, 0.1}, {1, 10, across}); }

// As box_mesh calls them: along y, then along z.
const std::vector<std::string> foot_and_sides{"front", "bottom", "top"};

/// Forces on the corners of a constant pressure on one side of the fluid's walls, by hand [N/m].
Vector pressed(const WetSurface& surface, double pressure, int body) {
  Vector force = Vector::Zero(2 * surface.corners());
  const auto faces = surface.faces(body);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto &a = faces[f].corner[0].position, &b = faces[f].corner[1].position;
    // The solid is on the left: so that is where pressure goes.
    const double push[2] = {-(b[1] - a[1]) * pressure / 2, (b[0] - a[0]) * pressure / 2};
    for (int e = 0; e < 2; ++e)
      for (int d = 0; d < 2; ++d) force[2 * surface.corner_of_face()[f][e] + d] += push[d];
  }
  return force;
}

}  // namespace

TEST_CASE("a plate of hexahedra is a line round it in a 2-D fluid", "[unit][coupling]") {
  for (const int across : {1, 3}) {
    const SolidMesh mesh = plate(across);
    const WetSurface surface(mesh, outer_facets_without(mesh, foot_and_sides), 2);
    CHECK(surface.corners() == 22);
    CHECK(surface.faces(4).size() == 21);
    CHECK(surface.depth() == Approx(0.2));
    double height = 0;
    for (const WallFace& face : surface.faces(4)) {
      CHECK(face.body == 4);
      const auto normal = face_normal(corners_of(face), 2);
      const auto &a = face.corner[0].position, &b = face.corner[1].position;
      const double x = (a[0] + b[0]) / 2, y = (a[1] + b[1]) / 2;  // the normal points into the solid
      CHECK(normal[0] * (0.0015 - x) + normal[1] * (0.05 - y) > 0);
      height += std::fabs(b[1] - a[1]);
    }
    CHECK(height == Approx(0.2));
  }
}

TEST_CASE("a pressure on the walls is the consistent load on the nodes", "[unit][coupling]") {
  for (const int across : {1, 3}) {
    const SolidMesh mesh = plate(across);
    const Solid solid(mesh, {3.43e9, 0.37, 1200});
    const auto wet = outer_facets_without(mesh, foot_and_sides);
    const WetSurface surface(mesh, wet, 2);
    const Vector f = surface.on_nodes(pressed(surface, 1000, 0));
    const Vector expected = pressure_pattern(solid, wet, [](const auto&) { return 1000; });
    CHECK((f - expected).norm() < 1e-12 * expected.norm());
  }
}

TEST_CASE("forces and displacements do the same work on nodes and corners", "[unit][coupling]") {
  const SolidMesh thick = plate(2), flat = box_mesh(2, {0, 0, 0}, {0.003, 0.1, 0}, {1, 10, 1});
  const struct {
    SolidMesh mesh;
    int fluid_dim;
    std::vector<std::string> dry;
  } kinds[] = {{thick, 2, foot_and_sides}, {thick, 3, {"front"}}, {flat, 2, {"bottom"}}};
  for (const auto& kind : kinds) {
    const WetSurface surface(kind.mesh, outer_facets_without(kind.mesh, kind.dry), kind.fluid_dim, 0.7);
    const int unknowns = kind.mesh.dim * static_cast<int>(kind.mesh.nodes.size());
    const Vector u = random_vector(unknowns, 1), f = random_vector(kind.fluid_dim * surface.corners(), 1);
    const double at_corners = surface.depth() * f.dot(surface.at_corners(u)), at_nodes = surface.on_nodes(f).dot(u);
    CHECK(at_corners == Approx(at_nodes).epsilon(1e-12));
    // All moved alike: so are the corners.
    Vector moved = Vector::Zero(unknowns);
    for (int i = 0; i < unknowns; i += kind.mesh.dim) moved[i] = 0.01;
    const Vector corners = surface.at_corners(moved);
    for (int c = 0; c < surface.corners(); ++c) CHECK(corners[kind.fluid_dim * c] == Approx(0.01));
  }
}

TEST_CASE("a block of hexahedra in a 3-D fluid is two triangles a side, facing out", "[unit][coupling]") {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {1, 2, 3}, {2, 2, 2});
  const WetSurface surface(mesh, outer_facets(mesh), 3);
  CHECK(surface.corners() == 26);
  const auto faces = surface.faces(0);
  CHECK(faces.size() == 48);
  for (const WallFace& face : faces) {
    const auto corner = corners_of(face);
    const auto normal = face_normal(corner, 3);
    double out = 0;
    const double middle[3] = {0.5, 1, 1.5};
    for (int d = 0; d < 3; ++d) out += normal[d] * ((corner[0][d] + corner[1][d] + corner[2][d]) / 3 - middle[d]);
    CHECK(out > 0);
  }
}

TEST_CASE("a surface that turns as a whole has turned so at every corner", "[unit][coupling]") {
  for (const int dim : {2, 3}) {
    const SolidMesh mesh = plate(2);
    const WetSurface surface(mesh, dim == 2 ? outer_facets_without(mesh, foot_and_sides) : outer_facets(mesh), dim);
    const Eigen::Matrix3d turn3 =
        Eigen::AngleAxisd(0.7, dim == 2 ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(1, -2, 0.5).normalized())
            .toRotationMatrix();
    const Eigen::MatrixXd turn = turn3.topLeftCorner(dim, dim);
    Vector moved(dim * surface.corners());
    for (int c = 0; c < surface.corners(); ++c) {
      const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(surface.rest()[c].data(), dim);
      moved.segment(dim * c, dim) = turn * x - x;
    }
    const auto turns = surface.turn_of_corners(moved);
    REQUIRE(static_cast<int>(turns.size()) == surface.corners());
    for (const Eigen::MatrixXd& found : turns) CHECK((found - turn).cwiseAbs().maxCoeff() < 1e-12);
  }
}

TEST_CASE("what cannot be a wet surface is refused", "[unit][coupling][bad]") {
  const SolidMesh mesh = plate(1);
  CHECK_THROWS_WITH(WetSurface(mesh, {}, 2), Catch::Contains("no wet surface"));
  CHECK_THROWS_WITH(WetSurface(mesh, outer_facets(mesh), 2), Catch::Contains("through the width"));
  const SolidMesh flat = box_mesh(2, {0, 0, 0}, {1, 1, 0}, {1, 1, 1});
  CHECK_THROWS_WITH(WetSurface(flat, outer_facets(flat), 3), Catch::Contains("hexahedra"));
}
