// The folder of a run, its records, and how the program ends.

#include <algorithm>
#include <cmath>

#include "app/command_line.hpp"
#include "io/run_folder.hpp"
#include "io/run_origin.hpp"
#include "io/thermo.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

void write_case(const TemporaryFolder& folder) { write_text(folder / "small.toml", small_case()); }

std::size_t lines_in(const std::filesystem::path& file) {
  const std::string text = text_in(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

Command command(std::vector<const char*> words) {
  words.insert(words.begin(), "greenwater");
  return parse_command_line(static_cast<int>(words.size()), words.data());
}

}  // namespace

TEST_CASE("a default folder that exists gets -2, -3; an explicit one is refused", "[unit][run_folder]") {
  const TemporaryFolder base;
  const auto path = base / "runs/small";
  CHECK(RunFolder({path, false, false}).path() == path);
  CHECK(RunFolder({path, false, false}).path().filename() == "small-2");
  CHECK(RunFolder({path, false, false}).path().filename() == "small-3");
  CHECK_THROWS_AS(RunFolder({path, true, false}), CaseError);
  CHECK_THROWS_AS(RunFolder({base.path(), true, true}), CaseError);  // not a run of ours
  CHECK(std::filesystem::exists(path));
  const RunFolder ours({base / "mine", true, false});
  ours.write("manifest.json", manifest_text({}, {}));
  ours.write("old.txt", "old");
  const RunFolder again({base / "mine", true, true});
  CHECK(!std::filesystem::exists(base / "mine/old.txt"));
  again.mark(Marker::done);
  CHECK(std::filesystem::exists(base / "mine/DONE"));
}

TEST_CASE("the folder's pattern knows name and date", "[unit][run_folder]") {
  const WallTime now = std::chrono::system_clock::now();
  CHECK(folder_from_pattern("runs/{name}", "a", now, {}) == "runs/a");
  CHECK(folder_from_pattern("{name}-{date}", "a", now, {}) == "a-" + folder_date(now));
  CHECK_THROWS_AS(folder_from_pattern("runs/{hash}", "a", now, {}), CaseError);
}

TEST_CASE("the time left is smoothed over the last steps", "[unit][run_folder]") {
  Eta eta(1000);
  CHECK(std::isnan(eta.left(10)));
  for (int i = 0; i < 400; ++i) eta.step(0.1);
  CHECK(eta.left(10) == Approx(1));
  eta.step(5);  // one hiccup
  CHECK(eta.seconds_per_step() < 0.25);
  for (int i = 0; i < 400; ++i) eta.step(0.4);
  CHECK(eta.seconds_per_step() == Approx(0.4).epsilon(0.01));
  CHECK(duration_text(3723.4) == "01:02:03");
  CHECK(duration_text(std::nan("")) == "--:--:--");
}

TEST_CASE("heads and rows of the tables belong together", "[unit][run_folder]") {
  StepFacts facts;
  facts.step = 12345;
  facts.time = 0.2461;
  facts.dt = 1.15e-4;
  CHECK(thermo_header().size() == thermo_line(facts).size());
  CHECK(history_header(2).size() == history_row(facts).size());
  CHECK(history_header(3)[7] == "E_kin[J]");
}

TEST_CASE("the command line is taken apart, or refused", "[unit][command_line]") {
  const Command run = command({"run", "a.toml", "-o", "out", "--set", "mps.spacing=1", "--set", "time.end=2", "-j", "2",
                               "--until", "0.1", "--max-steps", "7", "-q", "--no-fields", "--no-color"});
  CHECK(run.verb == Command::Verb::run);
  CHECK(run.run.case_path == "a.toml");
  CHECK(run.run.output == "out");
  REQUIRE(run.run.case_options.size() == 3);
  CHECK(run.run.case_options[1].key == "time.end");
  CHECK(run.run.case_options[2].shown == "--until 0.1");
  CHECK(run.run.threads == 2);
  CHECK(run.run.max_steps == 7);
  CHECK(run.run.no_fields);
  CHECK(run.run.verbosity == Verbosity::quiet);
  CHECK(command({"run", "a.toml", "-n"}).verb == Command::Verb::check);
  CHECK(command({"check", "a.toml"}).verb == Command::Verb::check);
  CHECK(command({"info", "--json"}).json);
  for (const auto& wrong : std::vector<std::vector<const char*>>{{},
                                                                 {"rnu", "a.toml"},
                                                                 {"run"},
                                                                 {"run", "a.toml", "b.toml"},
                                                                 {"run", "a.toml", "--max-steps", "0"},
                                                                 {"run", "a.toml", "-j", "many"},
                                                                 {"run", "a.toml", "--set", "x"},
                                                                 {"run", "a.toml", "--overwrite"},
                                                                 {"run", "a.toml", "-v", "-q"},
                                                                 {"run", "a.toml", "--kokkos-threads=3"}}) {
    CHECK_THROWS_AS(command(wrong), CaseError);
  }
}

TEST_CASE("a run leaves everything, and the next one beside it", "[unit][program]") {
  REQUIRE(program_is_there());
  const TemporaryFolder folder;
  write_case(folder);
  const Answer first = run_program({"run", "small.toml"}, folder);
  INFO(first.out << first.err);
  REQUIRE(first.code == 0);
  for (const char* name : {"case.toml", "case.resolved.toml", "manifest.json", "run.log", "status.json", "history.csv",
                           "results.h5", "probes/front.csv", "probes/load.csv", "paraview/water.pvd",
                           "paraview/water/water_000000.vtp", "paraview/walls.vtp", "DONE"}) {
    INFO(name);
    CHECK(std::filesystem::exists(folder / "runs/small" / name));
  }
  CHECK(text_in(folder / "runs/small/case.toml") == small_case());
  CHECK(lines_in(folder / "runs/small/history.csv") == 1 + 1 + 5);  // header, start, steps 2 4 6 8 9
  CHECK(lines_in(folder / "runs/small/probes/front.csv") == 1 + 1 + 9);
  CHECK(contains(text_in(folder / "runs/small/run.log"), "exit 0 (finished)"));
  CHECK(contains(text_in(folder / "runs/small/manifest.json"), "\"exit\": 0"));
  CHECK(run_program({"run", "runs/small/case.resolved.toml"}, folder).code == 0);
  CHECK(std::filesystem::exists(folder / "runs/small-2/DONE"));
  CHECK(text_in(folder / "runs/small-2/probes/front.csv") == text_in(folder / "runs/small/probes/front.csv"));
  CHECK(run_program({"run", "small.toml", "-o", "runs/small"}, folder).code == 2);
}

TEST_CASE("check and --dry-run write nothing", "[unit][program]") {
  const TemporaryFolder folder, elsewhere;
  write_case(elsewhere);
  const std::string path = (elsewhere / "small.toml").string();
  const Answer check = run_program({"check", path}, folder);
  CHECK(check.code == 0);
  CHECK(contains(check.out, "50 particles"));
  CHECK(run_program({"run", path, "-n"}, folder).code == 0);
  CHECK(folder.empty());
}

TEST_CASE("a signal ends a run after a whole step, resumable", "[unit][program]") {
  const TemporaryFolder folder;
  write_case(folder);
  const Answer answer = run_program({"run", "small.toml", "-o", "r", "--until", "1000", "-q"}, folder, "r/results.h5");
  INFO(answer.out << answer.err);
  CHECK(answer.code == 75);
  CHECK(std::filesystem::exists(folder / "r/STOPPED"));
  CHECK(contains(text_in(folder / "r/run.log"), "exit 75 (stopped by signal 15)"));
}

TEST_CASE("a run whose numbers fail keeps its files and says why", "[unit][program]") {
  const TemporaryFolder folder;
  write_case(folder);
  const Answer answer = run_program({"run", "small.toml", "-o", "r", "--set", "mps.pressure.max_iterations=1"}, folder);
  CHECK(answer.code == 3);
  CHECK(contains(answer.err, "pressure solve"));
  CHECK(std::filesystem::exists(folder / "r/FAILED"));
  CHECK(std::filesystem::exists(folder / "r/results.h5"));
  CHECK(contains(text_in(folder / "r/run.log"), "exit 3"));
}
