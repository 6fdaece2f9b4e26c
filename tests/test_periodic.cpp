// Space that repeats itself: rows against brute force with the shortest ways, walls that go on beyond the edge, pressure that
// nothing holds, and what a case must not ask for.
#include <cmath>
#include <map>

#include "app/build_walls.hpp"
#include "app/fluid_simulation.hpp"
#include "core/check.hpp"
#include "kernels/pressure_solver.hpp"
#include "tests/case_text.hpp"
#include "tests/runs.hpp"
#include "tests/still_water.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

using Row = std::map<int, double>;  // neighbour's id -> weight

FluidOptions repeating(int dim, const std::array<coord, 3>& period) {
  FluidOptions options = standard(dim, dim == 2 ? 3.1 : 2.1);
  options.period = period;
  return options;
}

std::vector<Row> brute_force(const Positions& x, const std::array<coord, 3>& period, const Weight& w) {
  std::vector<Row> rows(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) {
      double r2 = 0;
      for (int d = 0; d < 3; ++d) {
        const double way = x[j][d] - x[i][d];
        const double shortest = period[d] > 0 ? way - period[d] * std::round(way / period[d]) : way;
        r2 += shortest * shortest;
      }
      const double weight = w(std::sqrt(r2));
      if (i != j && weight > 0) rows[i][static_cast<int>(j)] = weight;
    }
  return rows;
}

std::vector<Row> rows_of(const Fluid& fluid) {
  const auto id = host(fluid.particles.id);
  const auto entries = entries_of(fluid);
  std::vector<Row> rows(fluid.particles.count);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (const Entry& entry : entries[i]) REQUIRE(rows[id(i)].emplace(id(entry.j), entry.weight).second);
  return rows;
}

void same_as_brute_force(const Fluid& fluid, const Positions& x, const std::array<coord, 3>& period) {
  const auto expected = brute_force(x, period, fluid.laplacian.weight);
  const auto found = rows_of(fluid);
  for (std::size_t i = 0; i < x.size(); ++i) {
    REQUIRE(found[i].size() == expected[i].size());
    for (const auto& [j, w] : expected[i]) {
      REQUIRE(found[i].count(j) == 1);
      CHECK(std::fabs(found[i].at(j) - w) <= 6.0e-8 * w + 1e-12);  // rounded to a float
    }
  }
}

// A flow of one wave in a box that repeats itself; its walls, where it has any, go on for ever.
std::string box(const std::string& more = "") {
  return "format = 1\n[case]\nname = \"b\"\n[time]\nend = 0.02\ngravity = [0, 0]\n"
         "[domain]\nmin = [0, 0]\nmax = [1, 1]\nperiodic = [\"x\", \"y\"]\n"
         "[[fluid]]\nregion = { type = \"box\", min = [0, 0], max = [1, 1] }\n"
         "velocity = [\"-cos(2*pi*x)*sin(2*pi*y)\", \"sin(2*pi*x)*cos(2*pi*y)\"]\n"
         "[mps]\nspacing = 0.05\ntime_step = 0.01\n" +
         more;
}

std::string channel(const std::string& more = "", const std::string& length = "1") {
  return "format = 1\n[case]\nname = \"c\"\n[time]\nend = 0.02\ngravity = [1, 0]\n"
         "[domain]\nmin = [0, -0.2]\nmax = [1, 1]\nperiodic = \"x\"\n"
         "[geometry.floor]\ntype = \"polyline\"\npoints = [[0, 0], [" +
         length +
         ", 0]]\n"
         "[[fluid]]\nregion = { type = \"box\", min = [0, 0], max = [1, 0.5] }\n"
         "[mps]\nspacing = 0.05\ntime_step = 0.001\n" +
         more;
}

}  // namespace

TEST_CASE("rows in a space that repeats itself are those of the shortest ways", "[unit][periodic]") {
  for (const int dim : {2, 3}) {
    INFO(dim << "-D");
    const std::array<coord, 3> period =
        dim == 2 ? std::array<coord, 3>{1.5, 1.3, 0} : std::array<coord, 3>{1.0, 0, 0.93};
    Positions x = random_cloud(dim == 2 ? 300 : 600, dim, 5);
    for (auto& point : x)
      for (int d = 0; d < dim; ++d)
        if (period[d] > 0) point[d] *= period[d];
    Fluid fluid = fluid_at(x, {}, repeating(dim, period));
    REQUIRE(fluid.particles.count == static_cast<int>(x.size()));
    same_as_brute_force(fluid, x, period);
    RowOptions portable = row_options(fluid);  // as on a GPU
    portable.portable = true;
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, portable);
    same_as_brute_force(fluid, x, period);
  }
}

TEST_CASE("who leaves on one side comes in on the other", "[unit][periodic]") {
  const std::array<coord, 3> period{1.5, 0, 0};
  const Fluid fluid = fluid_at({{-0.1, 0.2, 0}, {1.5, 0.3, 0}, {4.6, 0.4, 0}, {0.7, 0.5, 0}}, {}, repeating(2, period));
  REQUIRE(fluid.particles.count == 4);
  const auto x = host(fluid.particles.position);
  const auto id = host(fluid.particles.id);
  const coord expected[] = {1.4, 0, 0.1, 0.7};
  for (int i = 0; i < 4; ++i) CHECK(x(i, 0) == Approx(expected[id(i)]).margin(1e-12));
}

TEST_CASE("the edge of a period is nowhere: a channel moved along itself sees the same", "[unit][periodic]") {
  const std::array<coord, 3> period{1.5, 0, 0};
  const Positions start = lattice(15, 6, l0, 0, 0, 0.2);
  WallFaces walls = walls_of({segment(0, 0, 1.5, 0), segment(-1.5, 0, 0, 0), segment(1.5, 0, 3, 0)});
  std::vector<double> n, shift;
  for (const coord by : {0.0, 0.4321}) {
    Positions x = start;
    for (auto& point : x) point[0] += by;
    Fluid fluid = fluid_at(x, walls, repeating(2, period));
    fluid.gravity[1] = -g;
    set_velocity(fluid, [&](const auto& at) {
      return std::array<double, 3>{std::sin(2 * M_PI * (at[0] - by) / 1.5), std::cos(4 * M_PI * (at[0] - by) / 1.5), 0};
    });
    const Survey found = surveyed(fluid);
    const auto density = by_id(fluid, fluid.particles.number_density), rhs = by_id(fluid, found.rhs);
    if (by == 0) {
      n = density;
      shift = rhs;
      continue;
    }
    const double scale = *std::max_element(shift.begin(), shift.end());
    for (std::size_t i = 0; i < n.size(); ++i) {
      CHECK(density[i] == Approx(n[i]).epsilon(1e-9));
      CHECK(rhs[i] == Approx(shift[i]).margin(1e-5 * scale));  // weights are kept as floats
    }
  }
}

TEST_CASE("where nothing holds the pressure, the one without a mean is found", "[unit][periodic][pressure]") {
  for (const bool fits : {false, true}) {
    INFO((fits ? "high" : "default"));
    Fluid fluid = fluid_at(lattice(20, 20, l0, 0, 0, 0.1), {}, repeating(2, {2, 2, 0}));
    set_velocity(fluid, [](const auto& x) {
      return std::array<double, 3>{std::sin(M_PI * x[0]), 0.3 * std::cos(M_PI * x[1]), 0};
    });
    const auto table = make_lattice_table(fluid.gradient.weight, 2, fluid.spacing);
    if (fits) fit_neighbourhoods(fluid, table);
    Survey found;
    SurveyOptions options;
    options.drift_speed = 1;  // errors of n have a mean
    survey(fluid, table, options, dt, found);
    REQUIRE(found.closed);
    PressureSystem system({});
    system.assemble(fluid, found.rhs, found.diagonal, found.fixed);
    if (fits) {
      weigh_rows(fluid, found);
      system.replace_rows(fluid.fits.weight, fluid.fits.diagonal);
    }
    system.close();
    const SolveReport report = make_pressure_solver({})->solve(system, fluid.particles.pressure);
    CHECK(report.converged);
    CHECK(report.recovery.empty());
    CHECK(report.iterations < 30);
    const auto p = host(fluid.particles.pressure);
    double mean = 0, largest = 0;
    for (int i = 0; i < fluid.particles.count; ++i) {
      mean += p(i) / fluid.particles.count;
      largest = std::max(largest, std::fabs(static_cast<double>(p(i))));
    }
    CHECK(largest > 1);
    CHECK(std::fabs(mean) < 1e-9 * largest);
  }
}

TEST_CASE("a box that repeats itself keeps its momentum", "[unit][periodic]") {
  FluidSimulation simulation(scene_of_text(box()));
  while (simulation.time() < 0.02) simulation.step();
  const auto u = host(simulation.fluid().particles.velocity);
  double sum[2] = {}, all = 0;
  const int count = simulation.fluid().particles.count;
  CHECK(count == 400);
  for (int i = 0; i < count; ++i)
    for (int d = 0; d < 2; ++d) {
      sum[d] += u(i, d);
      all += std::fabs(u(i, d));
    }
  for (const double s : sum) CHECK(std::fabs(s) < 1e-9 * all);  // by the symmetry of the start
}

TEST_CASE("a channel without friction falls along itself", "[unit][periodic]") {
  for (const char* scheme : {"default", "high", "classic"}) {
    INFO(scheme);
    FluidSimulation simulation(scene_of_text(channel("scheme = \"" + std::string(scheme) + "\"\n")));
    CHECK(simulation.wall_shapes().size() == 1);  // once, however often it is repeated
    while (simulation.time() < 0.019) simulation.step();
    const auto u = host(simulation.fluid().particles.velocity);
    const int count = simulation.fluid().particles.count;
    CHECK(count == 200);
    for (int i = 0; i < count; ++i) {
      CHECK(u(i, 0) == Approx(simulation.time()).epsilon(1e-6));
      CHECK(std::fabs(u(i, 1)) < 1e-3 * simulation.time());  // weights are kept as floats
    }
  }
}

TEST_CASE("to come in on the other side is no long way, and undoes no step", "[unit][periodic][undo]") {
  Scene scene = scene_of_text(channel());
  scene.fluid.velocity.text = {"3", "0", "0"};
  FluidSimulation simulation(scene);
  const auto start = places_of(simulation);
  while (simulation.time() < 0.019) simulation.step();
  for (const Notice& notice : simulation.facts().notices) CHECK(notice.kind != "undone");
  double least = 1;
  for (const Point& x : places_of(simulation)) least = std::min(least, x[0]);
  CHECK(least == Approx(0.032).margin(1e-3));  // those that have come in at the left
  CHECK(simulation.steps() == 19);
}

TEST_CASE("what a domain that repeats itself cannot have is told before any work", "[unit][periodic][case]") {
  const auto complaint = [](const std::string& text) {
    try {
      scene_of_text(text);
    } catch (const CaseError& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  CHECK(complaint(box()) == "none");
  CHECK(complaint(channel()) == "none");
  CHECK(complaint(replaced(box(), "spacing = 0.05", "spacing = 0.052")).find("take spacing = 0.0526316") !=
        std::string::npos);
  CHECK(complaint(replaced(box(), "spacing = 0.05", "spacing = 0.1")).find("more than 4 times as much") !=
        std::string::npos);
  CHECK(complaint(channel("", "1.2")).find("end it at the edges") != std::string::npos);
  CHECK(complaint(channel("[geometry.floor.motion]\nrotation = \"t\"\nabout = [0, 0]\n")).find("let it only shift") !=
        std::string::npos);
  CHECK(complaint(channel("[geometry.tank]\ntype = \"box\"\nmin = [0, -0.1]\nmax = [1, 0.9]\nopen = [\"right\"]\n"))
            .find("open = [\"left\"]") != std::string::npos);
}
