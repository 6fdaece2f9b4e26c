#pragma once
// From a number to a whole one that may become an index.

namespace greenwater {

/// x without its fraction, kept between low and high, and low when x is not a number. A plain cast of what is none, or of
/// what does not fit, is undefined: it makes an index anywhere.
template <class Whole>
constexpr Whole whole_within(double x, Whole low, Whole high) {
  return x >= static_cast<double>(high) ? high : x > static_cast<double>(low) ? static_cast<Whole>(x) : low;
}

}  // namespace greenwater
