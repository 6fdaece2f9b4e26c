// The inside of closed shapes, against formulas.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/interior.hpp"
#include "tests/catch.hpp"
#include "tests/meshes.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

using Corner = Interior::Corner;
constexpr coord pi = std::numbers::pi;

std::vector<Corner> random_points(int count, const Corner& low, const Corner& high) {
  std::mt19937 generator(7);
  std::vector<Corner> points(static_cast<std::size_t>(count));
  for (Corner& x : points)
    for (std::size_t d = 0; d < 3; ++d) x[d] = std::uniform_real_distribution<coord>(low[d], high[d])(generator);
  return points;
}

const std::vector<Corner> l_shape{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};

bool in_l(const Corner& x) { return x[0] > 0 && x[1] > 0 && x[0] < 2 && x[1] < (x[0] < 1 ? 3 : 1); }

}  // namespace

TEST_CASE("a concave outline: inside, distance, area below a level", "[unit][interior]") {
  std::vector<Corner> outline = l_shape;
  for (int sense = 0; sense < 2; ++sense) {
    const Interior shape(outline);
    CHECK(shape.dimension() == 2);
    CHECK(shape.measure() == Approx(4));
    CHECK(shape.measure_below(-1) == 0);
    CHECK(shape.measure_below(0.5) == Approx(1));
    CHECK(shape.measure_below(1) == Approx(2));
    CHECK(shape.measure_below(2) == Approx(3));
    CHECK(shape.measure_below(9) == Approx(4));
    CHECK(shape.distance({1, 0.5, 0}) == Approx(0.5));
    CHECK(shape.distance({1.5, 1.5, 0}) == Approx(0.5));
    CHECK(shape.distance({-3, -4, 0}) == Approx(5));
    CHECK(shape.distance({-3, -4, 0}, 0.25) == 0.25);
    for (const Corner& x : random_points(2000, {-1, -1, 0}, {3, 4, 0})) CHECK(shape.holds(x) == in_l(x));
    // On lines through corners and along edges, but not on the outline.
    for (const coord x : {-0.5, 0.5, 1.0, 1.5, 2.5})
      for (const coord y : {-0.5, 0.5, 1.5, 2.0, 3.5})
        if (shape.distance({x, y, 0}) > 1e-9) CHECK(shape.holds({x, y, 0}) == in_l({x, y, 0}));
    std::reverse(outline.begin(), outline.end());
  }
}

TEST_CASE("outlines that cross themselves are found", "[unit][interior]") {
  using Edges = std::array<std::size_t, 2>;
  CHECK(!crossing_edges(l_shape));
  CHECK(!crossing_edges({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  CHECK(crossing_edges({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}) == Edges{0, 2});             // a bow
  CHECK(crossing_edges({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 0, 0}, {0, 1, 0}}) == Edges{0, 2});  // touches
  CHECK(crossing_edges({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}}) == Edges{0, 1});             // folds back
  CHECK(crossing_edges({{0, 0, 0}, {1, 0, 0}}) == Edges{0, 1});
}

TEST_CASE("a box of triangles, asked on its own lattice", "[unit][interior]") {
  const Interior box(box_mesh({0, 0, 0}, {1, 2, 3}));
  CHECK(box.measure() == Approx(6));
  CHECK(box.measure_below(1.25) == Approx(2.5));
  CHECK(box.bounds().high == Corner{1, 2, 3});
  // Every line along z meets the diagonals of the lid, edges or corners.
  for (int i = -4; i <= 8; ++i) {
    for (int k = -4; k <= 16; ++k) {
      const Corner x{0.25 * i, 0.5 * i, 0.25 * k};
      const coord away = box.distance(x);
      if (away < 1e-12) continue;
      CHECK(box.holds(x) == (i > 0 && i < 4 && k > 0 && k < 12));
    }
  }
  CHECK(box.distance({0.5, 1, 1}) == Approx(0.5));
  CHECK(box.distance({2, 3, 4}) == Approx(std::sqrt(3)));
  CHECK(box.distance({2, 3, 4}, 0.5) == 0.5);
}

TEST_CASE("a V-shaped tank holds tan(angle) h^2 L below h, also turned", "[unit][interior]") {
  const VTank tank{pi / 6, 0.8, 2.5};
  const Interior upright(v_tank_mesh(tank));
  for (const coord level : {0.1, 0.4, 0.8}) {
    CHECK(upright.measure_below(level) == Approx(tank.area_below(level) * tank.length).epsilon(1e-12));
  }
  const Interior leaning(turned(v_tank_mesh(tank), {0, 0, 1}, 0.7));
  CHECK(leaning.measure_below(0.4) == Approx(tank.area_below(0.4) * tank.length).epsilon(1e-12));
  const Interior upside_down(turned(v_tank_mesh(tank), {0, 1, 0}, pi));
  CHECK(upside_down.measure_below(-0.3) ==
        Approx((tank.area_below(0.8) - tank.area_below(0.3)) * tank.length).epsilon(1e-12));
  for (const Corner& x : random_points(2000, {-1, -0.5, -0.5}, {1, 3, 1})) {
    const bool inside = x[1] > 0 && x[1] < 2.5 && x[2] < 0.8 && std::abs(x[0]) < x[2] * std::tan(pi / 6);
    CHECK(upright.holds(x) == inside);
  }
}

TEST_CASE("a sphere of many triangles", "[unit][interior]") {
  constexpr int rings = 60;
  const Corner centre{0.3, -0.2, 5};
  const Interior sphere(sphere_mesh(centre, 2, rings));
  const coord sagitta = 2 * (1 - std::cos(pi / rings / 2)) * 2;  // of a quadrangle
  CHECK(sphere.measure() == Approx(4.0 / 3 * pi * 8).epsilon(2e-3));
  CHECK(sphere.measure_below(5) == Approx(sphere.measure() / 2));
  const coord cap = pi * 1 * (3 * 2 - 1) / 3;  // pi h^2 (3 r - h) / 3
  CHECK(sphere.measure_below(4) == Approx(cap).epsilon(4e-3));
  for (const Corner& x : random_points(3000, {-2, -2.5, 2.5}, {2.6, 2.1, 7.5})) {
    const coord r = std::hypot(x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]);
    const coord away = sphere.distance(x);
    CHECK(std::abs(away - std::abs(r - 2)) <= sagitta);
    if (away > sagitta) CHECK(sphere.holds(x) == (r < 2));
  }
}

TEST_CASE("lines through corners and edges of turned shapes", "[unit][interior]") {
  // Points straight below and above each corner and each middle of an edge, at every turn: parity must not slip.
  for (int step = 0; step < 12; ++step) {
    TriangleMesh mesh = turned(sphere_mesh({0, 0, 0}, 1, 8), {1, 2, 3}, 0.3 * step);
    const Interior sphere(mesh);
    for (const auto& t : mesh.triangles) {
      const Corner &a = mesh.vertices[static_cast<std::size_t>(t[0])],
                   &b = mesh.vertices[static_cast<std::size_t>(t[1])];
      for (const Corner& x : {a, Corner{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0}}) {
        CHECK(!sphere.holds({x[0], x[1], -1.1}));
        CHECK(!sphere.holds({x[0], x[1], 1.1}));
        if (std::hypot(x[0], x[1]) < 0.95) CHECK(sphere.holds({x[0], x[1], 0}));
      }
    }
  }
}

TEST_CASE("a body within a tank is outside", "[unit][interior]") {
  const TriangleMesh tank = box_mesh({0, 0, 0}, {4, 4, 4});
  const Interior water(together(tank, inside_out(box_mesh({1, 1, 1}, {2, 2, 2}))));
  CHECK(water.measure() == Approx(63));
  CHECK(water.measure_below(1.5) == Approx(23.5));
  CHECK(water.holds({3, 3, 3}));
  CHECK(!water.holds({1.5, 1.5, 1.5}));
  CHECK(water.holds({1.5, 1.5, 0.5}));
}
