#pragma once
// Spreading particles evenly over the room that walls leave them, before a run begins.

#include "kernels/fluid.hpp"

namespace greenwater {

struct PackingOptions {
  double longest = 1;  // the longest extent of the room [x spacing]: how far particles may have to go, all in a row
  int sweeps = 1000;   // at most
};

/// How far n is from n^0.
struct Unevenness {
  double rms = 0, most = 0;  // of |n - n^0| / n^0 [-]
};
Unevenness unevenness_of(const Fluid& fluid);

/// What spreading has done.
struct Packing {
  int sweeps = 0;
  Unevenness before, after;
};

/// Moves particles against each other and their images, as springs would that lose their speed,
///     v <- m v - 0.3 l0 (1 / n^0) sum_j f_ij w r_ij / |r_ij|,   x <- x + v,   |v| <= 0.15 l0,
///     f_ij = 1 + 3 (n_i + n_j - 2 n^0) / n^0, from 0 to 2,
/// never through a wall, until the rms of n - n^0 does not fall any more; then they are where it was lowest. What m is,
/// follows from the longest wave, which is to swing once. Lattices that fill the room stay. Rows and n are left behind
/// for these places; velocities are overwritten and mean nothing afterwards.
Packing spread_evenly(Fluid& fluid, const PackingOptions& options);

/// Moves each particle by its way [m] unless a wall is in between; rows and cells are those of before.
void go_in_sight(Fluid& fluid, const VectorField& way);

}  // namespace greenwater
