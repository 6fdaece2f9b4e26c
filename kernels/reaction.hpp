#pragma once
// The force of the fluid on a wall that does the same work on the wall as the wall does on the fluid: F = D^T (V p), where
// V = l0^d and D is how the wall's normal velocity enters the divergence of the survey, by way of images. So
// F . v = sum V p (D v) to round-off, and a constant pressure on a flat wall gives p times its area. Positions and rows
// must be those of the survey, which must have kept its divergence_correction.

#include <array>
#include <vector>

#include "kernels/survey.hpp"

namespace greenwater {

/// Force on a body [N/m] in 2-D, [N] in 3-D.
std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body);

/// One entry of D^T V: the pressure of a particle pushes the wall at a place.
struct WallPush {
  int particle = 0;
  int face = 0;                   // of the body that it pushes: in its plane, or in that of those that move alike
  std::array<double, 3> place{};  // of the wall's plane, where the path to the image is thrown back [m]
  std::array<double, 3> push{};   // force per pressure [m], in 3-D [m^2]; along the wall's normal
};

/// All of them for a body, with particles as they are sorted now, in their order. A wall that moves with v at that place
/// changes the divergence of the particle by push . v / V.
std::vector<WallPush> wall_pushes(const Fluid& fluid, const Survey& survey, int body);

}  // namespace greenwater
