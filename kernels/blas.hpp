#pragma once
// The vector operations of the solvers, in one room: Kokkos Kernels where the build found it, own loops otherwise. A sum
// over all particles is a sum over all ranks one day: global reductions of the solver go through here too.

#include "core/fields.hpp"

namespace greenwater::blas {

/// x . y over the first `count` entries.
accum dot(const ScalarField& x, const ScalarField& y, int count);

/// y = a x + b y over the first `count` entries.
void axpby(real a, const ScalarField& x, real b, const ScalarField& y, int count);

}  // namespace greenwater::blas
