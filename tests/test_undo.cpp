// Steps that are undone: nothing of them is left, a step that was far too long is made again until it is short enough,
// and a run that cannot go on ends with what it had.

#include <algorithm>
#include <iostream>
#include <limits>

#include "core/check.hpp"
#include "kernels/moves.hpp"
#include "tests/elastic.hpp"
#include "tests/program.hpp"
#include "tests/runs.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double l0 = 0.008;  // [m] of the dam breaks here

/// A column of water that breaks, 0.4 m high, in the tank of the paper; 1250 particles. Its front is at 0.6 m after 0.23 s.
const std::string dam_break =
    "format = 1\n[case]\nname = \"dam\"\n[time]\nend = 0.3\n"
    "[geometry.tank]\ntype = \"box\"\nmin = [0, 0]\nmax = [0.8, 0.6]\nopen = [\"top\"]\n"
    "[[fluid]]\nname = \"w\"\nregion = { type = \"box\", min = [0, 0], max = [0.2, 0.4] }\n"
    "[mps]\nspacing = 0.008\ntime_step = 8e-4\n"
    "[[probe]]\nname = \"front\"\nkind = \"wave_front\"\n";

const std::string on_rigid_plate =
    dam_break + "[geometry.plate]\ntype = \"plate\"\nbase = [0.6, 0]\nheight = 0.1\nthickness = 0.015\n";

/// The paper's Poli-30.
const std::string on_elastic_plate =
    dam_break +
    "[[structure]]\nname = \"plate\"\nbase = [0.6, 0]\nbase_side = \"upstream\"\nheight = 0.1\nwidth = 0.2\n"
    "thickness = 0.003\nyoung = 3.43e9\ndensity = 1200\npoisson = 0.37\n[structure.fem]\ndivisions = [1, 12, 1]\n"
    "damping_alpha = 426\n[[probe]]\nname = \"tip\"\nkind = \"structure_displacement\"\nheight_fraction = 1\n"
    "[[probe]]\nname = \"held\"\nkind = \"structure_reaction\"\n";

std::vector<CaseOption> options_of(const std::vector<std::string>& settings) {
  std::vector<CaseOption> options;
  for (const std::string& setting : settings) options.push_back(set_option(setting));
  return options;
}

/// A force that is no number from that time on, whatever the step.
std::string failing_from(double time, int dim = 2) {
  return text_of("effects.body_force.acceleration=[\"t > ", time, " ? 0/0 : 0\", 0", dim == 3 ? ", 0]" : "]");
}

/// What was said of steps that were undone.
std::vector<std::string> undone_of(const StepFacts& facts) {
  std::vector<std::string> texts;
  for (const Notice& notice : facts.notices)
    if (notice.kind == "undone") texts.push_back(notice.text);
  return texts;
}

template <class Field>
void add(std::vector<double>& all, const Field& field, int count) {
  const auto values = host(field);
  for (int i = 0; i < count; ++i)
    if constexpr (Field::rank == 1)
      all.push_back(static_cast<double>(values(i)));
    else
      for (std::size_t d = 0; d < values.extent(1); ++d) all.push_back(static_cast<double>(values(i, d)));
}

void add(std::vector<double>& all, const Eigen::VectorXd& values) {
  all.insert(all.end(), values.data(), values.data() + values.size());
}

void add_walls(std::vector<double>& all, const Fluid& fluid) {
  for (const WallFace& face : fluid.faces.faces)
    for (const WallPoint& point : face.corner)
      for (const auto& value : {point.position, point.velocity, point.acceleration})
        all.insert(all.end(), value.begin(), value.end());
  const auto panels = host(fluid.walls.panel);
  for (int k = 0; k < fluid.walls.panels; ++k)
    for (int d = 0; d < 3; ++d) {
      for (const double value :
           {panels(k).normal[d], panels(k).point[d], panels(k).velocity.value[d], panels(k).acceleration.value[d]})
        all.push_back(value);
      for (int e = 0; e < 3; ++e) all.push_back(panels(k).velocity.gradient[d][e]);
    }
}

void add_structures(std::vector<double>& all, const FluidSimulation& simulation, int structures) {
  const Coupler& coupler = simulation.coupler();
  for (int k = 0; k < structures; ++k) {
    const March& march = *coupler.body(k).march;
    for (const Eigen::VectorXd* values : {&march.state().u, &march.state().v, &march.state().held, &march.reaction()})
      add(all, *values);
    const Energies energies = march.energies();
    const InterfaceLedger& ledger = coupler.ledger(k);
    for (const double value : {march.time(), energies.balance(), energies.lost, energies.loads, energies.supports,
                               ledger.sums().by_fluid, ledger.sums().by_structure, ledger.sums().impulse[0],
                               static_cast<double>(ledger.alternations()), ledger.growth()})
      all.push_back(value);
    add(all, coupler.loads(k));
  }
  all.push_back(coupler.passes());
}

/// Every number of the state, in its order.
std::vector<double> state_of(const FluidSimulation& simulation, int structures = 0) {
  const Particles& p = simulation.fluid().particles;
  std::vector<double> all{simulation.time(), simulation.dt(), static_cast<double>(simulation.steps()),
                          simulation.fluid().time, static_cast<double>(p.count)};
  add(all, p.id, p.count);
  add(all, p.position, p.count);
  add(all, p.velocity, p.count);
  add(all, p.acceleration, p.count);
  add(all, p.pressure, p.count);
  add(all, p.number_density, p.count);
  add(all, p.surface, p.count);
  for (const ExtraField& extra : p.extras) add(all, extra.values, p.count);
  add_walls(all, simulation.fluid());
  add_structures(all, simulation, structures);
  return all;
}

/// Marches up to `steps`, where a step fails at any length.
void check_nothing_is_left(const Scene& scene, int steps, int structures = 0) {
  FluidSimulation simulation(scene);
  std::vector<double> before = state_of(simulation, structures);
  for (int k = 0; k < steps; ++k) {
    const std::vector<double> last = before;
    simulation.step();
    before = state_of(simulation, structures);
    REQUIRE(before != last);
    for (const double value : before) REQUIRE(std::isfinite(value));
  }
  const double ratio = simulation.facts().energy_ratio;
  CHECK_THROWS_AS(simulation.step(), NumericsError);
  CHECK(simulation.steps() == steps);
  CHECK(state_of(simulation, structures) == before);
  CHECK(simulation.facts().energy_ratio == ratio);
}

}  // namespace

TEST_CASE("nothing is left of a step that is undone", "[unit][undo]") {
  // The force is there from the start of the last step on.
  const auto with = [](std::vector<std::string> settings, int steps, double dt) {
    settings.push_back(failing_from((steps - 0.5) * dt));
    return settings;
  };
  SECTION("water on a rigid plate") {
    check_nothing_is_left(scene_of_text(on_rigid_plate, options_of(with({}, 5, 8e-4))), 5);
  }
  SECTION("in the classic scheme, where it is asked for") {
    check_nothing_is_left(
        scene_of_text(on_rigid_plate, options_of(with({"mps.scheme=classic", "mps.undo.halvings=3"}, 5, 8e-4))), 5);
  }
  SECTION("walls that move") {
    check_nothing_is_left(
        with_default_scheme(scene_of("moving_walls/piston.toml", with({"mps.undo.halvings=4"}, 6, 0.00046))), 6);
  }
  SECTION("an elastic plate in the water") {
    const std::string wet = "fluid.0.region={type=\"box\", min=[0.4, 0], max=[0.7, 0.2]}";
    check_nothing_is_left(scene_of_text(on_elastic_plate, options_of(with({wet}, 5, 8e-4))), 5, 1);
  }
  SECTION("a particle that leaves the domain in it") {
    const std::vector<std::string> domain{"domain.min=[-0.1, -0.1]", "domain.max=[0.2005, 0.6]"};
    FluidSimulation whole(scene_of_text(on_rigid_plate, options_of(domain)));
    while (whole.fluid().particles.count == 1250) whole.step();
    const int before = static_cast<int>(whole.steps()) - 1;
    REQUIRE(before > 1);
    check_nothing_is_left(scene_of_text(on_rigid_plate, options_of(with(domain, before, 8e-4))), before);
  }
  SECTION("in three dimensions") {
    check_nothing_is_left(with_default_scheme(scene_of("dam_break_3d/dam_break_3d.toml",
                                                       {"mps.undo.halvings=2", "mps.spacing=0.03",
                                                        "mps.time_step=0.003", failing_from(0.0075, 3)})),
                          3);
  }
}

TEST_CASE("the first step can be undone too, whatever effects hold", "[unit][undo][effects]") {
  const std::vector<std::string> all{"effects.body_force.acceleration=[\"1\", \"0.5*x\"]",
                                     "effects.viscosity.kinematic=1e-6", "effects.collision.distance=0.5",
                                     "mps.pressure.max_iterations=1", "mps.undo.halvings=3"};
  for (const char* scheme : {"default", "high", "classic"}) {
    INFO(scheme);
    std::vector<std::string> settings = all;
    settings.push_back(text_of("mps.scheme=", scheme));
    check_nothing_is_left(scene_of_text(on_rigid_plate, options_of(settings)), 0);
  }
}

TEST_CASE("a first step that a body force makes too long is made again, and the force is as without", "[unit][undo]") {
  const std::string strong = "effects.body_force.acceleration=[\"2e4\", \"0\"]";
  FluidSimulation simulation(scene_of_text(on_rigid_plate, options_of({strong})));
  simulation.step();
  REQUIRE(!undone_of(simulation.facts()).empty());
  FluidSimulation other(scene_of_text(on_rigid_plate, options_of({strong})));
  other.step_of(simulation.dt());
  REQUIRE(undone_of(other.facts()).empty());
  CHECK(state_of(simulation) == state_of(other));
}

TEST_CASE("a step that the classic scheme repeats with its structures keeps what effects hold",
          "[unit][undo][effects]") {
  const std::string wet = "fluid.0.region={type=\"box\", min=[0.4, 0], max=[0.7, 0.2]}";
  FluidSimulation simulation(scene_of_text(
      on_elastic_plate, options_of({wet, "mps.scheme=classic", "coupling.scheme=aitken", "mps.undo.halvings=0",
                                    "coupling.tolerance=1e-9", "effects.body_force.acceleration=[\"1\", \"0\"]"})));
  for (int k = 0; k < 3; ++k) {
    simulation.step();
    CHECK(simulation.coupler().passes() > 1);
    REQUIRE(simulation.fluid().particles.extras.size() == 1);
    CHECK(host(simulation.fluid().particles.extras[0].values)(7, 0) == 1);
  }
}

TEST_CASE("who leaves while steps are undone is counted once: particles and lost are what there was", "[unit][undo]") {
  for (const char* scheme : {"default", "classic"}) {
    INFO(scheme);
    FluidSimulation simulation(
        scene_of_text(on_rigid_plate, options_of({"domain.min=[-0.1, -0.1]", "domain.max=[0.2005, 0.6]",
                                                  "mps.undo.halvings=8", text_of("mps.scheme=", scheme)})));
    const std::int64_t start = simulation.facts().particles;
    std::int64_t told = 0, left_in_undone = 0;
    for (int k = 0; k < 120; ++k) {
      const std::int64_t before = simulation.facts().lost;
      simulation.step_of(k > 20 && k % 2 == 0 ? 0.02 : simulation.dt());
      const StepFacts facts = simulation.facts();
      for (const Notice& notice : facts.notices)
        if (notice.kind == "lost") told += notice.count;
      if (!undone_of(facts).empty()) left_in_undone += facts.lost - before;
      REQUIRE(facts.particles + facts.lost == start);
      REQUIRE(told == facts.lost);
    }
    CHECK(left_in_undone > 0);
  }
}

TEST_CASE("the program ends with a message when its first step is undone to the last", "[unit][undo][program]") {
  if (!program_is_there()) return;
  const TemporaryFolder folder;
  write_text(folder / "small.toml", small_case() + "[effects.body_force]\nacceleration = [\"1.0\", \"0\"]\n");
  const Answer stall =
      run_program({"run", "small.toml", "-o", "r", "-q", "--set", "mps.pressure.max_iterations=1"}, folder);
  INFO(stall.out << stall.err);
  CHECK(stall.code == 3);
  CHECK(contains(stall.err, "undone each time"));
  const Answer strong = run_program(
      {"run", "small.toml", "-o", "s", "-q", "--set", "effects.body_force.acceleration=[\"1e4\", \"0\"]"}, folder);
  INFO(strong.out << strong.err);
  CHECK((strong.code == 0 || strong.code == 3));
  CHECK(contains(text_in(folder / "s/run.log"), "was undone and is tried again"));
}

TEST_CASE("a shorter step that throws the water off as fast as the long one is undone too", "[unit][undo]") {
  // A wall that is at once so fast that its water has a hundred times the energy of before.
  const std::string text = dam_break +
                           "[geometry.piston]\ntype = \"plate\"\nbase = [0.215, 0]\nheight = 0.5\nthickness = 0.015\n"
                           "[geometry.piston.motion]\ndisplacement = [\"t > 0.01 ? -9*(t - 0.01) : 0\", \"0\"]\n";
  FluidSimulation simulation(scene_of_text(text));
  while (simulation.time() < 0.0099) simulation.step();
  CHECK(undone_of(simulation.facts()).empty());
  try {
    while (simulation.time() < 0.02) simulation.step();
    FAIL("it went on");
  } catch (const NumericsError& error) {
    std::cout << error.what() << '\n';
    CHECK(contains(error.what(), "energy has risen by"));
  }
}

TEST_CASE("a step that was undone and made again is one that was short from the start", "[unit][undo]") {
  const Scene rigid = scene_of_text(on_rigid_plate);
  const Scene moving =
      with_default_scheme(scene_of("moving_walls/piston.toml", {"mps.undo.halvings=8", "mps.undo.displacement=0.1"}));
  for (const Scene& scene : {rigid, moving}) {
    FluidSimulation simulation(scene), other(scene);
    while (simulation.time() < 0.1) {
      simulation.step();
      other.step();
    }
    REQUIRE(undone_of(simulation.facts()).empty());
    other.facts();
    simulation.step_of(64 * scene.mps.time_step);
    const auto undone = undone_of(simulation.facts());
    REQUIRE(!undone.empty());
    CHECK(simulation.dt() == 64 * scene.mps.time_step / std::exp2(static_cast<double>(undone.size())));
    other.step_of(simulation.dt());
    CHECK(undone_of(other.facts()).empty());
    CHECK(state_of(simulation) == state_of(other));
    simulation.step();
    other.step();
    CHECK(state_of(simulation) == state_of(other));
  }
}

namespace {

struct Curve {
  std::vector<double> time, kinetic, potential;
  double tip = 0;  // furthest displacement of the plate's [m]

  void add(const StepFacts& facts) {
    time.push_back(facts.time);
    kinetic.push_back(facts.kinetic_energy);
    potential.push_back(facts.potential_energy);
  }
  double at(const std::vector<double>& values, double t) const {
    const auto after = static_cast<std::size_t>(std::lower_bound(time.begin(), time.end(), t) - time.begin());
    if (after == 0) return values.front();
    if (after == time.size()) return values.back();
    const double s = (t - time[after - 1]) / (time[after] - time[after - 1]);
    return values[after - 1] + s * (values[after] - values[after - 1]);
  }
  double start() const { return kinetic.front() + potential.front(); }
};

/// The largest difference of two curves' energies, each and their sum, over that at the start.
double difference_of(const Curve& a, const Curve& b) {
  double most = 0;
  for (std::size_t k = 0; k < a.time.size(); ++k) {
    const double kinetic = a.kinetic[k] - b.at(b.kinetic, a.time[k]);
    const double potential = a.potential[k] - b.at(b.potential, a.time[k]);
    for (const double each : {kinetic, potential, kinetic + potential}) most = std::max(most, std::fabs(each));
  }
  return most / a.start();
}

struct Provoked {
  Curve curve;
  double made = 0, longest = 0;     // the step that it became, and the longest one after it [s]
  std::vector<std::string> undone;  // what was said
  double end = 0;                   // [s]
};

/// To the end; where the front comes to the plate the step is made `times` as long, if it is asked to.
Provoked run(const Scene& scene, double times, int tip_probe = -1) {
  FluidSimulation simulation(scene);
  Provoked run;
  run.curve.add(simulation.facts());
  bool done = times == 0;
  while (simulation.time() < scene.end * (1 - 1e-9)) {
    const bool now = !done && simulation.sample(0) > 0.6 - l0;
    now ? simulation.step_of(times * simulation.dt()) : simulation.step();
    done = done || now;
    const StepFacts facts = simulation.facts();
    run.curve.add(facts);
    if (tip_probe >= 0) run.curve.tip = std::max(run.curve.tip, simulation.sample(tip_probe));
    for (const std::string& text : undone_of(facts)) run.undone.push_back(text);
    if (now) run.made = facts.dt;
    if (done && !now) run.longest = std::max(run.longest, facts.dt);
  }
  REQUIRE(done);
  run.end = simulation.time();
  return run;
}

/// At 8 mm what splashes is so coarse that a step which is a tenth shorter changes energies by 2 %; at 4 mm by 0.1 %.
const std::vector<std::string> fine{"mps.spacing=0.004", "mps.time_step=4e-4", "mps.pressure.tolerance=1e-6"};

Scene fine_scene(const std::string& text, const std::string& more = {}) {
  std::vector<std::string> settings = fine;
  if (!more.empty()) settings.push_back(more);
  return scene_of_text(text, options_of(settings));
}

void check_same_curve(const std::string& name, const Scene& scene, int tip_probe = -1) {
  INFO(name);
  const Provoked calm = run(scene, 0, tip_probe), wild = run(scene, 20, tip_probe);
  const double difference = difference_of(wild.curve, calm.curve);
  std::cout << name << ": a step 20 times too long at impact was undone " << wild.undone.size() << " times, down to "
            << wild.made << " s; energies differ by " << 100 * difference << " % of E0 at most";
  if (tip_probe >= 0) std::cout << ", furthest tip " << wild.curve.tip << " m, undisturbed " << calm.curve.tip << " m";
  std::cout << "\n  " << (wild.undone.empty() ? "" : wild.undone.front()) << '\n';
  CHECK(calm.undone.empty());
  CHECK(wild.undone.size() >= 3);
  CHECK(difference < 0.01);
  CHECK(wild.end == Approx(scene.end).epsilon(1e-12));
  CHECK(wild.longest <= scene.mps.time_step * (1 + 1e-12));
  if (tip_probe >= 0) CHECK(wild.curve.tip == Approx(calm.curve.tip).epsilon(0.05));
}

}  // namespace

TEST_CASE("a step 20 times too long at impact is undone until it is short enough, and the energy is as without",
          "[stability][undo]") {
  check_same_curve("rigid plate, fixed steps", fine_scene(on_rigid_plate));
  check_same_curve("rigid plate, steps that adapt", fine_scene(on_rigid_plate, "mps.adaptive=true"));
  check_same_curve("elastic plate, fixed steps", fine_scene(on_elastic_plate), 1);
  check_same_curve("elastic plate, steps that adapt", fine_scene(on_elastic_plate, "mps.adaptive=true"), 1);
}

TEST_CASE("without being undone such a step spoils the run", "[stability][undo]") {
  const Scene scene = fine_scene(on_rigid_plate, "mps.undo.halvings=0");
  const Provoked calm = run(scene, 0), shorter = run(scene, 0.9);
  const double noise = difference_of(shorter.curve, calm.curve);
  double difference = std::numeric_limits<double>::infinity();
  try {
    difference = difference_of(run(scene, 20).curve, calm.curve);
  } catch (const NumericsError&) {  // it may as well end
  }
  std::cout << "not undone: energies differ by " << 100 * difference << " % of E0; after a step a tenth too short by "
            << 100 * noise << " %\n";
  CHECK(noise < 0.005);
  CHECK(difference > 0.02);
}

TEST_CASE("fixed steps come back to their length, and the end is met exactly", "[unit][undo]") {
  for (const bool elastic : {false, true}) {
    const Scene scene = scene_of_text(elastic ? on_elastic_plate : on_rigid_plate,
                                      options_of({"time.end=0.0403", "fluid.0.velocity=[0.5, 0]"}));
    FluidSimulation simulation(scene);
    for (int k = 1; k <= 10; ++k) {
      simulation.step();
      CHECK(simulation.time() == k * 8e-4);
    }
    simulation.step_of(0.02);
    REQUIRE(simulation.dt() < 0.02);
    double before = simulation.dt(), sum = simulation.time(), longest = 0;
    const double quantum = elastic ? simulation.coupler().body(0).options.step : 0;
    while (simulation.time() < scene.end) {
      simulation.step();
      const double dt = simulation.dt();
      CHECK(dt <= std::max(1.1 * before, before + quantum) * (1 + 1e-12));
      CHECK(dt <= 8e-4);
      if (elastic) CHECK(dt / quantum == Approx(std::round(dt / quantum)).epsilon(1e-9));
      before = dt;
      sum += dt;
      longest = std::max(longest, dt);
    }
    CHECK(longest == 8e-4);
    CHECK(simulation.time() == scene.end);
    CHECK(std::fabs(sum - scene.end) <= 1e-12 + quantum);
    if (elastic) CHECK(simulation.coupler().body(0).march->time() == Approx(sum).epsilon(1e-9));
  }
}

TEST_CASE("a run that no shorter step helps ends with what it had, and says so", "[unit][undo]") {
  const Scene scene = scene_of_text(on_rigid_plate, options_of({failing_from(0.0038), "mps.undo.halvings=5"}));
  FluidSimulation simulation(scene);
  std::string text;
  try {
    for (int k = 0; k < 100; ++k) simulation.step();
  } catch (const NumericsError& error) {
    text = error.what();
  }
  INFO(text);
  CHECK(simulation.time() == Approx(0.004));
  for (const char* part : {"step 6, t = 0.004 s: ", "not a number", "tried 6 time(s), with 0.0008 s down to 2.5e-05 s",
                           "undone each time", "-> "})
    CHECK(contains(text, part));
  const StepFacts facts = simulation.facts();
  CHECK(facts.notices.size() == 5);
  CHECK(std::isfinite(facts.kinetic_energy));
}

TEST_CASE("the program that no shorter step helps keeps all that was good", "[unit][undo][program]") {
  if (!program_is_there()) return;
  const TemporaryFolder folder;
  write_text(folder / "small.toml",
             small_case() + "[effects.body_force]\nacceleration = [\"t > 0.01 ? 0/0 : 0\", 0]\n");
  const Answer answer = run_program({"run", "small.toml", "-o", "r", "-q"}, folder);
  INFO(answer.out << answer.err);
  CHECK(answer.code == 3);
  CHECK(contains(answer.err, "undone each time"));
  CHECK(contains(answer.err, "mps.spacing"));
  CHECK(std::filesystem::exists(folder / "r/FAILED"));
  CHECK(std::filesystem::exists(folder / "r/results.h5"));
  const std::string log = text_in(folder / "r/run.log"), history = text_in(folder / "r/history.csv"),
                    front = text_in(folder / "r/probes/front.csv");
  CHECK(contains(log, "exit 3"));
  CHECK(contains(log, "warning   undone: 8 time(s), first at step 5"));
  CHECK(contains(log, "the step of 0.0023 s was undone and is tried again with 0.00115 s"));
  CHECK(contains(log, "the step of 0.00115 s was undone and is tried again with 0.000575 s"));  // each of them
  CHECK(!contains(history, "nan"));
  CHECK(std::count(front.begin(), front.end(), '\n') == 1 + 6);  // the start and five steps
}

TEST_CASE("a pressure solve that is refused is tried with shorter steps too", "[unit][undo]") {
  FluidSimulation simulation(
      scene_of_text(on_rigid_plate, options_of({"mps.pressure.max_iterations=1", "mps.undo.halvings=2"})));
  std::string text;
  try {
    simulation.step();
  } catch (const NumericsError& error) {
    text = error.what();
  }
  INFO(text);
  CHECK(contains(text, "pressure solve at step 1"));
  CHECK(contains(text, "tried 3 time(s)"));
  CHECK(simulation.steps() == 0);
  // Who wants to go on in spite of it has no step undone for it.
  FluidSimulation bearing(
      scene_of_text(on_rigid_plate, options_of({"mps.pressure.max_iterations=1", "mps.pressure.on_stall=warn"})));
  bearing.step();
  const auto notices = bearing.facts().notices;
  CHECK(std::any_of(notices.begin(), notices.end(), [](const Notice& n) { return n.kind == "stall"; }));
  CHECK(std::none_of(notices.begin(), notices.end(), [](const Notice& n) { return n.kind == "undone"; }));
}

TEST_CASE("where no step is undone nothing is kept or looked at, and where one is a steady step allocates nothing",
          "[unit][undo]") {
  const Ears ears;
  FluidSimulation off(scene_of_text(on_rigid_plate, options_of({"mps.undo.halvings=0"})));
  for (int k = 0; k < 3; ++k) off.step();
  REQUIRE(ears.launched("greenwater::advance"));
  CHECK(!ears.launched("undo"));
  CHECK(!ears.launched("_copy"));
  CHECK(!ears.allocated("undo"));
  CHECK(!ears.allocated("_copy"));
}

TEST_CASE("a march that staggering may make unstable is not undone unless it is asked for", "[unit][undo]") {
  const auto halvings = [](const std::vector<std::string>& settings) {
    return scene_of_text(on_elastic_plate, options_of(settings)).mps.undo.halvings;
  };
  CHECK(halvings({}) == 8);
  CHECK(halvings({"coupling.scheme=aitken"}) == 8);
  CHECK(halvings({"coupling.scheme=staggered"}) == 0);
  CHECK(halvings({"coupling.scheme=staggered", "mps.undo.halvings=2"}) == 2);
}

TEST_CASE("what is kept of a step is kept in the same memory", "[unit][undo]") {
  const std::string wet = "fluid.0.region={type=\"box\", min=[0.4, 0], max=[0.7, 0.2]}";
  FluidSimulation simulation(scene_of_text(on_elastic_plate, options_of({wet})));
  for (int k = 0; k < 5; ++k) simulation.step();
  const Ears ears;
  for (int k = 0; k < 3; ++k) simulation.step();
  CHECK(ears.launched("greenwater::undo_longest_way"));
  CHECK(!ears.allocated("undo"));
  CHECK(!ears.allocated("_copy"));
}

namespace {

/// A cloud before a step and after it: each particle has gone by `way`(id), and the sort has changed the places.
struct Moved {
  Moved(int count, int dim, const std::function<Point(int)>& way)
      : fluid(fluid_at(random_cloud(count, dim, 3), {}, {.dim = dim})) {
    keep(fluid.particles, before);
    first = places();
    const auto x = host(fluid.particles.position);
    const auto id = host(fluid.particles.id);
    for (int i = 0; i < fluid.particles.count; ++i)
      for (int d = 0; d < dim; ++d) x(i, d) += way(id(i))[d];
    Kokkos::deep_copy(fluid.particles.position, x);
    fluid.grid.sort(fluid.particles);
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  }
  Positions places() const {
    const auto x = host(fluid.particles.position);
    const auto id = host(fluid.particles.id);
    Positions at(fluid.particles.count);
    for (int i = 0; i < fluid.particles.count; ++i)
      for (int d = 0; d < fluid.particles.dim; ++d) at[id(i)][d] = x(i, d);
    return at;
  }
  static coord apart(const Positions& x, std::size_t a, std::size_t b) {
    return std::hypot(x[a][0] - x[b][0], x[a][1] - x[b][1], x[a][2] - x[b][2]);
  }
  Fluid fluid;
  Before before;
  Positions first;
};

Point jump(int id, double size) {
  return {size * std::cos(7.0 * id), size * std::sin(3.0 * id), size * std::cos(5.0 * id + 1)};
}

}  // namespace

TEST_CASE("the longest way and who ran together are those of brute force", "[unit][undo]") {
  for (const int dim : {2, 3}) {
    const int count = dim == 2 ? 300 : 800;
    const Moved moved(count, dim, [&](int id) {
      Point way = jump(id, 0.02);
      if (dim == 2) way[2] = 0;
      return way;
    });
    const Positions last = moved.places();
    coord longest = 0;
    int pairs = 0, near = 0;
    const coord distance = 0.03;
    for (int a = 0; a < count; ++a) {
      const Point& x = moved.first[a];
      longest = std::max(longest, std::hypot(last[a][0] - x[0], last[a][1] - x[1], last[a][2] - x[2]));
      for (int b = 0; b < a; ++b) {
        const coord now = Moved::apart(last, a, b);
        near += now < distance;
        pairs += now < distance && now < Moved::apart(moved.first, a, b) / 2;
      }
    }
    CHECK(longest_way(moved.fluid, moved.before) == Approx(longest).epsilon(1e-12));
    CHECK(pairs_run_together(moved.fluid, moved.before, static_cast<real>(distance)) == pairs);
    CHECK(pairs > 0);
    CHECK(pairs < near);
  }
}

TEST_CASE("a drop that flies by itself may go far, but not nowhere", "[unit][undo]") {
  const auto far = [](double way) {
    Positions at = lattice(10, 10, 0.1);
    at.push_back({1.8, 1.8, 0});  // nobody is within 3.1 spacings
    Fluid fluid = fluid_at(at, {}, {});
    Before before;
    keep(fluid.particles, before);
    const auto x = host(fluid.particles.position);
    const auto id = host(fluid.particles.id);
    for (int i = 0; i < fluid.particles.count; ++i) x(i, 0) += id(i) == 100 ? way : 0.01;
    Kokkos::deep_copy(fluid.particles.position, x);
    return longest_way(fluid, before);
  };
  CHECK(far(0.3) == Approx(0.01));
  CHECK(std::isnan(far(std::numeric_limits<double>::quiet_NaN())));
  CHECK(std::isnan(far(std::numeric_limits<double>::infinity())));
  // Nor may a velocity be none.
  Fluid fluid = fluid_at(lattice(5, 5, 0.1), {}, {});
  Before before;
  keep(fluid.particles, before);
  CHECK(longest_way(fluid, before) == 0);
  const auto u = host(fluid.particles.velocity);
  u(7, 1) = std::numeric_limits<real>::quiet_NaN();
  Kokkos::deep_copy(fluid.particles.velocity, u);
  CHECK(std::isnan(longest_way(fluid, before)));
  // And of nobody nothing is wrong.
  Fluid nobody = fluid_at({}, {}, {});
  keep(nobody.particles, before);
  CHECK(longest_way(nobody, before) == 0);
  CHECK(pairs_run_together(nobody, before, real(0.1)) == 0);
}

TEST_CASE("who was near all along has not run together", "[unit][undo]") {
  const auto pairs = [](coord from, coord to) {
    Fluid fluid = fluid_at({{0, 0, 0}, {from, 0, 0}}, {}, {});
    Before before;
    keep(fluid.particles, before);
    const auto x = host(fluid.particles.position);
    for (int i = 0; i < 2; ++i)
      if (x(i, 0) != 0) x(i, 0) = to;
    Kokkos::deep_copy(fluid.particles.position, x);
    return pairs_run_together(fluid, before, real(0.02));
  };
  CHECK(pairs(0.1, 0.01) == 1);
  CHECK(pairs(0.1, 0.03) == 0);
  CHECK(pairs(0.015, 0.01) == 0);
  CHECK(pairs(0.015, 0.007) == 1);
}

TEST_CASE("each limit of a step in turn is the one that it breaks", "[unit][undo]") {
  const Scene scene = scene_of_text(on_rigid_plate);
  Fluid fluid = build_fluid(scene, build_walls(scene));
  Coupler none;
  StepGuard guard(scene, false, {}, 0);
  guard.keep(fluid, none);
  const auto x = host(fluid.particles.position);
  const auto u = host(fluid.particles.velocity);
  const auto complaint = [&](real nearest) -> std::string {
    StepReport report;
    report.nearest = nearest;
    Kokkos::deep_copy(fluid.particles.position, x);
    Kokkos::deep_copy(fluid.particles.velocity, u);
    try {
      guard.check(fluid, report);
    } catch (const NumericsError& error) {
      return error.what();
    }
    return {};
  };
  const coord start = x(600, 0);
  CHECK(complaint(0).empty());
  x(600, 0) = start + 0.85 * l0;  // a lattice: 0.15 spacings from the next one
  CHECK(contains(complaint(0), "1 pair of particles ran together in one step, nearer than mps.undo.distance = 0.2"));
  CHECK(contains(complaint(real(0.15 * l0)), "ran together"));
  CHECK(complaint(real(0.3 * l0)).empty());  // who has looked has seen nobody that near
  x(600, 0) = start + 0.75 * l0;
  CHECK(complaint(0).empty());
  x(600, 0) = start + 1.1 * l0;
  CHECK(contains(complaint(0), "has gone 1.1 x spacing in one step, further than mps.undo.displacement = 1"));
  x(600, 0) = start;
  u(3, 1) = std::numeric_limits<real>::infinity();
  CHECK(contains(complaint(0), "not a number"));
  guard.put_back(fluid, none);
  CHECK(host(fluid.particles.velocity)(3, 1) == 0);
  x(600, 0) = start + 0.01 * l0;
  u(3, 1) = 500;  // 8 kJ/m; all the water has 157 J/m
  CHECK(contains(complaint(1), "energy has risen by"));
  guard.keep(fluid, none);  // the next step, which is not made again
  CHECK(complaint(1).empty());
}

TEST_CASE("collisions know how near the nearest two came", "[unit][undo][effects]") {
  for (const int dim : {2, 3}) {
    Fluid fluid = fluid_at(random_cloud(200, dim, 5), {}, {.dim = dim});
    const auto x = host(fluid.particles.position);
    double nearest = 1;
    for (int a = 0; a < 200; ++a)
      for (int b = 0; b < a; ++b)
        nearest = std::min(nearest, std::hypot(x(a, 0) - x(b, 0), x(a, 1) - x(b, 1), dim == 3 ? x(a, 2) - x(b, 2) : 0));
    const auto collision = make_collision({});
    collision->apply(fluid, real(1e-3));
    CHECK(collision->nearest() == Approx(nearest).epsilon(1e-6));
  }
  Fluid apart = fluid_at({{0, 0, 0}, {0.2, 0, 0}}, {}, {});
  const auto collision = make_collision({});
  collision->apply(apart, real(1e-3));
  CHECK(collision->nearest() >= 0.085);
}
