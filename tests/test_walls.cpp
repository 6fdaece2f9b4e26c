// Mirror walls: what is seen, and that a lattice beside them is complete.
#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "kernels/wall_panels.hpp"
#include "tests/shapes.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;

FluidOptions options_with(coord radius, real shift) {
  FluidOptions options;
  options.spacing = l0;
  options.radius = radius;
  options.shift = shift;
  return options;
}

// Largest |n - n^0| / n^0 of the particles whose whole neighbourhood is inside the box of fluid.
double largest_error(const Fluid& fluid, std::function<bool(coord, coord)> complete) {
  const auto x = host(fluid.particles.position);
  const auto n = host(fluid.particles.number_density);
  double error = 0;
  int looked_at = 0;
  for (int i = 0; i < fluid.particles.count; ++i) {
    if (!complete(x(i, 0), x(i, 1))) continue;
    ++looked_at;
    error = std::max(error, std::fabs(n(i) / fluid.density.reference.n0 - 1));
  }
  REQUIRE(looked_at > 5);
  return error;
}

}  // namespace

TEST_CASE("n = n0 beside a flat wall", "[unit][walls]") {
  for (const coord radius : {2.1, 3.1, 4.0})
    for (const real shift : {0.0, 0.05}) {
      const coord reach = radius * l0;
      const Fluid floor = fluid_at(lattice(20, 12, l0), walls_of({segment(-2, 0, 4, 0)}), options_with(radius, shift));
      const double error =
          largest_error(floor, [&](coord x, coord y) { return x > reach && x < 2 - reach && y < 1.2 - reach; });
      CHECK(error < 1e-12);
    }
}

TEST_CASE("n = n0 in right-angled corners", "[unit][walls]") {
  const auto walls = walls_of({segment(0, 0, 2, 0), segment(0, 0, 0, 3), segment(2, 3, 2, 0)});
  for (const coord radius : {2.1, 3.1, 4.0}) {
    const Fluid tank = fluid_at(lattice(20, 12, l0), walls, options_with(radius, real(0.05)));
    CHECK(largest_error(tank, [&](coord, coord y) { return y < 1.2 - radius * l0; }) < 1e-12);
  }
}

TEST_CASE("n = n0 in a closed box", "[unit][walls]") {
  const auto walls =
      walls_of({segment(0, 0, 2, 0), segment(0, 0, 0, 1.2), segment(2, 1.2, 2, 0), segment(2, 1.2, 0, 1.2)});
  const Fluid tank = fluid_at(lattice(20, 12, l0), walls, options_with(3.1, real(0.05)));
  CHECK(largest_error(tank, [](coord, coord) { return true; }) < 1e-12);
}

TEST_CASE("n = n0 on both sides of a plate without thickness that stands on the floor", "[unit][walls]") {
  // The plate splits the water from wall to wall; its foot stands on the floor, which goes on under it.
  const auto walls = walls_of({segment(0, 0, 2, 0), segment(0, 0, 0, 3), segment(2, 3, 2, 0), segment(1, 0, 1, 3, 1)});
  const Fluid tank = fluid_at(lattice(20, 12, l0), walls, options_with(3.1, real(0.05)));
  CHECK(largest_error(tank, [&](coord, coord y) { return y < 1.2 - 3.1 * l0; }) < 1e-12);
}

TEST_CASE("n = n0 round a thick plate, but for its corners", "[unit][walls]") {
  const auto walls = walls_of({segment(-1, 0, 3, 0), segment(0.8, 0, 0.8, 3, 1), segment(1, 0, 1, 3, 1)});
  Positions left = lattice(8, 12, l0);
  const Positions right = lattice(10, 12, l0, 1.0);
  left.insert(left.end(), right.begin(), right.end());
  const Fluid tank = fluid_at(left, walls, options_with(3.1, real(0.05)));
  const double error =
      largest_error(tank, [&](coord x, coord y) { return y < 1.2 - 3.1 * l0 && x > 3.1 * l0 && x < 2 - 3.1 * l0; });
  CHECK(error < 1e-12);
}

TEST_CASE("nothing is seen through a plate, and round its free end it is", "[unit][walls]") {
  const auto plate = walls_of({segment(1, 0, 1, 1)});
  const Positions low{{0.95, 0.5, 0}, {1.05, 0.5, 0}}, high{{0.95, 1.05, 0}, {1.05, 1.05, 0}};
  CHECK(fluid_at(low, plate, options_with(3.1, 0)).rows.near.entries == 0);
  CHECK(fluid_at(low, plate, options_with(3.1, 0)).rows.images.entries == 2);  // each its own image
  CHECK(fluid_at(high, plate, options_with(3.1, 0)).rows.near.entries == 2);
  CHECK(fluid_at(high, plate, options_with(3.1, 0)).rows.images.entries == 0);
}

TEST_CASE("a plate in 3-D is wet on both sides, and seen round at its three free edges", "[unit][walls]") {
  // The rectangle x = 1, 0 < y < 1, 0 < z < 1 on the floor z = 0; twins on both sides of it.
  WallFaces walls{3, {}, {{"floor"}, {"plate"}}};
  add_rectangle(walls, {-1, -1, 0}, {3, -1, 0}, {3, 3, 0}, {-1, 3, 0}, 0);
  add_rectangle(walls, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}, 1);
  FluidOptions options = options_with(3.1, 0);
  options.dim = 3;
  const auto twins = [&](coord y, coord z) { return fluid_at({{0.95, y, z}, {1.05, y, z}}, walls, options); };
  CHECK(twins(0.5, 0.5).rows.near.entries == 0);
  CHECK(twins(0.5, 0.5).rows.images.entries == 2);   // each its own image
  CHECK(twins(0.5, 0.05).rows.images.entries == 6);  // and in the floor, and in the corner
  for (const auto& [y, z] : {std::pair{0.5, 1.05}, std::pair{-0.05, 0.5}, std::pair{1.05, 0.5}}) {
    CHECK(twins(y, z).rows.near.entries == 2);
    CHECK(twins(y, z).rows.images.entries == 0);
  }
}

TEST_CASE("nothing is seen by way of a corner through the wall that ends it", "[unit][walls]") {
  // A trough of 60 degrees along z; the wall z = 1 parts it. Whoever sees an image by way of the part's own walls only.
  const WallFaces open = drawn_up(wedge(M_PI / 3, 3), 2);
  WallFaces trough = open;
  trough.faces.push_back(triangle({0, 0, 1}, {3, 0, 1}, {3 * std::cos(M_PI / 3), 3 * std::sin(M_PI / 3), 1}));
  FluidOptions options = options_with(3.1, 0);
  options.dim = 3;
  const Positions both{{0.1, 0.05, 0.95}, {0.1, 0.06, 1.05}};
  const Fluid parted = fluid_at(both, trough, options);
  const Fluid alone = fluid_at({both[0]}, trough, options);
  CHECK(fluid_at(both, open, options).rows.near.entries == 2);
  CHECK(parted.rows.near.entries == 0);
  CHECK(parted.rows.images.entries % 2 == 0);
  CHECK(host(alone.rows.images.number)(0) == host(parted.rows.images.number)(0));  // the other one adds nothing
}

TEST_CASE("an image by way of the floor is not seen through a plate that stands on it", "[unit][walls]") {
  // Mirror twins beside the foot: the way by the floor meets the plate exactly at its foot.
  const auto walls = walls_of({segment(0, 0, 2, 0), segment(1, 0, 1, 1)});
  const Fluid fluid = fluid_at({{0.95, 0.05, 0}, {1.05, 0.05, 0}}, walls, options_with(3.1, 0));
  CHECK(fluid.rows.near.entries == 0);
  CHECK(fluid.rows.images.entries == 2 * 3);  // each its own image in floor, plate and corner
}

TEST_CASE("sight is mutual to the last bit", "[unit][walls]") {
  const auto walls =
      walls_of({segment(0, 0, 2, 0), segment(0, 0, 0, 2), segment(2, 2, 2, 0), segment(0.9, 0, 0.9, 0.7, 1),
                segment(0.9, 0.7, 1.13, 0.7, 1), segment(1.13, 0, 1.13, 0.7, 1), segment(0.5, 1, 0.8, 1.4, 2)});
  Positions x = random_cloud(1500, 2, 12, 2);
  x.erase(std::remove_if(x.begin(), x.end(), [](const auto& p) { return p[0] > 0.9 && p[0] < 1.13 && p[1] < 0.7; }),
          x.end());
  const Fluid fluid = fluid_at(x, walls, options_with(3.1, real(0.05)));
  const auto rows = entries_of(fluid);
  std::map<std::array<int, 3>, std::array<double, 2>> seen;
  for (int i = 0; i < fluid.particles.count; ++i)
    for (const Entry& entry : rows[i])
      if (entry.mirror >= 0) seen[{i, entry.j, entry.mirror}] = {entry.share, entry.weight};
  REQUIRE(seen.size() > 1000);
  const auto mirrors = host(fluid.walls.mirror);
  for (const auto& [who, w] : seen) {
    const auto back = seen.find({who[1], who[0], mirrors(who[2]).reverse});
    REQUIRE(back != seen.end());
    CHECK(back->second == w);
  }
}

TEST_CASE("walls on one line that touch are one", "[unit][walls]") {
  const auto walls = walls_of({segment(0, 0, 1, 0), segment(0, 0, 0, 1), segment(3, 0, 2, 0, 1), segment(1, 0, 2, 0)});
  const WallPanels made = find_panels(walls, 1e-9);
  CHECK(made.panels.size() == 2);
  CHECK(made.mirrors.size() == 3);
}

TEST_CASE("a scene without walls holds no memory for them", "[unit][walls]") {
  const Fluid fluid = fluid_at(random_cloud(50, 2, 1));
  CHECK(fluid.walls.mirror.extent(0) + fluid.walls.panel.extent(0) == 0);
  CHECK(fluid.rows.images.first.extent(0) + fluid.rows.images.number.extent(0) == 0);
}
