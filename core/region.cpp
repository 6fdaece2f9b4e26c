#include "core/region.hpp"

#include <algorithm>
#include <chrono>

#include "core/kokkos.hpp"

namespace greenwater {
namespace {

std::vector<RegionTime>& rows() {
  static std::vector<RegionTime> table;
  return table;
}

double seconds_now() {
  Kokkos::fence();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::size_t row_of(std::string_view name) {
  auto& table = rows();
  const auto found = std::find_if(table.begin(), table.end(), [&](const RegionTime& row) { return row.name == name; });
  if (found != table.end()) return static_cast<std::size_t>(found - table.begin());
  table.push_back({std::string(name), 0, 0});
  return table.size() - 1;
}

}  // namespace

Region::Region(std::string_view name) : row_(row_of(name)), start_(seconds_now()) {
  Kokkos::Profiling::pushRegion("greenwater::" + std::string(name));
}

Region::~Region() {
  Kokkos::Profiling::popRegion();
  rows()[row_].seconds += seconds_now() - start_;
  ++rows()[row_].calls;
}

std::vector<RegionTime> region_times() { return rows(); }

void reset_region_times() { rows().clear(); }

}  // namespace greenwater
