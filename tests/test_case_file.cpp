// Case files: what is understood, and how the rest is refused.

#include <cmath>
#include <sstream>

#include "app/plan.hpp"
#include "app/scene.hpp"
#include "io/suggest.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

Scene scene_of(const std::string& text, const std::vector<CaseOption>& options = {}) {
  CaseFile file(text, "case.toml", options);
  return read_scene(file);
}

/// The complaint about a case; empty when there is none.
std::string complaint_about(const std::string& text, const std::vector<CaseOption>& options = {}) {
  try {
    scene_of(text, options);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

std::string with(const std::string& before, const std::string& after) {
  std::string text = small_case();
  const auto at = text.find(before);
  REQUIRE(at != std::string::npos);
  return text.replace(at, before.size(), after);
}

std::string without_comments(const std::string& text) {
  std::string plain;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) plain += line.substr(0, line.find("  #")) + '\n';
  return plain.substr(plain.find("format"));
}

struct Bad {
  std::string file;
  std::string place;  // line:column
  std::string what, cure;
};

const std::vector<Bad> bad_cases{
    {"wrong_type", "20:11", "must be a number [m]", "not true or false"},
    {"missing_key", "19:", "missing key \"time_step\" [s] in [mps]", "add for example: time_step = "},
    {"misspelt_key", "16:1", "unknown key \"densty\" in [[fluid]]", "did you mean \"density\"?"},
    {"negative_spacing", "20:11", "spacing = -0.01 [m]", "must be above 0"},
    {"not_a_number", "8:7", "end", "must be a finite number [s]"},
    {"empty_fluid", "17:1", "the fluid is empty", "enlarge the region or take a smaller spacing"},
    {"duplicate_key", "22:", "redefine", "delete or rename one"},
    {"bad_formula", "17:12", "character 15", "Missing parenthesis"},
    {"unknown_effect", "23:10", "\"viscocity\" in [effects]", "did you mean \"viscosity\"?"},
    {"unreadable", "7:6", "not valid TOML", "close the bracket"},
    {"wrong_unit", "16:11", "\"1000 mm\" is in mm", "kg/m^3 is wanted"},
    {"fluid_outside_tank", "17:1", "reaches out of the box \"tank\"", "shrink the region or enlarge the box"},
};

std::string bad_path(const std::string& name) {
  return std::string(GREENWATER_SOURCE_DIR) + "/tests/cases_bad/" + name + ".toml";
}

}  // namespace

TEST_CASE("bad cases are refused with place and cure, and nothing is written", "[unit][case]") {
  REQUIRE(program_is_there());
  for (const Bad& bad : bad_cases) {
    INFO(bad.file);
    const TemporaryFolder folder;
    const Answer answer = run_program({"run", bad_path(bad.file)}, folder);
    INFO(answer.err);
    CHECK(answer.code == 2);
    CHECK(contains(answer.err, bad.file + ".toml:" + bad.place));
    CHECK(contains(answer.err, bad.what));
    CHECK(contains(answer.err, bad.cure));
    CHECK(contains(answer.err, "exit 2"));
    CHECK(folder.empty());
  }
}

TEST_CASE("a count that fits into no memory is exit 5 before any work", "[unit][case]") {
  const TemporaryFolder folder;
  for (const char* verb : {"run", "check"}) {
    const Answer answer = run_program({verb, bad_path("too_many_particles")}, folder);
    INFO(answer.err);
    CHECK(answer.code == 5);
    CHECK(contains(answer.err, "too_many_particles.toml:20:11"));
    CHECK(contains(answer.err, "take a larger mps.spacing"));
    CHECK(folder.empty());
  }
}

TEST_CASE("the resolved case reads back to itself", "[unit][case]") {
  CaseFile first(
      with("end = \"20 ms\"", "end = \"20 ms\"\ngravity = [0, \"-981 cm/s^2\"]") +
          "[effects.body_force]\nacceleration = [\"0.1*sin(2*pi*t)\", 0.5]\n[domain]\nmin = [-1, -1]\nmax = [2, 2]\n",
      "a.toml", {set_option("mps.radius_density=2.1")});
  const Scene scene = read_scene(first);
  CaseFile second(first.resolved(), "b.toml", {});
  const Scene again = read_scene(second);
  CHECK(without_comments(first.resolved()) == without_comments(second.resolved()));
  CHECK(again.end == scene.end);
  CHECK(again.gravity == scene.gravity);
  CHECK(again.mps.radius_density == 2.1);
  CHECK(again.fluid.max == scene.fluid.max);
  CHECK(again.body_force.at(0).acceleration.text == scene.body_force.at(0).acceleration.text);
  CHECK(again.probes.size() == 2);
  CHECK(again.plates.at(0).height == 0.05);
  CHECK(contains(first.resolved(), "radius_density = 2.1  # x spacing; command line"));
  CHECK(contains(first.resolved(), "end = 0.02  # s; case"));
  CHECK(contains(first.resolved(), "density = 1000.0  # kg/m^3; default"));
}

TEST_CASE("--set changes, adds, and is checked like the file", "[unit][case]") {
  CHECK(scene_of(small_case(), {set_option("mps.spacing=5 mm")}).mps.spacing == 0.005);
  CHECK(scene_of(small_case(), {set_option("mps.spacing=.005")}).mps.spacing == 0.005);
  CHECK(scene_of(small_case(), {set_option("probe.1.every_time=0.5")}).probes[1].every_time == 0.5);
  CHECK(scene_of(small_case(), {set_option("case.name=other")}).name == "other");
  CHECK(scene_of(small_case(), {set_option("effects.viscosity.kinematic=1e-6")}).viscosity.size() == 1);
  CHECK(scene_of(small_case(), {set_option("fluid.0.region.max=[0.2, 0.2]")}).fluid.max[0] == 0.2);
  const std::string unknown = complaint_about(small_case(), {set_option("mps.spcing=0.005")});
  CHECK(contains(unknown, "--set mps.spcing=0.005: error: unknown key \"spcing\" in [mps]; did you mean \"spacing\"?"));
  CHECK(contains(complaint_about(small_case(), {set_option("probe.2.x=1")}), "2 item(s), numbered from 0"));
  CHECK(contains(complaint_about(small_case(), {set_option("fluid.density=1")}), "fluid.0"));
  CHECK(contains(complaint_about(small_case(), {set_option("mps.spacing.x=1")}), "has no key"));
  CHECK(contains(complaint_about(small_case(), {set_option("mps.spacing=0")}), "--set mps.spacing=0: error: "));
  CHECK_THROWS_AS(set_option("mps.spacing"), CaseError);
  CHECK_THROWS_AS(scene_of(small_case(), {set_option("mps..spacing=1")}), CaseError);
}

TEST_CASE("unknown keys are reported together, each with what was meant", "[unit][case]") {
  const std::string text = complaint_about(with("spacing = 0.02", "spacing = 0.02\nviscosty = 1\nmax_iterations = 5") +
                                           "[structure]\nname = \"plate\"\n");
  CHECK(contains(text, "unknown key \"viscosty\" in [mps]"));
  CHECK(contains(text, "unknown key \"max_iterations\" in [mps]; it is a key of [mps.pressure]"));
  CHECK(contains(text, "unknown table [structure]; known here: "));
}

TEST_CASE("slips in TOML get a hint", "[unit][case]") {
  CHECK(contains(complaint_about(with("spacing = 0.02", "spacing = .02")), "write a digit before the point"));
  CHECK(contains(complaint_about(with("height = 0.05", "height = 5.")), "write a digit after the point"));
  CHECK(contains(complaint_about(with("\"small\"", "small")), "a text needs quotes"));
  CHECK(contains(complaint_about(with("\"small\"", "\"small")), "closing quote"));
  CHECK(contains(complaint_about(with("[mps]", "[mps]\nspacing")), "key = value"));
}

TEST_CASE("a case that makes no sense is refused", "[unit][case]") {
  const std::vector<std::array<std::string, 3>> slips{
      {"format = 1", "format = 2", "reads format 1"},
      {"[case]\n", "[case]\ndimension = 3\n", "this version runs dimension = 2"},
      {"name = \"small\"", "name = \"../small\"", "file names"},
      {"name = \"load\"", "name = \"front\"", "two probes have the name"},
      {"wall = \"plate\"", "wall = \"plat\"", "did you mean \"plate\"?"},
      {"kind = \"wall_force\"", "kind = \"surface_height\"", "missing key \"x\" [m]"},
      {"spacing = 0.02", "spacing = 0.02\nradius_density = 1.0", "must be at least 1.1"},
      {"spacing = 0.02", "spacing = inf", "finite"},
      {"time_step = \"2.3 ms\"", "time_step = 1", "longer than the run"},
      {"base = [0.3, 0.0]", "base = [0.5, 0.0]", "not inside the box"},
      {"base = [0.3, 0.0]", "base = [0.3]", "needs 2 components"},
      {"open = [\"top\"]", "open = [\"top\", \"up\"]", "open cannot be \"up\""},
      {"max = [0.4, 0.4]", "max = [0.4, 0.0]", "is empty"},
      {"[[fluid]]", "[[fluid]]\n[[fluid]]", "one [[fluid]]"},
      {"[[fluid]]", "[fluid]", "write [[fluid]]"},
      {"[output]", "[effects.viscosity]\nkinematic = 0\n[output]", "leave the table [effects.viscosity] out"},
      {"[output]", "[effects.body_force]\nacceleration = [0, \"1-1\"]\n[output]", "leave the table"},
      {"[output]", "[domain]\nmin = [0, 0]\nmax = [0.1, 0.1]\n[output]", "reaches out of [domain]"},
      {"type = \"plate\"", "type = \"plaet\"", "did you mean \"plate\"?"},
  };
  for (const auto& [before, after, answer] : slips) {
    const std::string text = complaint_about(with(before, after));
    INFO(after << " -> " << text);
    CHECK(contains(text, "case.toml"));
    CHECK(contains(text, answer));
  }
  CHECK(contains(complaint_about("format = 1\n"), "missing table [case]"));
  CHECK(contains(complaint_about(""), "missing key \"format\""));
}

TEST_CASE("the nearest word is found, and nothing far away", "[unit][case]") {
  CHECK(edit_distance("density", "densty") == 1);
  CHECK(edit_distance("spacing", "spaicng") == 1);
  CHECK(edit_distance("", "abc") == 3);
  CHECK(nearest("desnity", {"density", "spacing"}) == "density");
  CHECK(nearest("Spacing", {"density", "spacing"}) == "spacing");
  CHECK(nearest("structure", {"density", "spacing"}).empty());
  CHECK(nearest("x", {"y"}).empty());
}

TEST_CASE("the plan counts what will be made", "[unit][case]") {
  const Plan plan = plan_of(scene_of(small_case(), {set_option("fluid.0.region.max=[0.3, 0.1]")}));
  CHECK(plan.particles == 75);  // 0.3 / 0.02 is 14.999...
  CHECK(plan.steps == 9);
  CHECK(plan.frames == 5);
  CHECK(plan.cfl == Approx(2 * std::sqrt(9.81 * 0.1) * 0.0023 / 0.02));
}

TEST_CASE("the cases that come with the program are good", "[unit][case]") {
  const std::filesystem::path folder = std::string(GREENWATER_SOURCE_DIR) + "/cases";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    INFO(entry.path());
    CaseFile file(entry.path());
    CHECK_NOTHROW(read_scene(file));
  }
}
