// Particles that are spread evenly before a run: round and sloped shapes, gaps that no lattice fits into, bodies, space that
// repeats itself; what is in a room; and how calm the water is that begins so.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "app/build.hpp"
#include "app/build_coupling.hpp"
#include "app/fill.hpp"
#include "app/rim.hpp"
#include "app/room.hpp"
#include "core/check.hpp"
#include "tests/case_text.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double l0 = 0.02;  // [m]

std::string flat_scene(const std::string& region, const std::string& more = "") {
  return "format = 1\n[case]\nname = \"s\"\n[time]\nend = 0.1\n"
         "[geometry.tank]\ntype = \"box\"\nmin = [0, 0]\nmax = [1, 0.8]\n"
         "[[fluid]]\npacking = \"relaxed\"\nregion = { " +
         region + " }\n[mps]\nspacing = 0.02\ntime_step = 1e-3\n" + more;
}

std::string deep_scene(const std::string& region, const std::string& more = "") {
  return "format = 1\n[case]\nname = \"s\"\ndimension = 3\n[time]\nend = 0.1\n"
         "[geometry.tank]\ntype = \"box\"\nmin = [0, 0, 0]\nmax = [0.4, 0.3, 0.4]\n"
         "[[fluid]]\npacking = \"relaxed\"\nregion = { " +
         region + " }\n[mps]\nspacing = 0.02\ntime_step = 1e-3\n" + more;
}

std::string outline(const std::string& name, const std::vector<Point>& points) {
  std::string text = "[geometry." + name + "]\ntype = \"polyline\"\nclosed = true\npoints = [";
  for (const Point& x : points) text += text_of('[', x[0], ", ", x[1], "], ");
  return text + "]\n";
}

constexpr int sides = 36;
constexpr double radius = 0.1;  // [m] of the cylinder, a polygon

std::string cylinder(double x = 0.5, double y = 0.3) {
  std::vector<Point> points;
  for (int k = 0; k < sides; ++k) {
    const double turn = 2 * std::numbers::pi * k / sides;
    points.push_back({x + radius * std::cos(turn), y + radius * std::sin(turn), 0});
  }
  return outline("cylinder", points);
}

const double cylinder_area = sides * radius * radius * std::sin(2 * std::numbers::pi / sides) / 2;
const std::string round_cylinder = R"(type = "box", min = [0, 0], max = [1, 0.6], without = ["cylinder"])";

const std::string on_slope = R"(type = "box", min = [0, 0], max = [1, 0.6], without = ["slope"])";
const std::string slope = outline("slope", {{0, 0, 0}, {1, 0, 0}, {1, 0.37, 0}});

/// The start of a scene, with its rim in place: who is there, how uneven n is, and how near to walls.
struct Start {
  explicit Start(const Scene& scene) : room(scene) {
    WallFaces walls = build_walls(scene);
    const auto structures = build_structures(scene);
    add_wet_surfaces(scene, structures, walls);
    Fluid fluid = build_fluid(scene, walls, &packing);
    const WallFaces closed = with_rim(scene, walls);
    make_mirror_walls(fluid.walls, closed, fluid.grid.shape(), fluid.spacing);
    settle_rows(fluid);
    n = unevenness_of(fluid);
    const auto x = host(fluid.particles.position);
    for (int i = 0; i < fluid.particles.count; ++i) {
      places.push_back({x(i, 0), x(i, 1), scene.dimension == 3 ? x(i, 2) : 0});
      if (!room.holds(places.back())) ++outside;
      for (const WallFace& face : closed.faces)
        nearest = std::min(nearest, distance_to_face(corners_of(face), closed.dim, places.back()) / fluid.spacing);
    }
  }

  Room room;
  Packing packing;
  Unevenness n;
  std::vector<Point> places;
  int outside = 0;
  double nearest = 1;  // x spacing, of all walls and the rim
};

struct Wish {
  double measure;    // of the room, by a formula [m^2, m^3]
  double rms, most;  // of n
  double gap = 0.3;  // of the nearest particle to a wall, x spacing
};

Start check_start(const std::string& name, const std::string& text, const Wish& wish) {
  INFO(name);
  const Scene scene = scene_of_text(text);
  const Start start(scene);
  const double wanted = wish.measure / std::pow(scene.mps.spacing, scene.dimension);
  std::cout << name << ": " << start.places.size() << " particles, room for " << wanted << ", " << start.packing.sweeps
            << " sweeps, n off by " << start.n.rms << " rms, " << start.n.most << " at most; nearest to a wall "
            << start.nearest << " l0\n";
  CHECK(std::fabs(static_cast<double>(start.places.size()) - wanted) <= 0.5 + 0.1);
  CHECK(start.n.rms < wish.rms);
  CHECK(start.n.most < wish.most);
  CHECK(start.n.rms == Approx(start.packing.after.rms).epsilon(1e-6));
  CHECK(start.outside == 0);
  CHECK(start.nearest > wish.gap);
  return start;
}

/// Of the particles nearer than a spacing to the level: how many, and the rms of their depth less half a spacing [l0].
std::pair<int, double> first_row(const std::vector<Point>& places, int up, double level, double spacing) {
  int count = 0;
  double squares = 0;
  for (const Point& x : places) {
    const double depth = (level - x[up]) / spacing;
    if (depth > 1) continue;
    ++count;
    squares += (depth - 0.5) * (depth - 0.5);
  }
  return {count, std::sqrt(squares / std::max(count, 1))};
}

/// The fastest particle until `end`, and who was stopped at walls.
struct Calm {
  double fastest = 0;
  std::int64_t stopped = 0;
};
Calm calm_of(const Scene& scene, double end) {
  FluidSimulation simulation(scene);
  Calm calm;
  while (simulation.time() < end * (1 - 1e-9)) {
    simulation.step();
    const StepFacts facts = simulation.facts();
    calm.fastest = std::max(calm.fastest, facts.max_speed);
    for (const Notice& notice : facts.notices)
      if (notice.kind == "crossing") calm.stopped += notice.count;
  }
  return calm;
}

}  // namespace

TEST_CASE("a disc and a ball are packed evenly up to their rim", "[unit][packing]") {
  const double pi = std::numbers::pi;
  const Start disc =
      check_start("disc", flat_scene(R"(type = "ball", centre = [0.5, 0.4], radius = 0.2)"), {pi * 0.04, 0.02, 0.1});
  int at_rim = 0;
  for (const Point& x : disc.places) at_rim += std::hypot(x[0] - 0.5, x[1] - 0.4) > 0.2 - l0;
  CHECK(at_rim == Approx(2 * pi * (0.2 - l0 / 2) / l0).epsilon(0.07));  // a row of its own, half a spacing inside
  check_start("ball", deep_scene(R"(type = "ball", centre = [0.2, 0.15, 0.2], radius = 0.13)"),
              {4.0 / 3 * pi * 0.13 * 0.13 * 0.13, 0.02, 0.14});
}

TEST_CASE("a disc that touches its tank is packed too", "[unit][packing]") {
  check_start("touching disc", flat_scene(R"(type = "ball", centre = [0.2, 0.2], radius = 0.2)"),
              {std::numbers::pi * 0.04, 0.025, 0.1});
}

TEST_CASE("water is packed evenly where a lattice would be cut", "[unit][packing]") {
  check_start("slope", flat_scene(on_slope, slope), {0.6 - 0.37 / 2, 0.01, 0.08});
  check_start("cylinder", flat_scene(round_cylinder, cylinder()), {0.6 - cylinder_area, 0.01, 0.05});
  const std::string plate = "[geometry.plate]\ntype = \"plate\"\nthickness = 0\nheight = 0.3\nangle = \"20 deg\"\n";
  check_start("leaning plate", flat_scene("min = [0, 0], max = [1, 0.4]", plate + "base = [0.4, 0]\n"),
              {0.4, 0.015, 0.1});
  check_start("leaning plate in 3-D",
              deep_scene("min = [0, 0, 0], max = [0.4, 0.3, 0.35]", plate + "base = [0.2, 0.15, 0]\nwidth = 0.1\n"),
              {0.4 * 0.3 * 0.35, 0.02, 0.14, 0.15});  // beside its free edge nothing pushes
}

TEST_CASE("gaps that the lattice does not fit into are filled, in rows", "[unit][packing]") {
  const std::string gap =
      "format = 1\n[case]\nname = \"s\"\n[time]\nend = 0.1\n"
      "[geometry.tank]\ntype = \"box\"\nmin = [0, 0]\nmax = [0.39, 1]\n"
      "[[fluid]]\npacking = \"relaxed\"\nregion = { min = [0, 0], max = [0.39, 0.213] }\n"
      "[mps]\nspacing = 0.02\ntime_step = 1e-3\n";
  const Start start = check_start("gap", gap, {0.39 * 0.213, 0.01, 0.02});
  const auto [count, off] = first_row(start.places, 1, 0.213, l0);
  CHECK(count == Approx(0.39 / l0).margin(1.5));
  CHECK(off < 0.1);
}

TEST_CASE("a lattice that fits stays as it is", "[unit][packing]") {
  const Scene relaxed = scene_of_text(flat_scene("min = [0, 0], max = [1, 0.6]"));
  Scene lattice = relaxed;
  lattice.fluid.packing = "lattice";
  auto x = Start(relaxed).places, y = fill(lattice);
  REQUIRE(x.size() == y.size());
  std::sort(y.begin(), y.end());
  for (const Point& at : x) {
    const auto nearest = std::min_element(y.begin(), y.end(), [&](const Point& a, const Point& b) {
      return std::hypot(a[0] - at[0], a[1] - at[1]) < std::hypot(b[0] - at[0], b[1] - at[1]);
    });
    CHECK(std::hypot((*nearest)[0] - at[0], (*nearest)[1] - at[1]) < 1e-4 * l0);
  }
}

TEST_CASE("water round an elastic beam, and where space repeats itself, is packed evenly", "[unit][packing]") {
  const std::string beam =
      "[[structure]]\nname = \"beam\"\nheight = 0.3\nthickness = 0.031\nbase = [0.43, 0]\n"
      "base_side = \"centre\"\nyoung = 6e6\ndensity = 1100\npoisson = 0.4\n[structure.fem]\n"
      "divisions = [2, 12]\n";
  // As high as the water is deep: its tip is a part of the surface.
  check_start("beam", flat_scene("min = [0, 0], max = [1, 0.3]", beam), {0.3 - 0.3 * 0.031, 0.015, 0.1});
  const std::string channel =
      "format = 1\n[case]\nname = \"s\"\n[time]\nend = 0.1\n"
      "[domain]\nmin = [0, -0.1]\nmax = [0.99, 0.9]\nperiodic = [\"x\"]\n"
      "[geometry.bed]\ntype = \"polyline\"\npoints = [[0, 0], [0.99, 0]]\n"
      "[[fluid]]\npacking = \"relaxed\"\n"
      "region = { min = [0, 0], max = [0.99, 0.6], without = [\"cylinder\"] }\n"
      "[mps]\nspacing = 0.02\ntime_step = 1e-3\n";
  check_start("channel", channel + cylinder(), {0.99 * 0.6 - cylinder_area, 0.01, 0.05});
}

TEST_CASE("a room is measured to a fraction of a particle", "[unit][packing]") {
  const auto measure = [](const std::string& text) { return Room(scene_of_text(text)).measure(); };
  CHECK(measure(flat_scene("min = [0, 0], max = [1, 0.6]")) == Approx(0.6).epsilon(1e-12));
  CHECK(std::fabs(measure(flat_scene(round_cylinder, cylinder())) - (0.6 - cylinder_area)) < 0.05 * l0 * l0);
  CHECK(std::fabs(measure(flat_scene(on_slope, slope)) - (0.6 - 0.185)) < 0.05 * l0 * l0);
  const std::string thin = "[geometry.plate]\ntype = \"plate\"\nbase = [0.4, 0]\nheight = 0.3\nthickness = 0\n";
  CHECK(measure(flat_scene("min = [0, 0], max = [1, 0.6]", thin)) == Approx(0.6).epsilon(1e-12));
  const Room room(scene_of_text(flat_scene(round_cylinder, cylinder())));
  CHECK(room.in_solid({0.5, 0.3, 0}));
  CHECK(!room.holds({0.5, 0.3, 0}));
  CHECK(room.holds({0.5, 0.45, 0}));
  CHECK(!room.holds({0.5, 0.61, 0}));
  CHECK(room.edge_within({0.5, 0.41, 0}, 0.0101));
  CHECK(!room.edge_within({0.5, 0.41, 0}, 0.0099));
}

TEST_CASE("nobody begins in a solid where the lattice has a point on its edge", "[unit][packing]") {
  for (const std::string packing : {"lattice", "relaxed"}) {
    const Scene scene = scene_of_text(flat_scene(round_cylinder, cylinder(0.51, 0.31)),  // four corners on the lattice
                                      {set_option("fluid.0.packing=\"" + packing + "\"")});
    const Start start(scene);
    for (const Point& x : start.places)
      CHECK(std::hypot(x[0] - 0.51, x[1] - 0.31) > radius * std::cos(std::numbers::pi / sides));
    if (packing == "relaxed") CHECK(start.n.most < 0.05);
  }
}

TEST_CASE("what is packed can be shaken, the same every time and through no wall", "[unit][packing]") {
  const Scene still = scene_of_text(flat_scene(round_cylinder, cylinder()));
  Scene shaken = still;
  shaken.fluid.jitter = 0.3;
  const Start a(still), b(shaken), c(shaken);
  CHECK(b.places == c.places);
  CHECK(b.outside == 0);
  CHECK(b.places.size() == a.places.size());
  CHECK(b.n.rms > 3 * a.n.rms);
}

TEST_CASE("the lattice knows what the fluid is without", "[unit][packing]") {
  Scene scene = scene_of_text(flat_scene(round_cylinder, cylinder()));
  scene.fluid.packing = "lattice";
  const auto points = fill(scene);
  CHECK(points.size() < 1500 - 60);
  for (const Point& x : points) CHECK(std::hypot(x[0] - 0.5, x[1] - 0.3) > radius * std::cos(std::numbers::pi / sides));
}

TEST_CASE("packing and what a region is without are read strictly", "[unit][case]") {
  const std::string words = flat_scene(round_cylinder, cylinder());
  CHECK_THROWS_WITH(scene_of_text(words, {set_option("fluid.0.packing=\"dense\"")}), Catch::Contains("packing"));
  CHECK_THROWS_WITH(scene_of_text(words, {set_option("fluid.0.region.without=[\"tank\"]")}),
                    Catch::Contains("without"));
  CHECK_THROWS_WITH(scene_of("hydrostatic/turned.toml", {"fluid.0.packing=\"lattice\""}),
                    Catch::Contains("no lattice fits into \"tank\""));
  CHECK(scene_of("hydrostatic/turned.toml").fluid.packing == "relaxed");
  CHECK(scene_of_text(words).fluid.without == std::vector<std::string>{"cylinder"});
}

TEST_CASE("water that is packed begins calmly", "[stability][packing]") {
  for (const auto& [name, text, limit] :
       {std::tuple{"cylinder", flat_scene(round_cylinder, cylinder(0.507, 0.303)), 0.01},
        std::tuple{"slope", flat_scene(on_slope, slope), 0.01}}) {
    INFO(name);
    const Scene relaxed = scene_of_text(text);
    Scene lattice = relaxed;
    lattice.fluid.packing = "lattice";
    const Calm before = calm_of(lattice, 0.1), now = calm_of(relaxed, 0.1);
    std::cout << name << ": fastest within 0.1 s " << before.fastest << " m/s from the lattice, " << now.fastest
              << " m/s spread; stopped at walls " << before.stopped << " and " << now.stopped << '\n';
    CHECK(now.fastest < limit);
    CHECK(now.fastest < before.fastest / 5);
    CHECK(now.stopped == 0);
  }
}
