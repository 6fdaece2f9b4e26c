#pragma once
// Where a run comes from: everything needed to do it again, for manifest.json and for results.h5.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/clock.hpp"
#include "io/results.hpp"

namespace greenwater {

struct RunOrigin {
  std::string case_name, case_file;
  std::vector<std::string> case_options;  ///< --set and the like, as typed
  std::vector<std::string> command_line;
  std::string backend;  ///< in use
  int threads = 0;
  WallTime started;
};

/// How a run ended.
struct RunEnd {
  int exit_code = 0;
  std::string outcome;  ///< in few words: finished, stopped by what, which kind of error
  std::string message;  ///< of the error, if there was one
  std::int64_t steps = 0;
  double time = 0;  ///< reached [s]
  WallTime finished;
};

/// The text of manifest.json: program, build, Kokkos, host, environment (OMP_*, KOKKOS_* ...), command line, times, and
/// the end when there is one.
std::string manifest_text(const RunOrigin& origin, const std::optional<RunEnd>& end);

/// True when the folder holds the manifest of a run of this program.
bool is_run_folder(const std::filesystem::path& folder);

/// The same facts as attributes of results.h5.
ResultsOrigin results_origin(const RunOrigin& origin, const std::string& case_text);

/// The environment variables that can change a run: OMP_*, KOKKOS_* and the like.
std::map<std::string, std::string> run_environment();

std::string host_name();
/// The command line in one line, quoted for a shell.
std::string shell_text(const std::vector<std::string>& words);

}  // namespace greenwater
