#pragma once
// What a step has done to the particles, beside a copy of them from before it.

#include "kernels/fluid.hpp"

namespace greenwater {

/// The particles at the start of a step. A sort changes their places since then, but not their ids.
struct Before {
  Particles particles;
  IndexField place;  // of the particle with that id; of those that are not there any more, nothing
};

/// Makes `before` a copy; memory is kept and only grown.
void keep(const Particles& particles, Before& before);

/// All fields are again what they were, in the same order. They are the same fields: none may have been added since.
void put_back(const Before& before, Particles& particles);

/// The longest way that any particle has gone [m], but drops that fly by themselves: those with no more neighbours than
/// the space has dimensions, as in wave_front(). Not a number when a position or a velocity, also a drop's, is not.
real longest_way(const Fluid& fluid, const Before& before);

/// Pairs that are nearer than `distance` [m] now and have come to less than half of the distance that they had. Nobody
/// counts who was as near all along, or comes near slowly: then no shorter step would mend it.
int pairs_run_together(const Fluid& fluid, const Before& before, real distance);

}  // namespace greenwater
