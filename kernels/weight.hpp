#pragma once
// The weight function and what it sums to on the regular lattice.

#include "core/lanes.hpp"

namespace greenwater {

/// w(r) = r_e / (r + s r_e) - 1 / (1 + s) for r < r_e, else 0. The paper's Eq. 3 has s = 0.05, which keeps w finite for
/// touching particles; s = 0 is the usual r_e / r - 1 (Koshizuka and Oka 1996).
struct Weight {
  real radius = 0;  // r_e [m]
  real shift = 0;   // s [-]

  /// w(sqrt(r2)) of a pack to seven digits, at less than half the cost.
  template <class T>
  KOKKOS_INLINE_FUNCTION T in_float(const T& r2) const {
    using F = Lanes<float, pack_lanes>;
    const float re = static_cast<float>(radius), s = static_cast<float>(shift);
    const F r = sqrt(convert_lanes<F>(r2));
    return convert_lanes<T>(zero_unless(r < re, re / (r + s * re) - 1 / (1 + s)));
  }

  bool operator==(const Weight&) const = default;

  /// Of one distance, or of a pack of them.
  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const T& r) const {
    return zero_unless(r < radius, radius * inverse(r + shift * radius) - 1 / (1 + shift));
  }
};

/// A pair that is nearer than this counts in difference quotients as if it were so far apart [x spacing]: what one pair says
/// of a gradient, f_ij r_ij / r_ij^2, stays bounded, also for a particle that lies on a wall and its image. The matrix that
/// corrects the gradient has it too, so linear fields stay exact.
constexpr real nearest_quotient = real(0.2);

/// Sums over the regular lattice.
struct Reference {
  real n0 = 0;      // n^0       sum of w [-]
  real lambda = 0;  // lambda^0  sum of w r^2 / sum of w [m^2]
};

/// Lattice sums around a particle of a square (cubic) lattice with the given spacing [m].
Reference lattice_reference(const Weight& weight, int dim, coord spacing);

}  // namespace greenwater
