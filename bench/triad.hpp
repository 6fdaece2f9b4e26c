#pragma once
// The yardstick: how fast this machine moves data, at the size of what is measured.

#include <map>

#include "bench/spread.hpp"

namespace greenwater::bench {

/// STREAM's triad a = b + s c in double, over three arrays of `bytes` together, on the threads of this run: some samples
/// [GB/s]. Counts 24 bytes per element, as STREAM does (McCalpin 1995): what a cache reads before it writes is not counted.
std::vector<double> triad(double bytes);

/// Triads of this run; sizes within a tenth of each other share one.
class Triads {
 public:
  /// Measures once more: between the rounds of what it is compared with, as the machine's speed may drift.
  void measure(double bytes);

  /// All samples of that size [GB/s]; it is measured now if it was not before.
  Spread at(double bytes);
  std::map<double, Spread> all() const;  // bytes -> [GB/s]

  /// The size that stands for this one [bytes].
  static double size_of(double bytes);

 private:
  std::map<double, std::vector<double>> samples_;
};

}  // namespace greenwater::bench
