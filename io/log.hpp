#pragma once
// run.log and the terminal. Both get the header, warnings and the end; run.log gets the thermo line, the terminal one
// live line (or, where it is no terminal, a plain line every ten seconds).

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/file.hpp"
#include "io/step_facts.hpp"

namespace greenwater {

enum class Verbosity { quiet, normal, verbose };

struct LogOptions {
  Verbosity verbosity = Verbosity::normal;
  bool color = true;  ///< where the terminal can; NO_COLOR in the environment wins
};

/// How far a run is.
struct Progress {
  std::int64_t step = 0;
  double time = 0, end = 0;  ///< [s]
  double fraction = 0;       ///< 0 to 1
  double ms_per_step = 0;
  double eta = 0;  ///< wall time left [s]
};

class Log {
 public:
  explicit Log(const LogOptions& options);
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// Begins run.log, with everything said so far. Throws FileError.
  void open(const std::filesystem::path& path);

  void say(const std::string& line);   ///< to both
  void note(const std::string& line);  ///< to run.log, and to the terminal with -v
  /// A row of the thermo table; its header comes before the first and every 40 rows.
  void thermo(const std::string& header, const std::string& line);
  /// The live line; may be called every step.
  void progress(const Progress& progress);
  /// The first of each kind is printed, all are counted; run.log also gets the others where each is worth it.
  void warn(const Notice& notice, std::int64_t step);

  /// One line per kind of warning, for the end.
  std::vector<std::string> warning_counts() const;
  std::int64_t warnings() const;

 private:
  struct Counted {
    std::string kind;
    std::int64_t count, first_step;
  };
  void to_file(const std::string& line);
  void to_terminal(const std::string& line, const char* color = "");
  void clear_live_line();

  LogOptions options_;
  bool live_;               // stdout is a terminal
  bool live_line_ = false;  // a live line stands there unfinished
  std::optional<TextFile> file_;
  std::string before_open_;
  int rows_ = 0;
  std::vector<Counted> counted_;
  std::chrono::steady_clock::time_point last_progress_;
};

/// True when errors and warnings may be coloured: stderr is a terminal and nobody asked for plain text.
bool color_allowed(bool wanted, int file_descriptor);

}  // namespace greenwater
