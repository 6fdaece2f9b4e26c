#pragma once
// The yardstick: how fast this machine moves data, at the size of what is measured.

#include <map>

#include "bench/spread.hpp"

namespace greenwater::bench {

/// STREAM's triad a = b + s c in double, over three arrays of `bytes` together, on the threads of this run [GB/s]. Counts
/// 24 bytes per element, as STREAM does (McCalpin 1995): what a cache reads before it writes is not counted.
Spread triad(double bytes);

/// Triads of this run, each size measured once; sizes within a tenth of each other share one.
class Triads {
 public:
  const Spread& at(double bytes);
  const std::map<double, Spread>& all() const { return measured_; }  // bytes -> [GB/s]

 private:
  std::map<double, Spread> measured_;
};

}  // namespace greenwater::bench
