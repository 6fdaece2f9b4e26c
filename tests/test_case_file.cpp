// Case files: what is understood, and how the rest is refused.

#include <cmath>
#include <sstream>

#include "app/plan.hpp"
#include "app/scene.hpp"
#include "io/suggest.hpp"
#include "tests/case_text.hpp"
#include "tests/catch.hpp"
#include "tests/meshes.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// The complaint about a case; empty when there is none.
std::string complaint_about(const std::string& text, const std::vector<CaseOption>& options = {}) {
  try {
    scene_of_text(text, options);
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

/// A tank in 3-D with a gate in it, filled to a level; more tables may follow.
std::string tank_3d() {
  return R"(format = 1
[case]
name = "tank"
dimension = 3
[time]
end = 0.1
[geometry.tank]
type = "box"
min = [0.0, 0.0, 0.0]
max = [0.4, 0.2, 0.4]
open = ["back", "top"]
[geometry.gate]
type = "plate"
base = [0.3, 0.1, 0.0]
height = 0.1
width = 0.2
[[fluid]]
region = { type = "inside", wall = "tank", level = 0.08 }
[mps]
spacing = 0.02
time_step = 0.002
[[probe]]
name = "load"
kind = "wall_force"
wall = "gate"
component = "z"
[[probe]]
name = "height"
kind = "surface_height"
x = 0.1
y = 0.05
[[probe]]
name = "mean_height"
kind = "surface_height"
x = 0.1
)";
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
    {"jitter_too_large", "17:10", "jitter = 0.5 x spacing", "must be below 0.5"},
    {"negative_radius", "16:57", "radius = -0.05 [m]", "must be above 0"},
    {"ball_outside_tank", "16:1", "reaches out of the box \"tank\"", "shrink the region or enlarge the box"},
    {"negative_spacing", "20:11", "spacing = -0.01 [m]", "must be above 0"},
    {"not_a_number", "8:7", "end", "must be a finite number [s]"},
    {"empty_fluid", "17:1", "the fluid is empty", "enlarge the region or take a smaller spacing"},
    {"duplicate_key", "22:", "redefine", "delete or rename one"},
    {"bad_formula", "17:12", "character 15", "Missing parenthesis"},
    {"unknown_effect", "23:10", "\"viscocity\" in [effects]", "did you mean \"viscosity\"?"},
    {"unreadable", "7:6", "not valid TOML", "close the bracket"},
    {"wrong_unit", "16:11", "\"1000 mm\" is in mm", "kg/m^3 is wanted"},
    {"fluid_outside_tank", "17:1", "reaches out of the box \"tank\"", "shrink the region or enlarge the box"},
    {"cut_short", "17:55", "encountered end-of-file", "copy the rest again"},
    {"spacing_above_tank", "20:11", "1.5 m is larger than the box \"tank\", which is 0.4 m wide", "a smaller spacing"},
    {"huge_radius", "21:10", "radius = 1e+06", "must be at most 10"},
    {"too_many_steps", "21:13", "more than 1e12 steps of time.end = 1e+300 s", "take a longer step or an earlier end"},
    {"step_too_long", "21:13", "140.071 particle distances in one step", "take less than 0.0017848 s"},
    {"velocity_not_finite", "17:12", "velocity is no finite number at [", "mend the formula"},
    {"plate_outside_tank", "15:11", "from [0.5, 0] to [0.5, 0.1] m, is not inside the box \"tank\"", "move or shrink"},
    {"plate_above_lid", "15:11", "is not inside the box \"tank\"", "open a side of the box"},
    {"plate_wider_than_tank", "16:11", "from [0.3, -0.05, 0] to [0.3, 0.25, 0.1] m", "move or shrink the plate"},
    {"missing_width", "16:11", "missing key \"width\" [m] in [geometry.plate]", "add for example: width = 0.2"},
    {"overlapping_plates", "21:11", "the plates \"gate\" and \"sill\" overlap", "move one of them"},
    {"crossing_walls", "15:11", "the walls of \"tank\" and \"bed\" cross at [0.4, 0.05] m",
     "let one end where it meets"},
    {"polyline_in_3d", "12:8", "a polyline is for dimension = 2", "type = \"stl\""},
    {"wrong_vector_length", "13:7", "min needs 3 components", "in 3-D, found 2"},
    {"level_above_tank", "17:52", "level = 0.8 m is not inside \"tank\", which reaches from y = 0 m to 0.4 m",
     "not a depth"},
    {"open_polyline_region", "16:36", "the polyline \"tank\" is open", "give it closed = true, or fill a box"},
    {"unknown_no_slip", "25:12", "no_slip cannot be \"tnak\"", "did you mean \"tank\"?"},
    {"force_across", "30:13", "component cannot be \"z\"", "known: x, y"},
    {"motion_in_space", "21:16", "character 12: \"x\" has no meaning here", "the only variable is t [s]"},
    {"motion_from_elsewhere", "21:16", "displacement in x is 0.1 m at t = 0", "subtract 0.1"},
    {"motion_twice", "22:12", "both displacement and velocity", "keep one of them"},
    {"motion_too_fast", "20:16", "\"gate\" moves 0.14103 m in the step at t = 0.499 s", "Let the motion end in time"},
    {"motion_without_words", "21:9", "about belongs to a rotation", "add rotation or rotation_table"},
    {"rotation_without_axis", "16:16", "missing key \"axis\" in [geometry.tank.motion]", "axis = [0.0, 1.0, 0.0]"},
    {"table_out_of_order", "21:22", "times must ascend, but line 3 has 0.2 s and line 4 has 0.1 s", "sort the rows"},
    {"missing_table", "21:18", "there is no file ", "looked up beside the case file"},
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
      "a.toml", {set_option("mps.radius=2.1")});
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
  CHECK(contains(first.resolved(), "radius = 2.1  # x spacing; command line"));
  CHECK(contains(first.resolved(), "end = 0.02  # s; case"));
  CHECK(contains(first.resolved(), "density = 1000.0  # kg/m^3; default"));
}

TEST_CASE("a resolved case in 3-D with all its motion reads back to itself", "[unit][case]") {
  const TemporaryFolder folder;
  write_text(folder / "roll.csv", "t,angle\n0,0\n1,0.2\n");
  write_text(folder / "case.toml", tank_3d() + R"toml([geometry.tank.motion]
rotation_table = "roll.csv"
about = ["20 cm", 0.1, 0.0]
axis = [0, 1, 0]
[geometry.gate.motion]
displacement = [0, 0, "0.1*t^2"]
rotation = "0.1*sin(t)"
about = [0.3, 0.0, 0.0]
axis = [0, 0, 2]
[effects.viscosity]
kinematic = 1e-6
no_slip = "all"
[effects.body_force]
acceleration = ["-0.1*u", 0, "x*w"]
)toml");
  CaseFile first(folder / "case.toml");
  const Scene scene = read_scene(first);
  CaseFile second(first.resolved(), "elsewhere/b.toml", {});
  const Scene again = read_scene(second);
  CHECK(without_comments(first.resolved()) == without_comments(second.resolved()));
  CHECK(contains(first.resolved(), "rotation_table = \"" + folder.path().string()));
  for (const Scene* one : {&scene, &again}) {
    CHECK(one->dimension == 3);
    CHECK(one->gravity == Point{0, 0, -9.81});
    CHECK(one->mps.radius_density == 2.1);
    CHECK(one->mps.radius_laplacian == 2.1);
    CHECK(one->mps.free_surface_ratio == 0.97);
    CHECK(one->boxes.at(0).open == Words{"back", "top"});
    CHECK(one->boxes.at(0).motion.value().rotation_table.value().value.at(1).at(0) == 0.2);
    CHECK(one->boxes.at(0).motion.value().about == Point{0.2, 0.1, 0});
    CHECK(one->plates.at(0).width == 0.2);
    CHECK(one->plates.at(0).motion.value().displacement.value().text[2] == "0.1*t^2");
    CHECK(one->plates.at(0).motion.value().rotation.value().text == "0.1*sin(t)");
    CHECK(one->fluid.inside == "tank");
    CHECK(one->fluid.level == 0.08);
    CHECK(one->fluid.min == Point{0, 0, 0});
    CHECK(one->fluid.max == Point{0.4, 0.2, 0.08});
    CHECK(one->viscosity.at(0).no_slip == Words{"tank", "gate"});
    CHECK(one->body_force.at(0).acceleration.text == Formulas{"-0.1*u", "0.0", "x*w"});
    CHECK(one->probes.at(0).component == "z");
    CHECK(one->probes.at(1).y.value() == 0.05);
    CHECK(!one->probes.at(2).y);
  }
}

TEST_CASE("where steps adapt nothing is too fast for them but a jump", "[unit][case]") {
  const std::string adaptive = with("time_step = \"2.3 ms\"", "time_step = \"20 ms\"\nadaptive = true");
  const std::string fast = "[geometry.plate.motion]\nvelocity = [0, \"40*t/0.01\"]\n";
  CHECK(complaint_about(adaptive).empty());
  CHECK(complaint_about(adaptive, {set_option("fluid.0.velocity=[500, 0]")}).empty());
  CHECK(complaint_about(adaptive + fast).empty());
  CHECK(contains(complaint_about(small_case() + fast), "m in the step at"));
  const std::string jump =
      complaint_about(adaptive + "[geometry.plate.motion]\ndisplacement = [\"t < 0.01 ? 0 : 0.05\", 0]\n");
  INFO(jump);
  CHECK(contains(jump, "moves 0.05 m in a thousandth of mps.time_step at t = 0.0"));
  CHECK(contains(jump, "without a jump"));
  CaseFile first(adaptive, "a.toml", {set_option("mps.courant=0.2")});
  CHECK(read_scene(first).mps.adaptive);
  CaseFile second(first.resolved(), "b.toml", {});
  CHECK(read_scene(second).mps.courant == 0.2);
  CHECK(without_comments(first.resolved()) == without_comments(second.resolved()));
  CHECK(contains(first.resolved(), "growth = 1.1  # -; default"));
  CaseFile fixed(small_case(), "c.toml", {});
  read_scene(fixed);
  CHECK(contains(fixed.resolved(), "adaptive = false  # default"));
  CHECK(!contains(fixed.resolved(), "courant"));
}

TEST_CASE("steps can be undone, in the classic scheme only where it is asked for", "[unit][case]") {
  const auto undo_of = [](const std::vector<std::string>& settings, std::string* resolved = nullptr) {
    std::vector<CaseOption> options;
    for (const std::string& setting : settings) options.push_back(set_option(setting));
    CaseFile file(small_case(), "a.toml", options);
    const Scene scene = read_scene(file);
    if (resolved) *resolved = file.resolved();
    return scene.mps.undo;
  };
  std::string resolved, classic;
  CHECK(undo_of({}, &resolved).halvings == 8);
  CHECK(contains(resolved, "[mps.undo]"));
  CHECK(contains(resolved, "displacement = 1.0  # x spacing; default"));
  CHECK(contains(resolved, "distance = 0.2  # x spacing; default"));
  CHECK(undo_of({"mps.scheme=classic"}, &classic).halvings == 0);
  CHECK(!contains(classic, "displacement = 1"));
  CHECK(undo_of({"mps.scheme=classic", "mps.undo.halvings=3", "mps.undo.distance=0"}).distance == 0);
  CHECK(undo_of({"mps.adaptive=true"}).displacement == 1);
  CHECK(undo_of({"mps.adaptive=true", "mps.courant=0.8"}).displacement == Approx(1.6));
  CaseFile again(resolved, "b.toml", {});
  CHECK(read_scene(again).mps.undo.halvings == 8);
}

TEST_CASE("polylines come from files, and are filled to a level", "[unit][case]") {
  const TemporaryFolder folder;
  write_text(folder / "hull.csv", "x,y\n0.0,0.3\n0.2,0.0\n0.4,0.3\n");
  write_text(folder / "case.toml", R"(format = 1
[case]
name = "hull"
[time]
end = 0.1
[geometry.hull]
type = "polyline"
points_file = "hull.csv"
closed = true
[[fluid]]
region = { type = "inside", wall = "hull", level = "15 cm" }
[effects.viscosity]
kinematic = 1e-6
no_slip = ["hull", "hull"]
[mps]
spacing = 0.02
time_step = 0.002
)");
  CaseFile file(folder / "case.toml");
  const Scene scene = read_scene(file);
  CHECK(scene.polylines.at(0).points.at(1) == Point{0.2, 0, 0});
  CHECK(scene.fluid.max == Point{0.4, 0.15, 0});
  CHECK(scene.viscosity.at(0).no_slip == Words{"hull"});
  CHECK(contains(plan_lines(plan_of(scene), scene).front(), "at most 150 particles"));
}

TEST_CASE("a closed surface from a file is a tank that moves and is filled", "[unit][case]") {
  const TemporaryFolder folder;
  write_text(folder / "box.stl", stl_text(box_mesh({0, 0, 0}, {400, 200, 300})));
  const std::string text = R"toml(format = 1
[case]
name = "stl"
dimension = 3
[time]
end = 0.1
[geometry.hull]
type = "stl"
file = "box.stl"
unit = "mm"
closed = true
[geometry.hull.motion]
velocity = [0, "0.1*sin(20*t)", 0]
[[fluid]]
region = { type = "inside", wall = "hull", level = 0.08 }
[mps]
spacing = 0.02
time_step = 0.002
[[probe]]
name = "load"
kind = "wall_force"
wall = "hull"
)toml";
  write_text(folder / "case.toml", text);
  CaseFile first(folder / "case.toml");
  const Scene scene = read_scene(first);
  CHECK(scene.meshes.at(0).closed);
  CHECK(scene.meshes.at(0).motion.has_value());
  CHECK(scene.fluid.max[1] == Approx(0.2));
  CHECK(scene.fluid.max[2] == 0.08);
  CHECK(contains(plan_lines(plan_of(scene), scene).front(), "at most 800 particles"));
  CaseFile second(first.resolved(), "elsewhere/b.toml", {});
  CHECK(read_scene(second).meshes.at(0).mesh.vertices == scene.meshes.at(0).mesh.vertices);
  std::string open = text;
  open.replace(open.find("closed = true"), 13, "closed = false");
  write_text(folder / "case.toml", open);
  CaseFile third(folder / "case.toml");
  CHECK_THROWS_WITH(read_scene(third), Catch::Contains("the mesh \"hull\" has no inside"));
}

TEST_CASE("--set changes, adds, and is checked like the file", "[unit][case]") {
  CHECK(scene_of_text(small_case(), {set_option("mps.spacing=5 mm")}).mps.spacing == 0.005);
  CHECK(scene_of_text(small_case(), {set_option("mps.spacing=.005")}).mps.spacing == 0.005);
  CHECK(scene_of_text(small_case(), {set_option("probe.1.every_time=0.5")}).probes[1].every_time == 0.5);
  CHECK(scene_of_text(small_case(), {set_option("case.name=other")}).name == "other");
  CHECK(scene_of_text(small_case(), {set_option("effects.viscosity.kinematic=1e-6")}).viscosity.size() == 1);
  CHECK(scene_of_text(small_case(), {set_option("fluid.0.region.max=[0.2, 0.2]")}).fluid.max[0] == 0.2);
  const std::string unknown = complaint_about(small_case(), {set_option("mps.spcing=0.005")});
  CHECK(contains(unknown, "--set mps.spcing=0.005: error: unknown key \"spcing\" in [mps]; did you mean \"spacing\"?"));
  CHECK(contains(complaint_about(small_case(), {set_option("probe.2.x=1")}), "2 item(s), numbered from 0"));
  CHECK(contains(complaint_about(small_case(), {set_option("fluid.density=1")}), "fluid.0"));
  CHECK(contains(complaint_about(small_case(), {set_option("mps.spacing.x=1")}), "has no key"));
  CHECK(contains(complaint_about(small_case(), {set_option("mps.spacing=0")}), "--set mps.spacing=0: error: "));
  CHECK_THROWS_AS(set_option("mps.spacing"), CaseError);
  CHECK_THROWS_AS(scene_of_text(small_case(), {set_option("mps..spacing=1")}), CaseError);
}

TEST_CASE("unknown keys are reported together, each with what was meant", "[unit][case]") {
  const std::string text = complaint_about(with("spacing = 0.02", "spacing = 0.02\nviscosty = 1\nmax_iterations = 5") +
                                           "[wave]\nname = \"plate\"\n");
  CHECK(contains(text, "unknown key \"viscosty\" in [mps]"));
  CHECK(contains(text, "unknown key \"max_iterations\" in [mps]; it is a key of [mps.pressure]"));
  CHECK(contains(text, "unknown table [wave]; known here: "));
}

TEST_CASE("slips in TOML get a hint", "[unit][case]") {
  CHECK(contains(complaint_about(with("spacing = 0.02", "spacing = .02")), "write a digit before the point"));
  CHECK(contains(complaint_about(with("height = 0.05", "height = 5.")), "write a digit after the point"));
  CHECK(contains(complaint_about(with("\"small\"", "small")), "a text needs quotes"));
  CHECK(contains(complaint_about(with("\"small\"", "\"small")), "closing quote"));
  CHECK(contains(complaint_about(with("[mps]", "[mps]\nspacing")), "key = value"));
}

TEST_CASE("names, lists and tables that lie too deep in each other are refused with their place", "[unit][case]") {
  const auto chain = [](int names, const std::string& name) {
    std::string text = name;
    for (int k = 1; k < names; ++k) text += "." + name;
    return text;
  };
  const auto times = [](int count, const std::string& part) {
    std::string text;
    for (int k = 0; k < count; ++k) text += part;
    return text;
  };
  for (const int deep : {33, 10000, 100000}) {
    for (const std::string& line :
         {'[' + chain(deep, "a") + ']', "[[" + chain(deep, "a") + "]]", chain(deep, "a") + " = 1",
          '[' + chain(deep, "\"a.b\"") + ']', chain(deep, "a .  'b'") + " = 1",
          "x = " + times(deep, "[") + times(deep, "]"), "x = " + times(deep, "{a=") + "1" + times(deep, "}"),
          "x = " + times(deep, "["), "x = {" + chain(deep, "a") + "=1}"}) {
      const std::string text = complaint_about(small_case() + line + '\n');
      INFO(line.substr(0, 60) << " -> " << text.substr(0, 200));
      CHECK(contains(text, "more than 32 deep"));
      CHECK(contains(text, "case.toml:31:"));
      CHECK(text.size() < 1000);
    }
  }
  // A few short ones in each other are as deep.
  const std::string mixed = complaint_about("[" + chain(20, "a") + "]\n" + chain(20, "b") + " = {" + chain(20, "c") +
                                            " = [[" + "{d.e = 1}]]}\n");
  CHECK(contains(mixed, "more than 32 deep"));
  CHECK(contains(mixed, "case.toml:"));
  CHECK_FALSE(contains(complaint_about('[' + chain(31, "a") + "]\n"), "deep"));
  // Neither texts nor comments nor numbers have a depth.
  const std::string dots = times(100, ".") + times(100, "[") + times(100, "{") + times(100, "a.");
  for (const std::string& line : {"# " + dots, "title = \"\\\"" + dots + "\"", "title = '" + dots + '\'',
                                  "title = \"\"\"\n" + dots + "\n\\\"\"\"\"", "title = '''\n" + dots + "'''"}) {
    const std::string text = with("name = \"small\"", "name = \"small\"\n" + line);
    INFO(line);
    CHECK(complaint_about(text).empty());
  }
}

TEST_CASE("options lie no deeper than a case, but texts may hold any dots", "[unit][case]") {
  std::string key = "a";
  for (int k = 0; k < 10000; ++k) key += ".a";
  const auto complaint = [](const std::string& argument) -> std::string {
    try {
      scene_of_text(small_case(), {set_option(argument)});
    } catch (const CaseError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(contains(complaint(key + "=1"), "a path of 10001 keys"));
  CHECK(contains(complaint("case.title={" + key + "=1}"), "more than 32 deep"));
  CHECK(contains(complaint("case.title=" + std::string(10000, '[')), "more than 32 deep"));
  std::string up;
  for (int k = 0; k < 50; ++k) up += "../";
  CHECK(complaint("case.title=" + up + "a.csv").empty());
}

TEST_CASE("an empty list is as much as none, and refused where something is needed", "[unit][case]") {
  const std::string fluid = "[[fluid]]\nregion = { type = \"box\", min = [0.0, 0.0], max = [0.1, 0.2] }\n";
  const std::string small = small_case(), rest = small.substr(0, small.find("[[probe]]"));
  const auto head = [](const std::string& text, const std::string& line) { return line + '\n' + text; };
  CHECK(complaint_about(head(rest, "structure = []")).empty());
  CHECK(complaint_about(head(rest, "probe = []")).empty());
  CHECK(complaint_about(head(rest, "structure = []\nprobe = []")).empty());
  CHECK(contains(complaint_about(head(rest, "geometry = []")), "geometry"));
  std::string dry = rest;
  dry.erase(dry.find("[[fluid]]"), fluid.size());
  for (const std::string line :
       {"structure = []", "structure = [] # none", "fluid = []", "fluid = []\nstructure = []"}) {
    for (const std::string probe :
         {"", "[[probe]]\nname = \"p\"\nkind = \"structure_displacement\"\n", "[[probe]]\nname = \"p\"\n"}) {
      const std::string text = complaint_about(head(dry, line) + probe);
      INFO(line << " -> " << text);
      CHECK(contains(text, line.substr(0, line.find(' ')) + " = [] is empty"));
      CHECK(contains(text, "case.toml:1:"));
      CHECK(contains(text, "add [[fluid]]"));
    }
  }
  CHECK(contains(complaint_about(dry), "missing table [[fluid]]"));
  // A probe of what is not there is refused as where the list is missing.
  const std::string probe = "[[probe]]\nname = \"p\"\nkind = \"structure_displacement\"\n";
  CHECK(contains(complaint_about(head(rest, "structure = []") + probe), "kind cannot be"));
  // An empty list of fluids beside a structure is a structure alone.
  const std::string plate =
      "fluid = []\nformat = 1\n[case]\nname = \"a\"\n[time]\nend = 0.01\n[[structure]]\nbase = [0.0, 0.0]\nheight = "
      "0.1\nthickness = 0.01\nyoung = 1e7\ndensity = 1000\npoisson = 0.3\n[structure.fem]\ndivisions = [1, 4]\n";
  CHECK(complaint_about(plate).empty());
  CHECK_FALSE(scene_of_text(plate).has_fluid);
}

TEST_CASE("a plate so thin that its sides cannot be told from each other is refused", "[unit][case]") {
  for (const std::string thickness : {"1e-308", "1e-17", "1e-12", "3.9e-5"}) {
    const std::string text = complaint_about(with("height = 0.05", "height = 0.05\nthickness = " + thickness));
    INFO(thickness << " -> " << text);
    CHECK(contains(text, "case.toml:15:13"));
    CHECK(contains(text, "is none beside mps.spacing"));
    CHECK(contains(text, "take thickness = 0"));
  }
  CHECK(complaint_about(with("height = 0.05", "height = 0.05\nthickness = 0")).empty());
  CHECK(complaint_about(with("height = 0.05", "height = 0.05\nthickness = 4.1e-5")).empty());
}

TEST_CASE("a case that makes no sense is refused", "[unit][case]") {
  const std::vector<std::array<std::string, 3>> slips{
      {"format = 1", "format = 2", "reads format 1"},
      {"[case]\n", "[case]\ndimension = 4\n", "dimension must be 2 or 3, not 4"},
      {"height = 0.05", "height = 0.05\nwidth = 0.1", "unknown key \"width\" in [geometry.plate]"},
      {"height = 0.05", "height = 0.005", "larger than the plate \"plate\", which is 0.005 m high"},
      {"base = [0.3, 0.0]", "base = [0.3, -0.01]", "not inside the box"},
      {"height = 0.05", "height = 0.05\nthickness = 0.3", "not inside the box"},
      {"type = \"plate\"", "type = \"stl\"", "an STL file is for dimension = 3"},
      {"[geometry.plate]", "[geometry.all]", "take another name"},
      {"type = \"plate\"", "type = \"polyline\"", "missing key \"points\""},
      {"region = { type = \"box\", min = [0.0, 0.0], max = [0.1, 0.2] }",
       "region = { type = \"inside\", wall = \"plate\", level = 0.1 }", "the plate \"plate\" has no inside"},
      {"region = { type = \"box\", min = [0.0, 0.0], max = [0.1, 0.2] }",
       "region = { type = \"inside\", wall = \"tnk\", level = 0.1 }", "did you mean \"tank\"?"},
      {"[[fluid]]", "[geometry.plate.motion]\n[[fluid]]", "does not say how it moves"},
      {"[[fluid]]", "[geometry.plate.motion]\ndisplacemnt = [0, 0]\n[[fluid]]", "did you mean \"displacement\"?"},
      {"[[fluid]]", "[geometry.plate.motion]\nrotation = 0.1\nabout = [0, 0]\n[[fluid]]", "rotation is 0.1 rad at t"},
      {"[[fluid]]", "[geometry.plate.motion]\nrotation = \"t\"\n[[fluid]]", "missing key \"about\" [m]"},
      {"[[fluid]]", "[geometry.plate.motion]\nvelocity = [0, \"1/(t - 0.01)^2\"]\n[[fluid]]", "m in the step at"},
      {"[[fluid]]", "[geometry.plate.motion]\ndisplacement = [0, \"t > 0.01 ? 1/0 : 0\"]\n[[fluid]]",
       "no finite number"},
      {"[[fluid]]", "[geometry.bar]\ntype = \"plate\"\nbase = [0.3, 0.0]\nheight = 0.1\n[[fluid]]", "overlap"},
      {"[[fluid]]",
       "[geometry.eight]\ntype = \"polyline\"\npoints = [[0.1, 0.2], [0.2, 0.3], [0.2, 0.2], [0.1, 0.3]]\n[[fluid]]",
       "\"eight\" cross each other at [0.15, 0.25]"},
      {"[[fluid]]", "[geometry.other]\ntype = \"box\"\nmin = [0.2, 0.1]\nmax = [0.6, 0.2]\n[[fluid]]",
       "cross at [0.4, 0."},
      {"type = \"plate\"\nbase = [0.3, 0.0]\nheight = 0.05\n[[fluid]]\nregion = { type = \"box\", min = [0.0, 0.0], "
       "max = [0.1, "
       "0.2] }",
       "type = \"polyline\"\npoints = [[0.1, 0.1], [0.3, 0.1], [0.2, 0.1], [0.2, 0.3]]\nclosed = true\n[[fluid]]\n"
       "region = { type = \"inside\", wall = \"plate\", level = 0.2 }",
       "its sides [0.1, 0.1] - [0.3, 0.1] m and [0.3, 0.1] - [0.2, 0.1] m meet"},
      {"[[fluid]]", "[[fluid]]\nvelocity = [1e6, 0]", "velocity is 1e+06 m/s"},
      {"[output]", "[effects.body_force]\nacceleration = [0, \"q\"]\n[output]", "velocity u, v, w [m/s]"},
      {"[output]", "[effects.viscosity]\nkinematic = 1e-6\nno_slip = \"wall\"\n[output]", "known: tank, plate, all"},
      {"[output]", "[effects.collision]\nsweeps = 1000000\n[output]", "beyond all use"},
      {"name = \"small\"", "name = \"../small\"", "file names"},
      {"name = \"load\"", "name = \"front\"", "two probes have the name"},
      {"wall = \"plate\"", "wall = \"plat\"", "did you mean \"plate\"?"},
      {"kind = \"wall_force\"", "kind = \"surface_height\"", "missing key \"x\" [m]"},
      {"spacing = 0.02", "spacing = 0.02\nradius = 1.9", "must be at least 2.05"},
      {"spacing = 0.02", "spacing = 0.02\nscheme = \"classic\"\nradius_density = 1.0", "must be at least 1.1"},
      {"spacing = 0.02", "spacing = 0.02\nradius_density = 2.5", "radius_density belongs to scheme = \"classic\""},
      {"spacing = 0.02", "spacing = 0.02\nmultiplication_coefficient = 1.05", "delete it, or take that scheme"},
      {"spacing = 0.02", "spacing = 0.02\nscheme = \"classic\"\nradius = 2.5",
       "radius belongs to scheme = \"default\""},
      {"spacing = 0.02", "spacing = inf", "finite"},
      {"time_step = \"2.3 ms\"", "time_step = 1", "longer than the run"},
      {"spacing = 0.02", "spacing = 0.02\ncourant = 0.2", "courant belongs to time steps that adapt"},
      {"spacing = 0.02", "spacing = 0.02\nadaptive = false\ngrowth = 1.2", "add adaptive = true, or delete it"},
      {"spacing = 0.02", "spacing = 0.02\nadaptive = true\ngrowth = 1", "growth = 1.0 must be above 1"},
      {"spacing = 0.02", "spacing = 0.02\nadaptive = true\ncourant = 2", "courant = 2.0 must be at most 1"},
      {"spacing = 0.02", "spacing = 0.02\nadaptve = true", "did you mean \"adaptive\"?"},
      {"spacing = 0.02", "spacing = 0.02\nundo.halvings = -1", "halvings = -1"},
      {"spacing = 0.02", "spacing = 0.02\nundo.halvings = 51", "at most 50"},
      {"spacing = 0.02", "spacing = 0.02\nundo.halving = 3", "did you mean \"halvings\"?"},
      {"spacing = 0.02", "spacing = 0.02\nundo.displacement = 0", "displacement = 0.0 [x spacing] must be above 0"},
      {"spacing = 0.02", "spacing = 0.02\nundo.displacement = 2.5", "displacement = 2.5 [x spacing] must be at most 2"},
      {"spacing = 0.02", "spacing = 0.02\nundo.distance = 0.6", "distance = 0.6 [x spacing] must be at most 0.5"},
      {"spacing = 0.02", "spacing = 0.02\nundo = { halvings = 0, distance = 0.1 }", "with halvings = 0 none is"},
      {"spacing = 0.02", "spacing = 0.02\nscheme = \"classic\"\nundo.displacement = 0.5",
       "give halvings, or delete it"},
      {"spacing = 0.02", "spacing = 0.02\nadaptive = true\nundo.displacement = 0.2", "would undo every step"},
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

TEST_CASE("walls may touch, stand in each other, and pass through open sides", "[unit][case]") {
  for (const char* more : {
           "[geometry.bed]\ntype = \"polyline\"\npoints = [[0.0, 0.1], [0.1, 0.0]]\n",
           "[geometry.pier]\ntype = \"box\"\nmin = [0.2, 0.1]\nmax = [0.25, 0.15]\n",
           "[geometry.side]\ntype = \"box\"\nmin = [0.4, 0.0]\nmax = [0.8, 0.4]\n",
           "[geometry.pipe]\ntype = \"box\"\nmin = [0.1, 0.3]\nmax = [0.2, 0.6]\nopen = [\"bottom\"]\n",
           "[geometry.wall]\ntype = \"plate\"\nbase = [0.2, 0.0]\nheight = 0.7\n",
           "[geometry.leaning]\ntype = \"plate\"\nbase = [0.2, 0.0]\nheight = 0.1\nangle = \"-30 deg\"\n",
           "[geometry.falling]\ntype = \"plate\"\nbase = [0.2, 0.5]\nheight = 0.1\n"
           "[geometry.falling.motion]\nvelocity = [0, \"-9.81*t\"]\n",
       }) {
    INFO(more);
    CHECK(complaint_about(small_case() + more).empty());
  }
}

TEST_CASE("a case in 3-D that makes no sense is refused", "[unit][case]") {
  CHECK(complaint_about(tank_3d()).empty());
  const std::vector<std::array<std::string, 3>> slips{
      {"open = [\"back\", \"top\"]", "open = [\"behind\"]", "known: left, right, front, back, bottom, top"},
      {"base = [0.3, 0.1, 0.0]", "base = [0.3, 0.15, 0.0]\nangle = 0.1", ""},  // out through the open back
      {"base = [0.3, 0.1, 0.0]", "base = [0.3, 0.05, 0.0]", "not inside the box"},
      {"width = 0.2", "width = 0.01", "larger than the plate \"gate\", which is 0.01 m wide"},
      {"level = 0.08", "level = 0.01", "the fluid is empty: its region is 0.01 m wide in z"},
      {"level = 0.08", "level = -1", "reaches from z = 0 m to 0.4 m"},
      {"[[fluid]]", "[geometry.b]\ntype = \"box\"\nmin = [0.2, 0.05, 0.1]\nmax = [0.6, 0.1, 0.2]\n[[fluid]]",
       "the walls of \"tank\" and \"b\" cross at [0.4, 0.05, 0.15] m"},
      {"[[fluid]]", "[geometry.b]\ntype = \"box\"\nmin = [0.2, 0.05, 0.1]\nmax = [0.3, 0.3, 0.2]\n[[fluid]]", ""},
      {"[[fluid]]", "[geometry.b]\ntype = \"plate\"\nbase = [0.3, 0.1, 0]\nheight = 0.1\nwidth = 0.1\n[[fluid]]",
       "overlap"},
      {"[[fluid]]", "[geometry.gate.motion]\nrotation = \"t\"\nabout = [0, 0, 0]\naxis = [0, 0, 0]\n[[fluid]]",
       "axis has no direction"},
      {"spacing = 0.02", "spacing = 0.02\nradius = 11", "must be at most 10"},
      {"[[fluid]]", "[domain]\nmin = [-1e6, -1e6, -1e6]\nmax = [1e6, 1e6, 1e6]\n[[fluid]]", "a smaller [domain]"},
  };
  for (const auto& [before, after, answer] : slips) {
    std::string text = tank_3d();
    text.replace(text.find(before), before.size(), after);
    std::string said;
    try {
      scene_of_text(text);
    } catch (const Error& error) {
      said = error.what();
    }
    INFO(after << " -> " << said);
    CHECK(answer.empty() == said.empty());
    CHECK(contains(said, answer));
  }
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
  const Plan plan = plan_of(scene_of_text(small_case(), {set_option("fluid.0.region.max=[0.3, 0.1]")}));
  CHECK(plan.particles == 75);  // 0.3 / 0.02 is 14.999...
  CHECK(plan.steps == 9);
  CHECK(plan.frames == 5);
  CHECK(plan.cfl == Approx(2 * std::sqrt(9.81 * 0.1) * 0.0023 / 0.02));
}

TEST_CASE("the plan warns of what is allowed and hardly meant", "[unit][case]") {
  const auto warnings = [](const std::string& more) {
    const Scene scene = scene_of_text(tank_3d() + more);
    std::string all;
    for (const std::string& warning : plan_of(scene).warnings) all += warning + '\n';
    return all;
  };
  CHECK(warnings("").empty());
  CHECK(contains(warnings("[geometry.tank.motion]\nvelocity = [0.1, 0, 0]\n"), "tank moves and gate in it does not"));
  CHECK(contains(warnings("[geometry.gate.motion]\nvelocity = [0, 0, 8]\n"), "gate moves 0.80 x spacing in the step"));
  CHECK(contains(warnings("[[probe]]\nname = \"p\"\nkind = \"wall_pressure\"\npoint = [5, 0, 0]\n"),
                 "probe p is outside"));
}

TEST_CASE("the plan counts a ball by its volume", "[unit][case]") {
  const auto particles = [](const std::string& text, const std::string& region) {
    const Plan plan = plan_of(scene_of_text(text, {set_option("fluid.0.region=" + region)}));
    CHECK(!plan.at_most);
    return plan.particles;
  };
  CHECK(particles(small_case(), "{type=\"ball\", centre=[0.2, 0.2], radius=0.1}") == 79);           // 25 pi
  CHECK(particles(tank_3d(), "{type=\"ball\", centre=[0.2, 0.1, 0.2], radius=\"10 cm\"}") == 524);  // 500 pi / 3
}

TEST_CASE("a ball reads back to itself, and needs its own keys", "[unit][case]") {
  const std::string region = "region = { type = \"box\", min = [0.0, 0.0], max = [0.1, 0.2] }";
  const std::string text = with(region, "region = { type = \"ball\", centre = [0.2, \"15 cm\"], radius = 0.1 }");
  CaseFile first(text, "a.toml", {});
  const Scene scene = read_scene(first);
  CaseFile second(first.resolved(), "b.toml", {});
  const Scene again = read_scene(second);
  CHECK(without_comments(first.resolved()) == without_comments(second.resolved()));
  CHECK(again.fluid.ball.value().centre == Point{0.2, 0.15, 0});
  CHECK(again.fluid.ball.value().radius == 0.1);
  CHECK(scene.fluid.min[0] == Approx(0.1));
  CHECK(scene.fluid.max[1] == Approx(0.25));
  for (const auto& [before, after, answer] : std::vector<std::array<std::string, 3>>{
           {"centre = [0.2, \"15 cm\"]", "center = [0.2, 0.15]", "did you mean \"centre\"?"},
           {"radius = 0.1", "max = [0.3, 0.3]", "missing key \"radius\" [m]"},
           {"radius = 0.1", "radius = 0.2", "reaches out of the box"},
           {"radius = 0.1", "radius = 0.005", "the fluid is empty"},
           {"centre = [0.2, \"15 cm\"]", "centre = [0.2]", "centre needs 2 components"},
       }) {
    std::string slip = text;
    slip.replace(slip.find(before), before.size(), after);
    INFO(after << " -> " << complaint_about(slip));
    CHECK(contains(complaint_about(slip), answer));
  }
}

TEST_CASE("a disc may lie in a round tank, and not reach out of it", "[unit][case]") {
  const std::string text = R"toml(format = 1
[case]
name = "drop"
[time]
end = 0.1
[geometry.hull]
type = "polyline"
points = [[0.3, 0.0], [0.5, 0.1], [0.5, 0.4], [0.3, 0.5], [0.1, 0.4], [0.1, 0.1]]
closed = true
[[fluid]]
velocity = ["0.1*sqrt(0.0397 - (x - 0.3)^2 - (y - 0.25)^2)", 0]
region = { type = "ball", centre = [0.3, 0.25], radius = 0.199 }
[mps]
spacing = 0.02
time_step = 0.002
)toml";
  CHECK(complaint_about(text).empty());
  const std::string larger = complaint_about(text, {set_option("fluid.0.region.radius=0.23")});
  CHECK(contains(larger, "the fluid reaches out of \"hull\""));
}

TEST_CASE("the plan of steps that adapt knows the fewest", "[unit][case]") {
  const Scene scene = scene_of_text(small_case(), {set_option("mps.adaptive=true"), set_option("mps.time_step=0.02")});
  const Plan plan = plan_of(scene);
  const double dt = 0.25 * std::sqrt(0.02 / 9.81);
  CHECK(plan.steps == std::ceil(0.02 / dt));
  CHECK(plan.at_least);
  CHECK(plan.frames == 5);
  CHECK(plan.cfl == 0.25);
  const auto lines = plan_lines(plan, scene);
  CHECK(contains(lines[0], "dt up to 0.0112881 s, cfl 0.25"));
  CHECK(contains(lines[1], "at least 2 steps"));
}

TEST_CASE("the plan counts in 3-D", "[unit][case]") {
  const Scene scene = scene_of_text(tank_3d());
  const Plan plan = plan_of(scene);
  CHECK(plan.particles == 20 * 10 * 4);
  CHECK(!plan.at_most);
  CHECK(plan.cfl == Approx(2 * std::sqrt(9.81 * 0.08) * 0.002 / 0.02));
  // A sphere of 2.1 spacings, 8 bytes a neighbour, half as much again for growth; 350 bytes for the multigrid, and 99
  // for a step that can be undone.
  CHECK(plan.memory == Approx(plan.particles * (464 + 350 + 99 + 1.5 * 8 * 4.0 / 3 * std::acos(-1) * 2.1 * 2.1 * 2.1)));
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
