#include "bench/triad.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/fields.hpp"

namespace greenwater::bench {
namespace {

using Array = Kokkos::View<double*, Device>;

void fill(const Array& array, double value) {
  Kokkos::parallel_for(
      "greenwater::triad_fill", Range(0, static_cast<int>(array.extent(0))),
      KOKKOS_LAMBDA(const int i) { array(i) = value; });
}

void triad_pass(const Array& a, const Array& b, const Array& c, double s) {
  Kokkos::parallel_for(
      "greenwater::triad", Range(0, static_cast<int>(a.extent(0))),
      KOKKOS_LAMBDA(const int i) { a(i) = b(i) + s * c(i); });
}

double seconds_of(const Array& a, const Array& b, const Array& c, int passes) {
  Kokkos::fence();
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < passes; ++k) triad_pass(a, b, c, 3.0);
  Kokkos::fence();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::vector<double> triad(double bytes) {
  constexpr int samples = 5;
  constexpr double long_enough = 2e-3;  // s, beside which the clock and one late thread are small
  const auto length = static_cast<int>(std::clamp(bytes / 24, 64.0, 2e9));
  const auto a = uncleared<Array>("greenwater::triad_a", length);
  const auto b = uncleared<Array>("greenwater::triad_b", length);
  const auto c = uncleared<Array>("greenwater::triad_c", length);
  fill(a, 0);
  fill(b, 1);
  fill(c, 2);
  seconds_of(a, b, c, 1);
  const int passes = std::max(1, static_cast<int>(long_enough / std::max(1e-9, seconds_of(a, b, c, 1))));
  std::vector<double> rates;
  for (int k = 0; k < samples; ++k) rates.push_back(24e-9 * length * passes / seconds_of(a, b, c, passes));
  return rates;
}

// Eight to the octave.
double Triads::size_of(double bytes) { return std::exp2(std::round(std::log2(std::max(bytes, 1.0)) * 8) / 8); }

void Triads::measure(double bytes) {
  const double size = size_of(bytes);
  std::vector<double>& samples = samples_[size];
  const std::vector<double> more = triad(size);
  samples.insert(samples.end(), more.begin(), more.end());
}

Spread Triads::at(double bytes) {
  if (samples_.count(size_of(bytes)) == 0) measure(bytes);
  return spread_of(samples_.at(size_of(bytes)));
}

std::map<double, Spread> Triads::all() const {
  std::map<double, Spread> spreads;
  for (const auto& [bytes, samples] : samples_) spreads[bytes] = spread_of(samples);
  return spreads;
}

}  // namespace greenwater::bench
