#pragma once
// Measuring time, and many measurements of one thing in a few numbers.

#include <functional>
#include <vector>

namespace greenwater::bench {

struct Spread {
  double median = 0, low = 0, high = 0;  // of all
  double q1 = 0, q3 = 0;                 // a quarter is below, a quarter above
};

/// Quantiles with straight lines between the values; all zero when there is none.
Spread spread_of(std::vector<double> values);

/// Wall time of some work, its kernels included [ms].
double ms_of(const std::function<void()>& work);

}  // namespace greenwater::bench
