#pragma once
// What moves particles.

#include "kernels/survey.hpp"

namespace greenwater {

/// acceleration = 0
void clear_acceleration(Fluid& fluid);

/// u* = u + dt (g + acceleration), x* = x + dt u*. A particle whose way crosses a wall, which may be moving
/// too, is stopped there: it keeps its distance from the wall and takes its normal velocity. Returns how many were.
int predict(Fluid& fluid, real dt);

/// u* = u + dt acceleration, without gravity, which acts through the pressure's rows (kernels/survey.hpp).
void kick(Fluid& fluid, real dt);

/// u = u* + dt (g + acceleration), x += dt u + shift, and u is then taken from where the particle has been shifted to:
/// u += grad u shift. Walls are where they are at the start of the step and go on during it; particles are stopped at
/// them like in predict(). Returns how many were stopped.
int advance(Fluid& fluid, const Survey& survey, real dt);

/// p = max(p, 0): classic MPS knows no tension.
void clip_pressure(Fluid& fluid);

/// acceleration = -grad p / rho with the lowest pressure of the neighbourhood in place of p_i, which only pushes apart:
/// grad p_i = (d / n^0) sum_j (p_j - p_min,i) r_ij w / r_ij^2 (Koshizuka and Oka 1996). An image's pressure is that of its
/// particle and rho (g - a_w) . (x_img - x_j).
void pressure_gradient(Fluid& fluid);

/// u += dt a, x += dt^2 a, stopped at faces like predict(). Returns how many were stopped.
int correct(Fluid& fluid, real dt);

}  // namespace greenwater
