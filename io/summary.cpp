#include "io/summary.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

namespace greenwater {
namespace {

std::string row(const std::string& name, double seconds, const RunSpeed& speed) {
  const double share = speed.loop_seconds > 0 ? 100 * seconds / speed.loop_seconds : 0;
  const double steps = static_cast<double>(std::max<std::int64_t>(1, speed.steps));
  return fmt::format("{:<20} {:>10.2f} {:>6.1f} {:>10.3f}", name, seconds, share, 1000 * seconds / steps);
}

}  // namespace

std::vector<std::string> summary_lines(const RunSpeed& speed, const std::vector<TimedSection>& sections) {
  const double steps = static_cast<double>(std::max<std::int64_t>(1, speed.steps));
  const double rate = speed.loop_seconds > 0 ? speed.work / speed.loop_seconds : 0;
  std::vector<std::string> lines{
      fmt::format("done      {} steps, {:.7g} s simulated, loop {:.2f} s", speed.steps, speed.simulated,
                  speed.loop_seconds),
      fmt::format("speed     {:.3f} ms/step, {:.3g} {}-steps/s", 1000 * speed.loop_seconds / steps, rate, speed.of),
      fmt::format("{:<20} {:>10} {:>6} {:>10}", "section", "time[s]", "%", "ms/step")};
  double named = 0;
  for (const TimedSection& section : sections) {
    lines.push_back(row(section.name, section.seconds, speed));
    named += section.seconds;
  }
  if (named < speed.loop_seconds) lines.push_back(row("other", speed.loop_seconds - named, speed));
  lines.push_back(fmt::format("memory    high water {:.3f} GB", memory_high_water() / 1e9));
  return lines;
}

double memory_high_water() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace greenwater
