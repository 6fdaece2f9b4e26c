#include "app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "core/build_facts.hpp"
#include "io/suggest.hpp"

namespace greenwater {
namespace {

/// The raw words, before they are put together.
struct Typed {
  Command command;
  std::vector<std::string> sets;
  std::string until, output;
  bool verbose = false, quiet = false, plain = false;
};

void add_case(CLI::App& verb, Typed& typed) {
  verb.add_option("case", typed.command.run.case_path, "The case file (TOML)")->required()->type_name("CASE");
  verb.add_option("--set", typed.sets, "Change a value of the case, e.g. --set mps.spacing=0.002 (repeatable)")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->allow_extra_args(false)
      ->take_all();
  verb.add_option("--until", typed.until, "End of the run [s] instead of time.end")->type_name("TIME");
  verb.add_flag("--no-color", typed.plain, "No colours on the terminal (as NO_COLOR in the environment)");
}

void add_run(CLI::App& app, Typed& typed) {
  RunOptions& run = typed.command.run;
  CLI::App* verb = app.add_subcommand("run", "Run a case");
  add_case(*verb, typed);
  verb->add_option("-o,--output", typed.output, "The run folder; it must not exist (default: from the case)")
      ->type_name("DIR");
  verb->add_flag("--overwrite", run.overwrite, "Remove the run that is in the folder of -o first");
  verb->add_option("--max-steps", run.max_steps, "Stop after N steps")
      ->type_name("N")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000'000}));
  verb->add_flag("-n,--dry-run", run.dry_run, "Read, check and print the plan; write nothing (as check)");
  verb->add_option("-j,--threads", run.threads, "Threads (default: OMP_NUM_THREADS, or all cores)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  verb->add_flag("--no-fields", run.no_fields, "Write no frames, for timing");
  CLI::Option* verbose = verb->add_flag("-v,--verbose", typed.verbose, "Print every row of the log");
  verb->add_flag("-q,--quiet", typed.quiet, "Print errors only")->excludes(verbose);
  verb->footer(
      "Example:\n  greenwater run cases/dam_break_rigid/quick.toml -j 2 --set mps.spacing=0.005 -o runs/trial\n"
      "Exit codes: 0 finished, 2 wrong case or option, 3 numbers failed, 4 file error, 5 out of memory or device,\n"
      "  75 stopped by a signal after a whole step (a second Ctrl-C ends it at once)");
}

void add_check(CLI::App& app, Typed& typed) {
  CLI::App* verb = app.add_subcommand("check", "Read and check a case, count, warn; write nothing");
  add_case(*verb, typed);
  verb->footer("Example:\n  greenwater check cases/dam_break_rigid/paper.toml --set mps.time_step=\"0.1 ms\"");
}

void add_info(CLI::App& app, Typed& typed) {
  CLI::App* verb = app.add_subcommand("info", "Version, Kokkos, back-end, threads, memory, limits");
  verb->add_flag("--json", typed.command.json, "The same as JSON");
  verb->footer("Example:\n  greenwater info --json");
}

std::string version_text() {
  const BuildFacts& facts = build_facts();
  return text_of("greenwater ", facts.version, " (git ", facts.git, ", ", facts.build_type, ", Kokkos ",
                 facts.kokkos_version, ")");
}

/// CLI11 only says that a subcommand is missing.
void require_known_verb(int argc, const char* const* argv) {
  const std::vector<std::string> verbs{"run", "check", "info", "bench"};
  if (argc < 2 || argv[1][0] == '-') return;
  const std::string verb = argv[1];
  if (std::find(verbs.begin(), verbs.end(), verb) != verbs.end()) return;
  const std::string near = nearest(verb, verbs);
  const bool is_case = verb.ends_with(".toml");
  throw CaseError(text_of("greenwater: error: unknown command \"", verb, "\"; ",
                          is_case        ? "did you mean: greenwater run " + verb
                          : near.empty() ? "known: " + listed(verbs)
                                         : "did you mean \"" + near + "\"?"));
}

Command put_together(Typed& typed, const CLI::App& app) {
  Command& command = typed.command;
  RunOptions& run = command.run;
  if (app.got_subcommand("run")) command.verb = run.dry_run ? Command::Verb::check : Command::Verb::run;
  if (app.got_subcommand("check")) command.verb = Command::Verb::check;
  if (app.got_subcommand("info")) command.verb = Command::Verb::info;
  if (app.got_subcommand("bench")) command.verb = Command::Verb::bench;
  for (const std::string& set : typed.sets) run.case_options.push_back(set_option(set));
  if (!typed.until.empty()) run.case_options.push_back({"--until " + typed.until, "time.end", typed.until});
  if (!typed.output.empty()) run.output = typed.output;
  require(!run.overwrite || run.output, "--overwrite: error: it needs -o DIR, the folder to replace");
  run.verbosity = typed.quiet ? Verbosity::quiet : typed.verbose ? Verbosity::verbose : Verbosity::normal;
  run.color = !typed.plain;
  return command;
}

}  // namespace

Command parse_command_line(int argc, const char* const* argv) {
  Typed typed;
  typed.command.run.command_line.assign(argv, argv + argc);
  typed.command.bench.command_line = typed.command.run.command_line;
  CLI::App app{"Greenwater: free-surface flow with moving particles (MPS)", "greenwater"};
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.footer("Example:\n  greenwater run cases/dam_break_rigid/quick.toml\nMore: greenwater VERB --help");
  add_run(app, typed);
  add_check(app, typed);
  add_info(app, typed);
  add_bench(app, typed.command.bench);
  require_known_verb(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& printed) {  // --help, --version
    app.exit(printed, std::cout, std::cerr);
    return {};
  } catch (const CLI::ParseError& fault) {
    throw CaseError(text_of("greenwater: error: ", fault.what(), "; see greenwater --help"));
  }
  return put_together(typed, app);
}

}  // namespace greenwater
