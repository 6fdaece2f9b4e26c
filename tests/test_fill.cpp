// Where particles are at the start.

#include "app/fill.hpp"
#include "core/check.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double l0 = 0.02;  // [m] of the scenes below

Scene flat(std::vector<std::string> settings = {}) {
  settings.insert(settings.begin(), {"mps.spacing=0.02", "mps.expected_particles=0"});
  return scene_of("dam_break_rigid/quick.toml", settings);
}

Scene deep(std::vector<std::string> settings = {}) {
  settings.insert(settings.begin(), {"mps.spacing=0.02", "mps.expected_particles=0"});
  return scene_of("dam_break_3d/dam_break_3d.toml", settings);
}

}  // namespace

TEST_CASE("jitter moves every particle, along every axis, and not too far", "[unit][fill]") {
  for (const bool is_deep : {false, true}) {
    const int dim = is_deep ? 3 : 2;
    const auto still = fill(is_deep ? deep() : flat());
    const auto shaken = fill(is_deep ? deep({"fluid.0.jitter=0.3"}) : flat({"fluid.0.jitter=0.3"}));
    REQUIRE(shaken.size() == still.size());
    for (int d = 0; d < 3; ++d) {
      double sum = 0, squares = 0, most = 0;
      for (std::size_t i = 0; i < still.size(); ++i) {
        const double way = (shaken[i][d] - still[i][d]) / l0;
        if (d < dim) CHECK(way != 0);
        sum += way;
        squares += way * way;
        most = std::max(most, std::fabs(way));
      }
      const auto count = static_cast<double>(still.size());
      const double variance = d < dim ? 0.3 * 0.3 / 3 : 0;  // of what is uniform
      CHECK(std::fabs(sum / count) <= 4 * std::sqrt(variance / count));
      CHECK(squares / count == Approx(variance).epsilon(0.2));
      CHECK(most <= (d < dim ? 0.3 * (1 + 1e-9) : 0));
      if (d < dim) CHECK(most > 0.28);
    }
  }
}

TEST_CASE("jitter is the same every time, and on every machine", "[unit][fill]") {
  const Scene scene = flat({"fluid.0.jitter=0.25"});
  CHECK(fill(scene) == fill(scene));
  // splitmix64 from state 0 begins with these, of which 53 bits count.
  const std::uint64_t first[2] = {0xe220a8397b1dcdafU, 0x6e789e6aa1b965f4U};
  for (int d = 0; d < 2; ++d) {
    const double random = static_cast<double>(first[d] >> 11) * std::pow(2, -52) - 1;
    CHECK(fill(scene).front()[d] == Approx(l0 / 2 + 0.25 * l0 * random));
  }
}

TEST_CASE("without jitter particles are where the lattice is, to the last bit", "[unit][fill]") {
  CHECK(fill(flat()) == fill(flat({"fluid.0.jitter=0"})));
  CHECK(fill(flat()).front() == Point{0.5 * l0, 0.5 * l0, 0});
}

TEST_CASE("particles that are shaken stay in their region and out of plates", "[unit][fill]") {
  for (const Point& x : fill(flat({"fluid.0.jitter=0.499"}))) {
    CHECK((x[0] > 0 && x[0] < 0.2));
    CHECK((x[1] > 0 && x[1] < 0.4));
  }
  const std::vector<std::string> plate{"geometry.plate.base=[0.073, 0.0]", "geometry.plate.height=0.3"};
  std::vector<std::string> shaken = plate;
  shaken.emplace_back("fluid.0.jitter=0.49");
  const Scene scene = flat(shaken);
  const auto points = fill(scene), still = fill(flat(plate));
  REQUIRE(points.size() == still.size());
  const double left = 0.073, right = left + scene.plates.front().thickness;
  REQUIRE(right > left);
  int stayed = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    CHECK(!(points[i][0] > left && points[i][0] < right && points[i][1] < 0.3));
    stayed += points[i] == still[i];
  }
  CHECK(stayed > 0);
}

TEST_CASE("a ball has as many particles as its volume has room for, symmetric about its centre", "[unit][fill]") {
  for (const bool is_deep : {false, true}) {
    const int dim = is_deep ? 3 : 2;
    const double pi = std::acos(-1), radius = 0.15, cells = radius / l0;
    const Point centre = is_deep ? Point{0.5, 0.25, 0.25} : Point{0.25, 0.25, 0};
    const Scene scene = is_deep ? deep({"fluid.0.region={type=\"ball\", centre=[0.5, 0.25, 0.25], radius=0.15}"})
                                : flat({"fluid.0.region={type=\"ball\", centre=[0.25, 0.25], radius=0.15}"});
    const auto points = fill(scene);
    const double room = is_deep ? 4.0 / 3 * pi * cells * cells * cells : pi * cells * cells;
    CHECK(static_cast<double>(points.size()) == Approx(room).epsilon(0.04));
    std::set<std::array<long, 3>> found;  // in half cells from the centre
    for (const Point& x : points) {
      std::array<long, 3> at{};
      double r2 = 0;
      for (int d = 0; d < dim; ++d) {
        const double half_cells = (x[d] - centre[d]) / (l0 / 2);
        at[d] = std::lround(half_cells);
        CHECK(half_cells == Approx(at[d]));
        CHECK(at[d] % 2 != 0);
        r2 += (x[d] - centre[d]) * (x[d] - centre[d]);
      }
      CHECK(r2 < radius * radius);
      found.insert(at);
    }
    CHECK(found.size() == points.size());
    for (const auto& [i, j, k] : found) {
      CHECK(found.count({-i, j, k}) == 1);
      CHECK(found.count({j, i, k}) == 1);
      CHECK(found.count({i, j, -k}) == 1);
    }
  }
}

TEST_CASE("a ball that is shaken stays a ball", "[unit][fill]") {
  const auto points =
      fill(flat({"fluid.0.region={type=\"ball\", centre=[0.1, 0.1], radius=0.1}", "fluid.0.jitter=0.4"}));
  CHECK(points.size() == 80);
  for (const Point& x : points) CHECK(std::hypot(x[0] - 0.1, x[1] - 0.1) < 0.1);
}

TEST_CASE("a ball runs", "[unit][fill]") {
  FluidSimulation simulation(
      flat({"fluid.0.region={type=\"ball\", centre=[0.25, 0.3], radius=0.1}", "fluid.0.velocity=[1, 0]"}));
  CHECK(simulation.fluid().particles.count == 80);
  for (int k = 0; k < 3; ++k) simulation.step();
  CHECK(centroid_of(simulation)[0] == Approx(0.25 + 3 * simulation.dt()));
}
