#include "bench/spread.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/kokkos.hpp"

namespace greenwater::bench {
namespace {

double quantile(const std::vector<double>& sorted, double part) {
  const double at = part * static_cast<double>(sorted.size() - 1);
  const auto k = static_cast<std::size_t>(at);
  const double beyond = at - std::floor(at);
  return k + 1 < sorted.size() ? sorted[k] + beyond * (sorted[k + 1] - sorted[k]) : sorted[k];
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), values.front(), values.back(), quantile(values, 0.25), quantile(values, 0.75)};
}

double ms_of(const std::function<void()>& work) {
  Kokkos::fence();
  const auto start = std::chrono::steady_clock::now();
  work();
  Kokkos::fence();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace greenwater::bench
