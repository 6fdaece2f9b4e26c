// The pieces of `greenwater bench`, and the verb itself at sizes that take no time. No test looks at how long anything
// took: that is for quiet machines.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/command_line.hpp"
#include "bench/bytes.hpp"
#include "bench/triad.hpp"
#include "bench/water.hpp"
#include "core/listener.hpp"
#include "tests/program.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::bench;
using namespace greenwater::test;

namespace {

using Json = nlohmann::json;

constexpr double number = sizeof(real), place = sizeof(coord);

/// Four particles in a line along a wall; each sees the next ones, and its own and their images.
Fluid four_in_line() {
  return fluid_at({{0.05, 0.05, 0}, {0.15, 0.05, 0}, {0.25, 0.05, 0}, {0.35, 0.05, 0}},
                  walls_of({segment(-1, 0, 2, 0)}), {.radius = 1.5});
}

Counts counts_of(const Fluid& fluid) {
  Counts counts;
  counts.dim = fluid.particles.dim;
  counts.particles = fluid.particles.count;
  counts.cells = 10;
  counts.entries = static_cast<double>(fluid.rows.near.entries);
  counts.places = static_cast<double>(fluid.rows.near.stored);
  counts.image_entries = static_cast<double>(fluid.rows.images.entries);
  counts.image_places = static_cast<double>(fluid.rows.images.stored);
  return counts;
}

Traffic traffic_in(const std::string& region, const Counts& counts) {
  const auto& all = region_models();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& model) { return model.name == region; });
  REQUIRE(found != all.end());
  REQUIRE(found->traffic);
  return found->traffic(counts);
}

State small_state() {
  State state;
  state.dim = 2;
  state.steps = 7;
  state.time = 0.25;
  state.made_by = "1a2b3c4";
  state.id = {2, 0, 1};
  state.position = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  state.velocity = {1, 2, 3, 4, 5, -6e-9};
  state.pressure = {0, 1e5, 3};
  return state;
}

Json json_in(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return Json::parse(stream);
}

std::vector<std::string> missing(const Json& object, const std::vector<std::string>& keys) {
  std::vector<std::string> found;
  for (const std::string& key : keys)
    if (!object.contains(key)) found.push_back(key);
  return found;
}

const std::vector<std::string> origin_keys{"git", "kokkos", "flags", "host", "processor", "threads", "date", "backend"};
const std::vector<std::string> step_keys{"case",   "dim",      "particles", "state",         "threads",
                                         "region", "ms",       "ms_min",    "ms_max",        "ns_per_particle",
                                         "bytes",  "gb_per_s", "share",     "triad_gb_per_s"};

Answer answer_of(const std::string& command) {
  Answer answer;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe);
  char line[512];
  while (std::fgets(line, sizeof line, pipe)) answer.out += line;
  answer.code = WEXITSTATUS(pclose(pipe));
  return answer;
}

Json timed(const std::string& region, double ms, double quarter, int iterations) {
  return {{"case", "c"},
          {"dim", 2},
          {"particles", 10},
          {"state", "rest"},
          {"threads", 1},
          {"region", region},
          {"inside", ""},
          {"ms", ms},
          {"ms_q1", ms - quarter},
          {"ms_q3", ms + quarter},
          {"iterations", iterations}};
}

std::string results_text(const std::string& git, const std::vector<Json>& rows) {
  const Json all{{"greenwater_bench", 1}, {"origin", {{"git", git}}}, {"rows", rows}};
  return all.dump();
}

}  // namespace

TEST_CASE("quantiles of few values", "[unit][bench]") {
  const Spread spread = spread_of({4, 1, 3, 2, 5});
  CHECK(spread.median == 3);
  CHECK(spread.low == 1);
  CHECK(spread.high == 5);
  CHECK(spread.q1 == 2);
  CHECK(spread.q3 == 4);
  CHECK(spread_of({1, 2}).median == Approx(1.5));
  CHECK(spread_of({}).median == 0);
}

TEST_CASE("the triad moves as much as a computer can", "[unit][bench]") {
  const Spread rate = spread_of(triad(1e6));
  CHECK(rate.median > 0.01);  // GB/s: slower than any disk
  CHECK(rate.median < 1e5);   // faster than any memory
  CHECK(rate.low <= rate.median);
  CHECK(rate.median <= rate.high);
  Triads triads;
  triads.at(1e5);
  triads.at(1.01e5);  // near enough to share one
  triads.at(1e6);
  CHECK(triads.all().size() == 2);
  triads.measure(1e6);  // more samples, no other size
  CHECK(triads.all().size() == 2);
}

TEST_CASE("launches and memory are heard", "[unit][bench]") {
  Listener listener;
  const auto before = listener.bytes();
  {
    const ScalarField field("greenwater::test_field", 1000);
    CHECK(listener.bytes() - before >= static_cast<std::int64_t>(1000 * sizeof(real)));
    for (int k = 0; k < 3; ++k)
      Kokkos::parallel_for(
          "greenwater::test_launch", Range(0, 1000), KOKKOS_LAMBDA(const int i) { field(i) = 1; });
  }
  CHECK(listener.bytes() == before);
  CHECK(listener.launches("greenwater::test_launch") == 3);
  CHECK(listener.launches() >= 3);
  listener.forget_launches();
  CHECK(listener.launches() == 0);
}

TEST_CASE("bytes of four particles in a line, counted by hand", "[unit][bench]") {
  const Counts counts = counts_of(four_in_line());
  REQUIRE(counts.particles == 4);
  REQUIRE(counts.entries == 6);             // 1 2 2 1
  REQUIRE(counts.places == 4 * row_lanes);  // with the images of others: 2 4 4 2
  REQUIRE(counts.image_entries == 10);      // with its own: 2 3 3 2
  REQUIRE(counts.image_places == 3 * row_lanes);
  const double chunk = 8 + 4, numbers = 4 * 4;
  const double x = 4 * 2 * place, vector = 4 * 2 * number, scalar = 4 * number, sums = 4 * 8, surface = 4;
  const double near = chunk + numbers + 6 * 4;
  const double images = chunk + numbers + 3 * row_lanes * 4 + 10 * (4 + number);
  const double around = near + images + x;

  CHECK(traffic_in("predict", counts).moved == 2 * x + 3 * vector);
  CHECK(traffic_in("predict", counts).touched == x + 2 * vector);
  CHECK(traffic_in("rows", counts).moved ==
        x + 10 * 4 + chunk + numbers + sums + 4 * row_lanes * (4 + 4) + images + scalar);
  CHECK(traffic_in("viscosity", counts).moved == around + vector + 2 * vector);
  CHECK(traffic_in("gradient", counts).moved == around + 6 * 4 + scalar + vector);
  CHECK(product_traffic(counts, false).moved == around + surface + 3 * scalar);
  const double kept = chunk + 4 * row_lanes * (4 + 4) + surface + 3 * scalar;
  CHECK(product_traffic(counts, true).moved == kept);

  Counts more = counts;
  more.iterations = 10;
  const double ten = traffic_in("pressure", more).moved - traffic_in("pressure", counts).moved;
  CHECK(ten == Approx(10 * (kept + 13 * scalar)));  // (d, d); z + b d; p + a d, r - a q; r / diagonal
  more.walls = false;
  CHECK(traffic_in("gradient", more).moved == near + x + 6 * 4 + scalar + vector);
}

TEST_CASE("bytes of an iteration with the multigrid, counted by hand", "[unit][bench]") {
  Counts counts = counts_of(four_in_line());
  counts.multigrid = true;
  counts.first_nodes = 32;
  counts.nodes = 48;
  counts.iterations = 5;
  const double before = traffic_in("pressure", counts).moved;
  counts.iterations = 6;
  const double rows = 12 + 4 * row_lanes * 8;  // one chunk
  const double floats = 3 + 3 + 3 + 5 + 3;     // per particle: first sweep, what is left, P^T, P, last sweep
  const double scalars = 1 + 9 + 2;            // (d, d); z + b d, p + a d, r - a q; r and z of the sweeps
  const double nodes = (2 * 4 + 3) * 32 + 32 + (2 * 25 + 15) * 48;  // corners, b x relax; y; stencils, fifteen values
  CHECK(traffic_in("pressure", counts).moved - before ==
        Approx(product_traffic(counts, true).moved + 2 * rows + 4 * (4 * floats + number * scalars) + 10 * 4 +
               4 * nodes));
}

TEST_CASE("states come back as they were written, and others are refused", "[unit][bench]") {
  const TemporaryFolder folder;
  const State state = small_state();
  write_state(folder / "a.state", state);
  const State read = read_state(folder / "a.state");
  CHECK(read.dim == state.dim);
  CHECK(read.steps == state.steps);
  CHECK(read.time == state.time);
  CHECK(read.made_by == state.made_by);
  CHECK(read.id == state.id);
  CHECK(read.position == state.position);
  CHECK(read.velocity == state.velocity);
  CHECK(read.pressure == state.pressure);
  const std::string whole = text_in(folder / "a.state");
  for (const std::string& wrong :
       {whole.substr(0, whole.size() - 1), whole + "x", std::string("format = 1\n"), std::string()}) {
    write_text(folder / "b.state", wrong);
    CHECK_THROWS_AS(read_state(folder / "b.state"), FileError);
  }
  CHECK_THROWS_AS(read_state(folder / "none.state"), FileError);
}

TEST_CASE("sizes are those of the paper's column and its like", "[unit][bench]") {
  for (const int particles : {5000, 20000, 80000, 320000, 1280000})
    CHECK(size_near(2, particles).particles == particles);
  CHECK(size_near(2, 80000).spacing == Approx(0.001));
  CHECK(size_near(2, 80000).dt == Approx(0.000115));
  CHECK(size_near(3, 30000).particles == 29700);
  for (const int dim : {2, 3})
    for (const char* plate : {"none", "plate", "barrier"}) {
      const Size size = size_near(dim, 500);
      CHECK(build_fluid(bench_scene(size, {}, plate), {}).particles.count == size.particles);
    }
  CHECK_THROWS_AS(bench_scene(size_near(2, 500), {"mps.spacing=0.1"}), CaseError);
  CHECK_THROWS_AS(bench_scene(size_near(2, 500), {}, "gate"), CaseError);
  CHECK_THROWS_AS(time_of_state("storm"), CaseError);
}

TEST_CASE("water that is put back goes the same way again", "[unit][bench]") {
  const Size size = size_near(2, 320);
  Water water(bench_scene(size), std::nullopt);
  for (int k = 0; k < 20; ++k) water.step();
  const State start = water.state();
  std::vector<State> ends;
  std::vector<int> iterations;
  for (int round = 0; round < 2; ++round) {
    water.put(start);
    for (int k = 0; k < 5; ++k) iterations.push_back(water.step().solve.iterations);
    ends.push_back(water.state());
  }
  CHECK(water.steps() == 25);
  CHECK(std::equal(iterations.begin(), iterations.begin() + 5, iterations.begin() + 5));
  REQUIRE(ends[0].id == ends[1].id);
  double apart = 0;
  for (std::size_t k = 0; k < ends[0].position.size(); ++k)
    apart = std::max(apart, std::abs(ends[0].position[k] - ends[1].position[k]));
  CHECK(apart < 1e-6 * size.spacing);
}

TEST_CASE("a barrier in the water parts the rows", "[unit][bench]") {
  const Size size = size_near(2, 500);
  const Scene scene = bench_scene(size);
  const State state = Water(scene, std::nullopt).state();
  const auto across = [&](const std::string& plate) {
    const Fluid fluid = before_pressure(scene, bench_scene(size, {}, plate), state);
    const auto x = host(fluid.particles.position);
    const auto rows = entries_of(fluid);
    int pairs = 0;
    for (int i = 0; i < fluid.particles.count; ++i)
      for (const Entry& entry : rows[i])
        if (entry.mirror < 0) pairs += (x(i, 0) < 0.1237) != (x(entry.j, 0) < 0.1237);
    return pairs;
  };
  const int whole = across("none"), low = across("plate");
  CHECK(low < whole);
  CHECK(low > 0);
  CHECK(across("barrier") == 0);
}

TEST_CASE("the words of bench are taken apart, or refused", "[unit][bench][command_line]") {
  const auto bench = [](std::vector<const char*> words) {
    words.insert(words.begin(), {"greenwater", "bench"});
    return parse_command_line(static_cast<int>(words.size()), words.data());
  };
  const Command command =
      bench({"pressure", "--sizes", "320,5000", "--dim", "3", "--states", "rest,splash", "--tolerance", "1e-4,1e-6",
             "--json", "a.json", "--set", "a.b=1", "--set", "c=2", "-j", "2"});
  CHECK(command.verb == Command::Verb::bench);
  CHECK(command.bench.what == BenchOptions::What::pressure);
  CHECK(command.bench.sizes == std::vector{320, 5000});
  CHECK(command.bench.dimension == 3);
  CHECK(command.bench.states == std::vector<std::string>{"rest", "splash"});
  CHECK(command.bench.tolerances == std::vector{1e-4, 1e-6});
  CHECK(command.bench.sets == std::vector<std::string>{"a.b=1", "c=2"});
  CHECK(command.bench.threads == std::vector{2});
  CHECK(bench({"scaling", "-j", "1,2"}).bench.threads == std::vector{1, 2});
  CHECK(bench({"states"}).bench.what == BenchOptions::What::states);
  CHECK(bench({"fem", "--sizes", "7"}).bench.sizes == std::vector{7});
  for (const auto& wrong : std::vector<std::vector<const char*>>{{},
                                                                 {"stpe"},
                                                                 {"step", "--sizes", "3"},
                                                                 {"step", "--dim", "4"},
                                                                 {"step", "--rounds", "0"},
                                                                 {"states", "--json", "a"},
                                                                 {"fem", "--states", "rest"},
                                                                 {"fem", "--sizes", "0"}})
    CHECK_THROWS_AS(bench(wrong), CaseError);
}

TEST_CASE("bench pressure writes every variant with its origin", "[unit][bench][program]") {
  const TemporaryFolder folder;
  const std::vector<std::string> words{"bench",    "pressure",     "--sizes",  "320",   "--states",  "rest",
                                       "--plates", "none,barrier", "--rounds", "1",     "--solvers", "cg,recomputed",
                                       "--cache",  "states",       "--json",   "p.json"};
  const Answer first = run_program(words, folder);
  INFO(first.err);
  REQUIRE(first.code == 0);
  CHECK(contains(first.out, "making states"));
  CHECK_FALSE(contains(run_program(words, folder).out, "making states"));
  const Json all = json_in(folder / "p.json");
  CHECK(missing(all, {"origin", "rows", "products", "triad"}).empty());
  CHECK(missing(all["origin"], origin_keys).empty());
  std::size_t ways = 0;
  for (const PreconditionerChoice& choice : all_preconditioners())
    if (choice.usual) ways += choice.only_kept ? 1 : 2;  // solvers
  CHECK(all["rows"].size() == 2 * ways * 2 * 3);         // plates, guesses, tolerances
  for (const Json& row : all["rows"]) {
    CHECK(missing(row, {"case", "dim", "particles", "state", "plate", "solver", "preconditioner", "guess", "tolerance",
                        "iterations", "ms", "ms_min", "ms_max", "setup_ms", "solve_ms", "ratio", "residual"})
              .empty());
    CHECK(row["converged"] == true);
    CHECK(row["iterations"] > 0);
    CHECK(row["residual"].get<double>() < 1.5 * row["tolerance"].get<double>());
  }
  for (const Json& row : all["products"])
    CHECK(missing(row, {"weights", "ms", "bytes", "gb_per_s", "triad_gb_per_s", "share"}).empty());
}

TEST_CASE("bench scaling has a row for each region, size and number of threads", "[unit][bench][program]") {
  const TemporaryFolder folder;
  const Answer answer = run_program({"bench", "scaling", "--sizes", "128,320", "-j", "1,2", "--states", "rest",
                                     "--rounds", "2", "--steps", "3", "--cache", "states", "--json", "s.json"},
                                    folder);
  INFO(answer.err);
  REQUIRE(answer.code == 0);
  CHECK(contains(answer.out, "speed-up"));
  const Json all = json_in(folder / "s.json");
  CHECK(missing(all["origin"], origin_keys).empty());
  int steps = 0;
  for (const Json& row : all["rows"]) {
    if (row["region"] == "other") continue;
    CHECK(missing(row, step_keys).empty());
    if (row["region"] != "step") continue;
    ++steps;
    CHECK(missing(row, {"iterations", "launches", "memory_per_particle", "bytes_per_particle"}).empty());
    CHECK(row["launches"] > 10);
    CHECK(row["memory_per_particle"] > 100);
  }
  CHECK(steps == 4);
}

TEST_CASE("bench fem measures substeps beside plain products", "[unit][bench][program]") {
  const TemporaryFolder folder;
  const Answer answer =
      run_program({"bench", "fem", "--sizes", "100,7,400", "-j", "2", "--rounds", "1", "--json", "f.json"}, folder);
  INFO(answer.err);
  REQUIRE(answer.code == 0);
  CHECK(contains(answer.out, "2 million substeps of the paper's plate, equal, incompatible, corotational"));
  const Json all = json_in(folder / "f.json");
  CHECK(missing(all["origin"], origin_keys).empty());
  const std::size_t threads = all["origin"]["threads"] == 1 ? 1 : 2;
  CHECK(all["rows"].size() == (4 + 2 + 2) * threads);
  for (const Json& row : all["rows"]) {
    CHECK(missing(row, {"case", "elements", "mesh", "element", "kinematics", "threads", "substeps", "ms", "ms_min",
                        "ms_max", "ns_per_element", "ns_per_element_min", "product_ns_per_element", "ratio"})
              .empty());
    CHECK(row["ratio"] > 0);
    CHECK(row["ns_per_element"].get<double>() == Approx(1e6 * row["ms"].get<double>() / row["elements"].get<int>()));
    CHECK(row.contains("paper_run_s") == (row["elements"] == 100));
  }
}

TEST_CASE("two results are compared row by row", "[unit][bench]") {
  const TemporaryFolder folder;
  write_text(folder / "a.json", results_text("old", {timed("step", 10, 0.1, 5), timed("rows", 2, 0.5, 5)}));
  write_text(folder / "b.json", results_text("new", {timed("step", 12, 0.1, 6), timed("rows", 2.2, 0.5, 5)}));
  const std::string script = std::string("python3 '") + GREENWATER_SOURCE_DIR + "/scripts/compare-bench' ";
  const std::string a = (folder / "a.json").string(), b = (folder / "b.json").string();
  const Answer answer = answer_of(script + a + " " + b);
  CHECK(answer.code == 0);
  CHECK(contains(answer.out, "git: old -> new"));
  CHECK(contains(answer.out, "x 1.200  slower, iterations 5 -> 6"));
  CHECK(contains(answer.out, "x 1.100\n"));  // within the spread
  CHECK(answer_of(script + a + " " + b + " --limit 1.3").code == 0);
  CHECK(answer_of(script + a + " " + b + " --limit 1.15").code == 1);
  CHECK(answer_of(script + b + " " + a + " --limit 1.15").code == 0);
  CHECK(contains(answer_of(script + b + " " + a).out, "faster"));
}

TEST_CASE("results become tables on a page", "[unit][bench]") {
  const TemporaryFolder folder;
  Json step = timed("step", 10, 0.1, 5);
  for (const char* key : {"ns_per_particle", "bytes_per_particle", "gb_per_s", "triad_gb_per_s", "share", "launches",
                          "memory_per_particle"})
    step[key] = 0.5;
  write_text(folder / "a.json", results_text("g", {step}));
  write_text(folder / "page.md",
             "a\n<!-- bench: steps -->\nold\n<!-- end -->\n<!-- bench: times -->\nkept\n<!-- end -->\nz\n");
  const std::string page = (folder / "page.md").string();
  const std::string command = std::string("python3 '") + GREENWATER_SOURCE_DIR + "/scripts/bench-tables' " + page +
                              " " + (folder / "a.json").string();
  CHECK(answer_of(command).code == 0);
  const std::string once = text_in(page);
  CHECK(contains(once, "| 2-D | 10 | rest | 1 | 10 | 9.9 to 10.1 |"));
  CHECK_FALSE(contains(once, "old"));
  CHECK(contains(once, "kept"));
  CHECK(answer_of(command).code == 0);
  CHECK(text_in(page) == once);
}
