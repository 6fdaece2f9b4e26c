#pragma once
// Sums and products of points and vectors on the host.

#include <array>
#include <cmath>

#include "core/real.hpp"

namespace greenwater {

using Triple = std::array<coord, 3>;  // a point or a vector

inline Triple sum(const Triple& a, const Triple& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Triple difference(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Triple scaled(const Triple& a, coord by) { return {a[0] * by, a[1] * by, a[2] * by}; }
inline coord dot(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Triple cross(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline coord length(const Triple& a) { return std::sqrt(dot(a, a)); }
inline coord distance(const Triple& a, const Triple& b) { return length(difference(a, b)); }

}  // namespace greenwater
