#include "app/bench_options.hpp"

#include <CLI/CLI.hpp>

namespace greenwater {
namespace {

using What = BenchOptions::What;

template <class T>
CLI::Option* add_list(CLI::App& verb, const std::string& name, std::vector<T>& list, const std::string& meaning,
                      const std::string& type) {
  return verb.add_option(name, list, meaning)->delimiter(',')->type_name(type)->allow_extra_args(false);
}

CLI::App* add_bare_verb(CLI::App& bench, BenchOptions& options, What what, const std::string& name,
                        const std::string& meaning) {
  CLI::App* verb = bench.add_subcommand(name, meaning);
  verb->callback([&options, what] { options.what = what; });
  return verb;
}

CLI::App* add_verb(CLI::App& bench, BenchOptions& options, What what, const std::string& name,
                   const std::string& meaning) {
  CLI::App* verb = add_bare_verb(bench, options, what, name, meaning);
  add_list(*verb, "--sizes", options.sizes, "Particles, nearly: 5000,20000,80000", "N,...")
      ->check(CLI::Range(32, 2'000'000'000));
  verb->add_option("--dim", options.dimension, "Dimension of the scene: 2 or 3")->check(CLI::IsMember({2, 3}));
  add_list(*verb, "--states", options.states, "rest, early, collapse, splash: t = 2, 50, 150, 300 ms", "NAME,...");
  add_list(*verb, "-j,--threads", options.threads, "Threads; of scaling a list", "N,...")->check(CLI::Range(1, 4096));
  verb->add_option("--cache", options.cache, "Folder for the states (default: $XDG_CACHE_HOME or ~/.cache, greenwater)")
      ->type_name("DIR");
  return verb;
}

void add_rounds(CLI::App& verb, BenchOptions& options) {
  verb.add_option("--json", options.json, "Write the results to this file")->type_name("FILE");
  verb.add_option("--rounds", options.rounds, "Everything is measured so often, in turn")
      ->capture_default_str()
      ->check(CLI::Range(1, 100'000));
}

void add_results(CLI::App& verb, BenchOptions& options) {
  add_rounds(verb, options);
  verb.add_option("--set", options.sets, "Change a value of the case that is measured, not of the states (repeatable)")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
}

CLI::Option* add_tolerances(CLI::App& verb, BenchOptions& options, const std::string& usual) {
  return add_list(verb, "--tolerance", options.tolerances, "Relative residual of the pressure (default: " + usual + ")",
                  "X")
      ->check(CLI::Range(1e-16, 1.0));
}

void add_steps(CLI::App& verb, BenchOptions& options) {
  add_tolerances(verb, options, "1e-4");
  verb.add_option("--steps", options.steps, "Steps of a round")->capture_default_str()->check(CLI::Range(1, 100'000));
}

void add_pressure(CLI::App& bench, BenchOptions& options) {
  CLI::App* verb = add_verb(bench, options, What::pressure, "pressure", "Iterations and time of the pressure solve");
  add_results(*verb, options);
  add_tolerances(*verb, options, "1e-4,1e-6,1e-8");
  add_list(*verb, "--plates", options.plates, "Cut into the water: none, plate (wet on both sides), barrier",
           "NAME,...");
  add_list(*verb, "--preconditioners", options.preconditioners, "Those to compare; the first stands for 1", "NAME,...");
  add_list(*verb, "--solvers", options.solvers, "Those to compare: cg, recomputed", "NAME,...");
  verb->add_option("--source", options.source, "Right side: density or divergence")
      ->capture_default_str()
      ->check(CLI::IsMember({"density", "divergence"}));
  verb->footer("Example:\n  greenwater bench pressure --sizes 5000,20000 --states rest,splash --json pressure.json");
}

void add_fem(CLI::App& bench, BenchOptions& options) {
  CLI::App* verb = add_bare_verb(bench, options, What::fem, "fem", "A structure's substep, element by element");
  add_list(*verb, "--sizes", options.sizes, "Elements, nearly (default: 100,10000,100000)", "N,...")
      ->check(CLI::Range(1, 2'000'000));
  add_list(*verb, "-j,--threads", options.threads, "Threads; one thread is measured too", "N")
      ->check(CLI::Range(1, 4096));
  add_rounds(*verb, options);
  verb->footer("Example:\n  greenwater bench fem --sizes 100 --rounds 21 --json fem.json");
}

}  // namespace

void add_bench(CLI::App& app, BenchOptions& options) {
  CLI::App* bench = app.add_subcommand("bench", "Measure what a step costs on this machine");
  bench->require_subcommand(1);
  CLI::App* step = add_verb(*bench, options, What::step, "step", "The whole step, region by region");
  add_results(*step, options);
  add_steps(*step, options);
  step->footer("Example:\n  greenwater bench step --sizes 20000,80000 -j 2 --json step.json");
  add_pressure(*bench, options);
  CLI::App* scaling = add_verb(*bench, options, What::scaling, "scaling", "The whole step over sizes and threads");
  add_results(*scaling, options);
  add_steps(*scaling, options);
  scaling->footer("Example:\n  greenwater bench scaling --dim 3 --sizes 30000,100000 -j 1,2 --json scaling.json");
  add_fem(*bench, options);
  CLI::App* states = add_verb(*bench, options, What::states, "states", "Make the states that the others start from");
  states->footer("Example:\n  greenwater bench states --sizes 5000,20000,80000 --states rest,collapse,splash");
  bench->footer(
      "Example:\n  greenwater bench step --sizes 5000\n"
      "The scene is a column of water that collapses in a tank. States that are missing are made first and kept.");
}

}  // namespace greenwater
