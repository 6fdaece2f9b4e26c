#pragma once
// How fast the fluid is: for what is written about a run, and for who chooses time steps.

#include "kernels/fluid.hpp"

namespace greenwater {

/// The highest speed of all particles [m/s]; not a number when any speed is not, 0 without particles.
real max_speed(const Fluid& fluid);

/// The speed that one particle in a thousand exceeds [m/s], so that a few drops that fly do not say how fast the fluid
/// is; in fluids of fewer particles it is close to the highest. Found on a ladder of speeds, and evenly between its
/// rungs: right to a fifth, and never above max_speed(). Not a number when any speed is not.
real bulk_speed(const Fluid& fluid);

}  // namespace greenwater
