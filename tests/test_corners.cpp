// Corners of any angle, in 2-D and 3-D: n = n^0, and a matrix that CG can solve.
#include <algorithm>
#include <cmath>
#include <iostream>

#include "core/check.hpp"
#include "kernels/wall_panels.hpp"
#include "tests/shapes.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double degree = M_PI / 180;

// A pattern of points that is the same after reflection in every line through the origin at a multiple of 180 / folds
// degrees, folds 4 or 6: any two of those lines make a corner in which n must be what it is without walls.
Positions pattern(int folds, double cell, double size) {
  const double s = folds == 6 ? std::sin(60 * degree) : 1, c = folds == 6 ? 0.5 : 0;
  Positions x;
  const int many = static_cast<int>(size / cell / s) + 3;
  for (int a = -many; a <= many; ++a)
    for (int b = -2 * many; b <= 2 * many; ++b)
      for (const auto& [radius, angle] : {std::pair{0.21, 11.0}, std::pair{0.36, 21.0}, std::pair{0.47, 4.0}})
        for (int k = 0; k < folds; ++k)
          for (const int side : {1, -1}) {
            const double at = (side * angle + k * 360.0 / folds) * degree;
            const double px = cell * (b + a * c + radius * std::cos(at)), py = cell * (a * s + radius * std::sin(at));
            if (std::hypot(px, py) < size) x.push_back({px, py, 0});
          }
  return x;
}

// Largest |n - n_free| / n_free over the particles within `size` of the corner; those of `free` come in the same order.
double error_against(const Fluid& fluid, const std::vector<double>& free, const Positions& at, double size) {
  const auto n = by_id(fluid, fluid.particles.number_density);
  double error = 0;
  int looked_at = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (std::hypot(at[i][0], at[i][1]) > size) continue;
    error = std::max(error, std::fabs(n[i] / free[i] - 1));
    ++looked_at;
  }
  REQUIRE(looked_at > 10);
  return error;
}

Positions layers(const Positions& flat, int count, coord thickness) {
  Positions x;
  for (int k = 0; k < count; ++k)
    for (auto point : flat) {
      point[2] = (k + 0.5) * thickness;
      x.push_back(point);
    }
  return x;
}

real options_n0(const FluidOptions& options) {
  return lattice_reference({static_cast<real>(options.radius * options.spacing), options.shift}, options.dim,
                           options.spacing)
      .n0;
}

std::vector<double> density_without_walls(const Positions& at, const Positions& all, const FluidOptions& options) {
  const Fluid fluid = fluid_at(all, {}, options);
  const auto n = by_id(fluid, fluid.particles.number_density);
  std::vector<double> wanted;
  for (const auto& x : at) wanted.push_back(n[std::find(all.begin(), all.end(), x) - all.begin()]);
  return wanted;
}

Eigen::MatrixXd matrix_of(Fluid& fluid) {
  mark_surface(fluid, real(0.6));
  PressureSystem system({});
  system.assemble(fluid, real(1e-3));
  const Eigen::MatrixXd all = dense(system);
  const auto surface = host(fluid.particles.surface);
  std::vector<int> active;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (!surface(i)) active.push_back(i);
  return all(active, active);
}

void check_matrix(Fluid& fluid) {
  const Eigen::MatrixXd A = matrix_of(fluid);
  REQUIRE(A.rows() > 40);
  REQUIRE(A.rows() < fluid.particles.count);  // some surface: without it a constant has no slope
  CHECK((A - A.transpose()).cwiseAbs().maxCoeff() <= 1e-15 * A.cwiseAbs().maxCoeff());
  CHECK(Eigen::LLT<Eigen::MatrixXd>(A).info() == Eigen::Success);  // no pivot that is not above 0
}

FluidOptions options_in(int dim, coord spacing, coord radius) {
  FluidOptions options;
  options.dim = dim;
  options.spacing = spacing;
  options.radius = radius;
  return options;
}

// A plate bent at two points, clear of everything.
WallFaces bent_plate() {
  return walls_of({segment(0.3, 0.2, 0.5, 0.55), segment(0.5, 0.55, 0.55, 0.9), segment(0.55, 0.9, 0.85, 1.2)});
}

}  // namespace

TEST_CASE("n in a corner of a symmetric pattern is what it is without walls", "[unit][corners]") {
  const double cell = 0.35, reach = 0.31, size = 0.9;
  const auto options = options_in(2, 0.1, 3.1);
  for (const int angle : {30, 45, 60, 90, 120, 135, 150, 180}) {
    INFO("corner of " << angle << " degrees");
    const Positions all = pattern(angle % 45 == 0 && angle < 180 ? 4 : 6, cell, size + reach);
    const Positions at = only(all, [&](const auto& x) { return in_wedge(x, angle * degree); });
    const auto wanted = density_without_walls(at, all, options);
    const Fluid fluid = fluid_at(at, wedge(angle * degree, 3), options);
    CHECK(error_against(fluid, wanted, at, size - 0.01) < 1e-12);
  }
}

TEST_CASE("n in the edges of a symmetric pattern with floor and lid, turned in space", "[unit][corners]") {
  const double cell = 0.35, reach = 0.21, size = 0.5;
  const auto options = options_in(3, 0.1, 2.1);
  const Turn turn = turn_about(0.6, {1, 2, -0.5});
  for (const int angle : {30, 45, 60, 90, 120, 135, 150}) {
    INFO("edge of " << angle << " degrees");
    const Positions flat = pattern(angle % 45 == 0 ? 4 : 6, cell, size + reach);
    const Positions flat_at = only(flat, [&](const auto& x) { return in_wedge(x, angle * degree); });
    // Three layers between floor and lid are as nine: what those in the middle have, all three have.
    const Fluid endless = fluid_at(layers(flat, 9, 0.1), {}, options);
    const auto n = by_id(endless, endless.particles.number_density);
    std::vector<double> free;
    for (int k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < flat.size(); ++i)
        if (in_wedge(flat[i], angle * degree)) free.push_back(n[4 * flat.size() + i]);
    WallFaces walls = drawn_up(wedge(angle * degree, 3), 0.3);
    add_ends(walls, -3, 3, 0.3);
    const Positions at = layers(flat_at, 3, 0.1);
    const Fluid fluid = fluid_at(turned(turn, at), turned(turn, walls), options);
    CHECK(error_against(fluid, free, at, size - 0.01) < 1e-12);
  }
}

TEST_CASE("n = n0 in the edges and corners of a box", "[unit][corners]") {
  for (const coord radius : {2.1, 3.1}) {
    const auto options = options_in(3, 0.1, radius);
    const Positions at = lattice_3d(8, 7, 10, 0.1);
    const Turn turn = turn_about(17 * degree, {0.3, 1, 0.2});
    for (const Turn& way : {turn_about(0), turn}) {
      const Fluid fluid = fluid_at(turned(way, at), turned(way, open_box(0.8, 0.7, 2)), options);
      const auto n = by_id(fluid, fluid.particles.number_density);
      double error = 0;
      for (std::size_t i = 0; i < at.size(); ++i)
        if (at[i][2] < 1 - radius * 0.1) error = std::max(error, std::fabs(n[i] / options_n0(options) - 1));
      CHECK(error < 1e-12);
    }
  }
}

TEST_CASE("n = n0 within 1 % in corners cut out of a lattice", "[validation][corners]") {
  // The lattice does not fit to the second wall: what is left is the error of cutting it, which falls with the spacing,
  // so the radius is wide; wider where more images repeat the cut.
  for (const auto& [angle, radius] :
       {std::pair{30, 44.0}, std::pair{60, 36.0}, std::pair{120, 30.0}, std::pair{150, 30.0}}) {
    const coord l0 = 0.6 / radius;
    const double turn = angle * degree;
    const auto inside = [=](const auto& x) { return in_wedge(x, turn) && std::hypot(x[0], x[1]) < 1.3; };
    const Positions at = only(lattice(static_cast<int>(2.8 / l0), static_cast<int>(1.4 / l0), l0, -1.4, 0), inside);
    const Fluid fluid = fluid_at(at, wedge(angle * degree, 3), options_in(2, l0, radius));
    const auto n = by_id(fluid, fluid.particles.number_density);
    double error = 0, mean = 0;
    int looked_at = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (std::hypot(at[i][0], at[i][1]) > 0.6) continue;
      error = std::max(error, std::fabs(n[i] / fluid.density.reference.n0 - 1));
      mean += n[i] / fluid.density.reference.n0 - 1;
      ++looked_at;
    }
    std::cout << "corner of " << angle << " degrees: n / n0 - 1 is at most " << error << ", " << mean / looked_at
              << " in the mean of " << looked_at << " particles\n";
    CHECK(error < 0.01);
  }
}

// Water round the foot and the tip of a plate, and beyond the tip. A plate that leans by next to nothing has joints at its
// corners in place of one image that is right where they are at right angles.
TEST_CASE("right-angled corners are what corners nearly so are, inside and outside", "[unit][corners]") {
  constexpr coord l0 = 0.1;
  for (const int dim : {2, 3}) {
    const auto number_density = [&](coord lean) {
      const WallFaces flat = walls_of({segment(-1, 0, 1, 0), segment(0, 0, lean, 0.8),
                                       segment(lean, 0.8, 0.32 + lean, 0.8), segment(0.32 + lean, 0.8, 0.32, 0)});
      FluidOptions options;
      options.dim = dim;
      options.spacing = l0;
      options.radius = dim == 2 ? 3.1 : 2.1;
      options.shift = 0;
      Positions x;
      for (int k = 0; k < (dim == 2 ? 1 : 5); ++k)
        for (const auto& at : lattice(5, 12, l0, -0.5, 0, 0.1)) x.push_back({at[0], at[1], (k + 0.5) * l0});
      const Fluid fluid = fluid_at(x, dim == 2 ? flat : drawn_up(flat, 0.5), options);
      return by_id(fluid, fluid.particles.number_density);
    };
    const auto right = number_density(0), nearly = number_density(1e-6);
    REQUIRE(right.size() == nearly.size());
    for (std::size_t i = 0; i < right.size(); ++i) {
      INFO(dim << "-D, particle " << i);
      CHECK(right[i] == Approx(nearly[i]).epsilon(1e-4));
    }
  }
}

TEST_CASE("the matrix is symmetric and positive definite in corners of any angle", "[unit][corners]") {
  for (const double angle : {30.0, 60.0, 87.0, 93.0, 135.0, 175.0})
    for (const unsigned seed : {1u, 2u}) {
      INFO("corner of " << angle << " degrees");
      const auto inside = [&](const auto& x) { return in_wedge(x, angle * degree) && std::hypot(x[0], x[1]) < 0.9; };
      Positions at = random_cloud(2500, 2, seed, 3);
      for (auto& x : at) x[0] -= 1.5;
      Fluid flat = fluid_at(only(at, inside), wedge(angle * degree, 3), options_in(2, 0.06, 3.1));
      check_matrix(flat);
      at = random_cloud(3200, 3, seed, 2.4);
      for (auto& x : at) x = {x[0] - 1.2, x[1], x[2] / 4};
      WallFaces walls = drawn_up(wedge(angle * degree, 3), 0.6);
      add_ends(walls, -3, 3, 0.6);
      const Turn turn = turn_about(0.6, {1, 2, -0.5});
      Fluid deep =
          fluid_at(turned(turn, only(at, [&](const auto& x) { return inside(x) && std::hypot(x[0], x[1]) < 0.9; })),
                   turned(turn, walls), options_in(3, 0.1, 2.1));
      check_matrix(deep);
    }
}

TEST_CASE("the matrix is symmetric and positive definite round a bent plate", "[unit][corners]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Fluid flat = fluid_at(random_cloud(700, 2, seed, 1.4), bent_plate(), options_in(2, 0.06, 3.1));
    check_matrix(flat);
    Positions at = random_cloud(900, 3, seed, 1.4);
    for (auto& x : at) x[2] *= 0.4;
    WallFaces walls = drawn_up(bent_plate(), 0.4);  // free ends above and at the sides, a floor below
    add_rectangle(walls, {-1, -1, 0}, {3, -1, 0}, {3, 3, 0}, {-1, 3, 0});
    Fluid deep = fluid_at(at, walls, options_in(3, 0.12, 2.1));
    check_matrix(deep);
  }
}

TEST_CASE("corners sharper than 5 degrees are refused in words", "[unit][corners]") {
  CHECK_THROWS_WITH(fluid_at({{1, 0.01, 0}}, wedge(3 * degree, 3), options_in(2, 0.1, 3.1)),
                    Catch::Contains("\"a\" and \"b\" meet at 3 degrees") && Catch::Contains("open the corner"));
}

TEST_CASE("coplanar triangles are one wall: one image across their common edge", "[unit][walls]") {
  WallFaces floor{3, {}, {{"floor"}}};
  add_rectangle(floor, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
  const WallPanels made = find_panels(floor, 1e-9);
  CHECK(made.panels.size() == 1);
  CHECK(made.mirrors.size() == 1);
  const Fluid fluid = fluid_at({{0, 0, 0.05}, {0.1, -0.1, 0.05}}, floor, options_in(3, 0.1, 3.1));
  CHECK(fluid.rows.images.entries == 4);
}

TEST_CASE("a box of triangles has five walls, eight edges and four corners", "[unit][walls]") {
  const WallPanels made = find_panels(open_box(1, 1, 1), 1e-9);
  CHECK(made.panels.size() == 5);
  CHECK(made.mirrors.size() == 5 + 8 + 4);
}

TEST_CASE("beyond an outer edge of a round wall a particle sees itself as beside it", "[unit][corners]") {
  for (const double bend : {5.0, 10.0, 19.0}) {  // degrees; a path round an edge of more than 20 is a corner's
    const double half = bend / 2 * degree, depth = 0.04;
    for (const int bodies : {1, 2}) {
      const WallFaces walls = walls_of({segment(-std::cos(half), -std::sin(half), 0, 0),
                                        segment(0, 0, std::cos(half), -std::sin(half), bodies - 1)});
      for (const double part : {0.0, 0.3, -0.3, 0.9}) {  // of the wedge in which no path meets a panel
        const Fluid fluid = fluid_at({{depth * std::sin(part * half), depth * std::cos(part * half), 0}}, walls);
        const double n = host(fluid.particles.number_density)(0), own = fluid.density.weight(real(2 * depth));
        CHECK(n == (bodies == 1 ? Approx(own).epsilon(0.02) : Approx(0).margin(1e-12)));
      }
    }
  }
}
