#pragma once
// Spreading particles evenly over the room that walls leave them, before a run begins.

#include "kernels/fluid.hpp"

namespace greenwater {

/// Moves particles down the gradient of their concentration, dx = -0.6 l0 (1 / n^0) sum_j w r_ij / |r_ij|, at most
/// 0.15 l0 and never through a wall, `sweeps` times. Rows are rebuilt each time; those of the end are left behind.
void spread_evenly(Fluid& fluid, int sweeps);

}  // namespace greenwater
