#pragma once
// A named stretch of the run: one RAII line gives a region in the profiler and a row in the time table.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace greenwater {

struct RegionTime {
  std::string name;
  double seconds = 0;  // host time between entry and exit, inner regions included
  std::int64_t calls = 0;
};

/// Opens a region; the destructor closes it. The host waits for the device at both ends, so that the time is that of
/// the work and not of its launch (on host back-ends this costs nothing).
class Region {
 public:
  explicit Region(std::string_view name);
  ~Region();
  Region(const Region&) = delete;
  Region& operator=(const Region&) = delete;

 private:
  std::size_t row_;
  double start_;
};

/// The table so far, in order of first entry.
std::vector<RegionTime> region_times();

/// Forgets all rows; no region may be open.
void reset_region_times();

}  // namespace greenwater
