#pragma once
// What the regular lattice tells the survey: how a flat surface looks from under it, and how much shifting disorder bears.

#include "core/lanes.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// What the lattice tells; found once.
struct LatticeTable {
  real missing[3];  // 1 - n / n^0 of the first three rows under a flat surface, l0/2, 3 l0/2 and 5 l0/2 deep
  real tilt[3];     // |S| n^0 / (n l0) of the same rows
  real none, full;  // |S| n^0 / (n l0) at which a particle begins to be at the surface, and is
  real bulge;       // b: |S| / (depth) = m (1 + b m) in the first row
  real shift;       // way per gradient of the shift function that undoes the stiffest disorder [m^2]
  int few;          // neighbours of a particle of spray
};

/// 3 t^2 - 2 t^3 between two values, 0 below and 1 above.
template <class V>
KOKKOS_INLINE_FUNCTION V smooth_step(const V& x, real from, real to) {
  const V t = smaller(larger((x - from) * (1 / (to - from)), V{}), all_lanes<V>(real(1)));
  return t * t * (3 - 2 * t);
}

/// s of a particle: 1 at the surface, 0 inside; from its tilt, and how many neighbours and images it sees.
template <class V>
KOKKOS_INLINE_FUNCTION V surface_share(const LatticeTable& table, const V& tilt, const V& seen) {
  return select(seen < static_cast<real>(table.few), all_lanes<V>(real(1)), smooth_step(tilt, table.none, table.full));
}

/// How many neighbours and images the particles of a pack see.
KOKKOS_INLINE_FUNCTION Pack seen_by(const Read<IndexField>& neighbours, const Read<IndexField>& images, int i) {
  Pack seen = convert_lanes<Pack>(load_pack(neighbours, i));
  if (images.extent(0) > 0) seen += convert_lanes<Pack>(load_pack(images, i));
  return seen;
}

/// For radii above 2 l0, so that there is a second row.
LatticeTable make_lattice_table(const Weight& weight, int dim, coord spacing);

/// The function that shifts: W = (1 - q)^4 (1 + 4 q), q = r / r_e, and W'/r times -1, with more of it for those that are
/// close, so that they do not pair: factor 1 + 0.2 (W / W(l0))^4.
struct ShiftFunction {
  real per_radius, per_spacing;  // 1 / r_e, 1 / W(l0)

  KOKKOS_INLINE_FUNCTION static real value(real q) {
    return q < 1 ? (1 - q) * (1 - q) * (1 - q) * (1 - q) * (1 + 4 * q) : 0;
  }

  template <class V>
  KOKKOS_INLINE_FUNCTION V slope(const V& r) const {
    const V q = r * per_radius, t = larger(1 - q, V{}), t3 = t * t * t;
    V close = t * t3 * (1 + 4 * q) * per_spacing;
    close *= close;
    close *= close;
    return 20 * t3 * per_radius * per_radius * (1 + real(0.2) * close);
  }
};

ShiftFunction shift_function(const Weight& w, real l0);

}  // namespace greenwater
