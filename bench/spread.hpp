#pragma once
// Many measurements of one thing, in a few numbers.

#include <vector>

namespace greenwater::bench {

struct Spread {
  double median = 0, low = 0, high = 0;  // of all
  double q1 = 0, q3 = 0;                 // a quarter is below, a quarter above
};

/// Quantiles with straight lines between the values; all zero when there is none.
Spread spread_of(std::vector<double> values);

}  // namespace greenwater::bench
