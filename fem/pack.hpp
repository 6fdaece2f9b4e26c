#pragma once
// What the formulas of an element are written in. They are templates of the number T, so that the same text works on one
// element (double), on several side by side in the lanes of a vector register (Pack), and on one with its derivatives
// along several directions (Slope), which gives tangents that are exact without a line of algebra.

#include <cmath>

namespace greenwater::element {

/// As many numbers as a register has.
#if defined(__AVX512F__)
constexpr int lanes = 8;
#elif defined(__AVX__)
constexpr int lanes = 4;
#else
constexpr int lanes = 2;
#endif
typedef double Pack __attribute__((vector_size(lanes * sizeof(double))));

/// A value and its derivatives along as many directions as there are lanes.
struct Slope {
  double value = 0;
  Pack slope{};
  Slope& operator+=(const Slope& b) { return value += b.value, slope += b.slope, *this; }
  Slope& operator-=(const Slope& b) { return value -= b.value, slope -= b.slope, *this; }
  Slope& operator+=(double b) { return value += b, *this; }
};

inline Slope operator-(const Slope& a) { return {-a.value, -a.slope}; }
inline Slope operator+(const Slope& a, const Slope& b) { return {a.value + b.value, a.slope + b.slope}; }
inline Slope operator-(const Slope& a, const Slope& b) { return {a.value - b.value, a.slope - b.slope}; }
inline Slope operator*(const Slope& a, const Slope& b) {
  return {a.value * b.value, a.slope * b.value + a.value * b.slope};
}
inline Slope operator/(const Slope& a, const Slope& b) {
  return {a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value};
}
inline Slope operator+(const Slope& a, double b) { return {a.value + b, a.slope}; }
inline Slope operator-(const Slope& a, double b) { return {a.value - b, a.slope}; }
inline Slope operator*(double a, const Slope& b) { return {a * b.value, a * b.slope}; }
inline Slope operator/(double a, const Slope& b) { return {a / b.value, -a / (b.value * b.value) * b.slope}; }

/// Natural logarithm.
inline double log_of(double a) { return std::log(a); }
inline Slope log_of(const Slope& a) { return {std::log(a.value), a.slope / a.value}; }
inline Pack log_of(const Pack& a) {
  Pack b{};
  for (int l = 0; l < lanes; ++l) b[l] = std::log(a[l]);
  return b;
}

/// a^p.
inline double power_of(double a, double p) { return std::pow(a, p); }
inline Slope power_of(const Slope& a, double p) {
  const double power = std::pow(a.value, p);
  return {power, p * power / a.value * a.slope};
}
inline Pack power_of(const Pack& a, double p) {
  Pack b{};
  for (int l = 0; l < lanes; ++l) b[l] = std::pow(a[l], p);
  return b;
}

/// The largest magnitude of all lanes; what is not a number counts as nothing.
inline double largest(double a) { return std::abs(a); }
inline double largest(const Slope& a) { return std::abs(a.value); }
inline double largest(const Pack& a) {
  double most = 0;
  for (int l = 0; l < lanes; ++l) most = std::abs(a[l]) > most ? std::abs(a[l]) : most;
  return most;
}

}  // namespace greenwater::element
