#pragma once
// Ctrl-C and its relatives: the first one asks for a clean end after the step, the second one kills.

namespace greenwater {

/// Listens to SIGINT, SIGTERM and SIGHUP while it lives; one at a time. A closed pipe (SIGPIPE) or a file too large
/// (SIGXFSZ) no longer ends the run by itself.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  /// The signal that came, or 0.
  int received() const;
};

}  // namespace greenwater
