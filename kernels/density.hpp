#pragma once
// What follows from the particle number density n_i = sum over neighbours and images of w(r_ij) (paper, Eq. 3 for w). n
// itself is summed where the rows are built.

#include "kernels/fluid.hpp"

namespace greenwater {

/// Marks the free surface, n < ratio n^0, into particles.surface. A particle with so few neighbours that no pressure can
/// be formed (fewer than dim + 1) is free too: it flies.
void mark_surface(Fluid& fluid, real ratio);

/// Largest (n - n^0) / n^0 over the particles; 0 without particles.
real largest_compression(const Fluid& fluid);

}  // namespace greenwater
