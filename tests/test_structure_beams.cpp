// Plates and beams of one layer of elements against Timoshenko's beam.
//
// An element with nodes on its two faces is a beam whose shear is even over the height (kappa = 1) and whose mass sits
// on the faces (rotary inertia h^2/4 in place of h^2/12); the default element is that beam, and bends with the right
// stiffness.

#include <cmath>
#include <iostream>

#include "core/check.hpp"
#include "fem/modes.hpp"
#include "fem/static_solution.hpp"
#include "tests/beams.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double polycarbonate_young = 3.43e9, polycarbonate_poisson = 0.37;

/// As the elements have it.
Beam of_elements(Beam beam) {
  beam.gyration = 0.25;
  beam.shear_area = 1;
  return beam;
}

Beam with_mass_on_faces(Beam beam) {
  beam.gyration = 0.25;
  return beam;
}

/// Frequencies [Hz] of the modes along an axis in which all of the tip goes the same way: along x bending, no torsion.
std::vector<double> modes_along(const Solid& solid, const Supports& supports, int asked, int axis) {
  const Modes modes = lowest_modes(solid, supports, asked);
  const auto& tip = nodes_of_part(solid.mesh(), "back");
  std::vector<double> found;
  for (Eigen::Index m = 0; m < modes.frequencies.size(); ++m) {
    double sum = 0, size = 0;
    for (const int n : tip) {
      sum += modes.shapes(3 * n + axis, m);
      size += std::abs(modes.shapes(3 * n + axis, m));
    }
    if (share_along(solid, modes.shapes.col(m), axis) > 0.7 && std::abs(sum) > 0.9 * size)
      found.push_back(modes.frequencies[m]);
  }
  return found;
}

std::vector<double> bending(const Solid& solid, const Supports& supports, int asked) {
  return modes_along(solid, supports, asked, 0);
}

double solved_tip(const Plate& plate, const FieldAt& pressure) {
  Loads loads;
  loads.add(pressure_pattern(plate.solid, find_part(plate.solid.mesh(), "left")->facets, pressure));
  const StaticSolution solution = solve_static(plate.solid, plate.supports, loads);
  CHECK(solution.converged);
  return plate.tip(solution.u);
}

double even(const Place&) { return 1000; }
double triangle(const Place& x) { return 1000 * (1 - x[1] / 0.1); }
double partial(const Place& x) { return x[1] < 0.03 ? 1000 : 0; }

void print(const std::string& what, const std::vector<double>& figures) {
  std::cout << "  " << what << ':';
  for (const double f : figures) std::cout << ' ' << f;
  std::cout << '\n';
}

}  // namespace

TEST_CASE("bending frequencies of plates one element thick, sides held", "[unit][structure]") {
  for (const double thickness : {0.003, 0.015}) {
    const Plate plate = polycarbonate(thickness, Sides::held);
    const auto found = bending(plate.solid, plate.supports, 8);
    REQUIRE(found.size() >= 3);
    const auto thin = plate.beam().frequencies(3), lumped = with_mass_on_faces(plate.beam()).frequencies(3);
    const auto own = of_elements(plate.beam()).frequencies(3);
    print(text_of("plate of ", 1000 * thickness, " mm, Hz"), found);
    print("Timoshenko, Hz", thin);
    print("Timoshenko with the mass on the faces, Hz", lumped);
    const double allowed[2][3] = {{0.005, 0.005, 0.005}, {0.005, 0.015, 0.03}};
    for (int m = 0; m < 3; ++m) {
      CHECK(found[m] == Approx(own[m]).epsilon(5e-4));
      CHECK(found[m] == Approx((thickness < 0.01 ? thin : lumped)[m]).epsilon(allowed[thickness > 0.01][m]));
    }
  }
}

TEST_CASE("bending frequencies of strips one element thick, sides free", "[unit][structure]") {
  // Narrow, so that it is a beam: the plate of 0.2 m is not, as its foot holds the width.
  for (const double thickness : {0.003, 0.015}) {
    const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {thickness, 0.1, 0.2 * thickness}, {1, 100, 1});
    Supports supports;
    clamp(supports, 3, nodes_of_part(mesh, "front"));
    const Solid solid(mesh, {polycarbonate_young, polycarbonate_poisson, 1200});
    const auto found = bending(solid, supports, 24);
    REQUIRE(found.size() >= 3);
    const Beam beam = {polycarbonate_young, polycarbonate_young / (2 * (1 + polycarbonate_poisson)), 1200, thickness,
                       0.1};
    const auto thin = beam.frequencies(3), lumped = with_mass_on_faces(beam).frequencies(3);
    print(text_of("strip of ", 1000 * thickness, " mm, Hz"), found);
    print("Timoshenko, Hz", thin);
    print("Timoshenko with the mass on the faces, Hz", lumped);
    const double allowed[2][3] = {{0.005, 0.005, 0.005}, {0.005, 0.015, 0.03}};
    for (int m = 0; m < 3; ++m) {
      CHECK(found[m] == Approx((thickness < 0.01 ? thin : lumped)[m]).epsilon(allowed[thickness > 0.01][m]));
    }
  }
}

TEST_CASE("an axial mode lies between the bending modes of the thick plate", "[unit][structure]") {
  const Plate plate = polycarbonate(0.015, Sides::held);
  const auto axial = modes_along(plate.solid, plate.supports, 8, 1), bent = bending(plate.solid, plate.supports, 8);
  // A bar in plane strain: c / (4 L).
  REQUIRE(axial.size() == 1);
  CHECK(axial[0] == Approx(std::sqrt(plate.beam().young / 1200) / 0.4).epsilon(0.005));
  CHECK(bent[1] < axial[0]);
  CHECK(axial[0] < bent[2]);
}

TEST_CASE("static tips of plates one element thick", "[unit][structure]") {
  for (const double thickness : {0.003, 0.015}) {
    const Plate plate = polycarbonate(thickness, Sides::held);
    const double tips[] = {solved_tip(plate, even), solved_tip(plate, triangle), solved_tip(plate, partial)};
    const auto against = [&](const Beam& beam) {
      return std::vector<double>{tips[0] / beam.tip_of_partial(1000, 0.1), tips[1] / beam.tip_of_triangle(1000),
                                 tips[2] / beam.tip_of_partial(1000, 0.03)};
    };
    print(text_of("tips of ", 1000 * thickness, " mm over Timoshenko's (kappa 5/6; uniform, triangle, partial)"),
          against(plate.beam()));
    const auto ratios = against(thickness < 0.01 ? plate.beam() : of_elements(plate.beam()));
    for (const double ratio : ratios) CHECK(ratio == Approx(1).epsilon(0.005));
  }
}

TEST_CASE("the plain hexahedron is too stiff, and by how much", "[unit][structure]") {
  // Pure bending of an element of height h and length l that keeps its thickness: modulus lambda + 2 mu, and a shear
  // that is not there, G (l/h)^2.
  const auto [lambda, mu] = lame({polycarbonate_young, polycarbonate_poisson, 1200});
  const double thickness = 0.003, modulus = lambda + 2 * mu + mu / 9;
  for (const Sides sides : {Sides::free, Sides::held}) {
    const SolidOptions full{.element = ElementKind::full};
    const Plate plain = polycarbonate(thickness, sides, full), right = polycarbonate(thickness, sides);
    const double tip = solved_tip(plain, even), beam = plain.beam().tip_of_partial(1000, 0.1);
    const std::string name = sides == Sides::free ? "sides free" : "sides held";
    print(name + ", tip over beam, plain hexahedra", {tip / beam});
    print(name + ", tip over beam, default", {solved_tip(right, even) / beam});
    print(name + ", plain hexahedra, Hz", bending(plain.solid, plain.supports, 6));
    print(name + ", default, Hz", bending(right.solid, right.supports, 6));
    // With sides free too: one element cannot curve across its width.
    CHECK(tip / beam == Approx(plain.beam().young / modulus).epsilon(2e-3));
  }
}

TEST_CASE("clamped-clamped plate under pressure", "[unit][structure]") {
  // Span 1 m, 50 mm of aluminium under 2 m of water, in plane strain, half of it: w = p L^4 / (384 D), 6.853e-5 m, and,
  // as it is not thin, p L^2 / (8 kappa G h) of shear, 3 %. With a tenth of the thickness nothing is left of that.
  const double young = 67.5e9, poisson = 0.34, g = young / (2 * (1 + poisson));
  for (const double h : {0.05, 0.005}) {
    const SolidMesh mesh = box_mesh(2, {0, 0, 0}, {0.5, h, 0}, {50, 1, 1});
    Supports supports;
    clamp(supports, 2, nodes_of_part(mesh, "left"));
    hold(supports, 2, nodes_of_part(mesh, "right"), 0);
    const Solid solid(mesh, {young, poisson, 2700}, {.kinematics = Kinematics::small});
    const double p = (1000 * 2 + 2700 * 0.05) * 9.8, d = young * h * h * h / (12 * (1 - poisson * poisson));
    Loads loads;
    loads.add(pressure_pattern(solid, find_part(mesh, "top")->facets, [&](const Place&) { return p; }));
    const Vector u = solve_static(solid, supports, loads).u;
    const double middle = -u[2 * nodes_of_part(mesh, "right").front() + 1], thin = p / (384 * d);
    print(text_of("clamped plate of ", 1000 * h, " mm, mm and over the thin plate"), {1000 * middle, middle / thin});
    CHECK(middle == Approx(thin + p / (8 * g * h)).epsilon(0.005));
    if (h < 0.01) CHECK(middle == Approx(thin).epsilon(0.005));
  }
}
