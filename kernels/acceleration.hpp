#pragma once
// What the pressure does to the fluid in the default scheme, and the smoothing of what it leaves behind.

#include "kernels/survey.hpp"

namespace greenwater {

/// Smoothing of velocities, as rates: that part of a difference between neighbours that goes per second is the
/// coefficient times speed / l0.
struct SmoothingOptions {
  real speed = 0;               // of the flow [m/s]; 0 smooths nothing
  real inside = real(0.4);      // coefficient [-]
  real at_surface = real(0.6);  // added to it at the surface, where the geometry of the few makes noise [-]
  real most = real(0.2);        // of a difference, in one step [-]
};

/// acceleration = -grad p / rho + smoothing.
///
///   grad p_i = C [(1 / n^0) sum (p_j - p_i) r_ij w / r_ij^2 - p_i v]
///
/// with C and the surface's v from the survey; an image's pressure is that of its particle and
/// rho (g - a_w) . (x_img - x_j). Exact for a linear pressure, however particles lie.
///
///   smoothing_i = rate (1 / n^0) sum w [u_j - u_i - (grad u_i + grad u_j) r_ij / 2]
///
/// over neighbours, not images. What is in brackets is 0 in every quadratic flow, also at the surface: it is particles'
/// disorder. Each pair keeps its momentum.
///
/// The same pass makes survey.shift, where there is one: disorder_i - (1 / n^0) sum w disorder_j, over neighbours. Only
/// what is short is shifted: long waves in the lattice are the flow's, and to undo them would feed waves.
void accelerate(Fluid& fluid, Survey& survey, const SmoothingOptions& smoothing, real dt);

}  // namespace greenwater
