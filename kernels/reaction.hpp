#pragma once
// The force of the fluid on a wall that does the same work on the wall as the wall does on the fluid.

#include <array>

#include "kernels/survey.hpp"

namespace greenwater {

/// Force on a body [N/m] in 2-D, [N] in 3-D: F = D^T (V p), where V = l0^d and D is how the wall's normal velocity
/// enters the divergence of the survey, by way of images: F . v = sum V p (D v) to round-off, and a constant pressure on
/// a flat wall gives p times its area. Positions and rows must be those of the survey, which must have kept its
/// divergence_correction.
std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body);

}  // namespace greenwater
