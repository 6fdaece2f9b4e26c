#pragma once
// The end of a run in numbers: where the time went, how fast it was, how much memory it took.

#include <cstdint>
#include <string>
#include <vector>

namespace greenwater {

struct TimedSection {
  std::string name;
  double seconds = 0;
};

struct RunSpeed {
  std::int64_t steps = 0;
  double simulated = 0;     ///< [s]
  double loop_seconds = 0;  ///< wall time of all steps and their output
  double work = 0;          ///< particles, or elements times substeps, summed over the steps
  const char* of = "particle";
};

/// `done`, `speed`, the time table (name, seconds, share of the loop, ms per step) and the memory line.
std::vector<std::string> summary_lines(const RunSpeed& speed, const std::vector<TimedSection>& sections);

/// The most memory that the program had so far [bytes].
double memory_high_water();

}  // namespace greenwater
