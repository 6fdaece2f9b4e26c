#pragma once
// The command line, taken apart. Nothing of it ever reaches Kokkos.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/bench_options.hpp"
#include "io/case_file.hpp"
#include "io/log.hpp"

namespace greenwater {

/// What `run` and `check` were asked to do.
struct RunOptions {
  std::string case_path;
  std::optional<std::string> output;  ///< -o: the run folder; else from the case
  bool overwrite = false;
  std::vector<CaseOption> case_options;  ///< --set, --until
  std::int64_t max_steps = 0;            ///< 0: no limit
  bool dry_run = false;
  int threads = 0;         ///< 0: left to Kokkos and OMP_NUM_THREADS
  bool no_fields = false;  ///< no frames
  Verbosity verbosity = Verbosity::normal;
  bool color = true;
  std::vector<std::string> command_line;  ///< all of it, for the record
};

struct Command {
  enum class Verb { run, check, info, bench, nothing };  // nothing: help or version was printed
  Verb verb = Verb::nothing;
  RunOptions run;
  BenchOptions bench;
  bool json = false;  // info
};

/// Reads the command line; prints help and version itself. Throws CaseError (exit code 2) for a wrong one, with the
/// cure and the way to the help.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace greenwater
