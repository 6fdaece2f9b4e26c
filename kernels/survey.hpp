#pragma once
// What the default scheme wants to know of a particle's neighbourhood, found in one pass over the rows: how the fluid
// lies and moves there, and with that the row of its pressure.
//
//   S = (1 / n^0) sum w r_ij                         points into the fluid; 0 where particles lie evenly
//   M = (1 / n^0) sum w r_ij r_ij^T / r_ij^2         I / d on the lattice
//   B = (1 / n^0) sum w (u_j - u_i) r_ij^T / r_ij^2  grad u = B M^-1 (corrected gradient, Khayyer and Gotoh 2011)
//
// over neighbours and images.

#include "kernels/fluid.hpp"
#include "kernels/lattice_table.hpp"

namespace greenwater {

struct SurveyOptions {
  real drift_speed = 0;          // c_s [m/s] with which density errors are undone: rho (c_s / l0)^2 (n - n^0) / n^0
  bool shifts = true;            // whether particles are shifted at all
  real shift_rate = 0;           // part of the stiffest disorder that is undone in this step; above 2 it would grow [-]
  bool loads = false;            // keeps what wall_pushes() needs
  bool keeps_volume = true;      // in the step as a whole, not only at its start: the term with tr (grad u*)^2
  real shift_limit = real(0.1);  // longest shift, x spacing
};

/// What is known of every particle after a survey; fields like those of the particles.
struct Survey {
  bool closed = false;                // nothing holds the pressure: no particle is near a surface
  ScalarField rhs, diagonal;          // of the pressure's row (kernels/pressure_system.hpp)
  FlagField fixed;                    // 1: in free flight, without a row
  ScalarField surface;                // s: 1 at the surface, 0 inside
  VectorField correction;             // (i, place) C of the pressure's gradient, a Symmetric
  VectorField divergence_correction;  // (i, place) M^-1 as the divergence had it; empty unless loads are asked for
  VectorField surface_point;          // v: the surface's part of the gradient is -p_i v [1/m]
  VectorField velocity_gradient;      // (i, d Dim + e) du_d / dx_e [1/s]
  VectorField disorder;  // the way out of the disorder that the particle sees [m]; empty when nothing shifts
  VectorField
      shift;  // by which it is moved beside its own way [m]: the accelerate() after the survey makes it of disorder
};

/// Surveys all particles with u* in particles.velocity (without gravity) and makes the rows of the pressure:
///
///   K [sum w (p_j - p_i) - m_i p_i] = (rho / dt) [div u* - dt (1 - s) tr (grad u*)^2 / 2]
///                                     - rho (c_s / l0)^2 (n - n^0) / n^0 + K n^0 rho g . (S' - s S)
///
/// The step x += dt u changes volumes by det (I + dt grad u) = 1 + dt div u - dt^2 tr (grad u)^2 / 2 + ...: a flow that is
/// only free of divergence where particles start from thins out where it turns and crowds where it strains, at a rate of dt.
/// Gravity acts through the same sums as the pressure, not through div (dt g): so p = rho g depth solves the rows to
/// the last digit, however particles lie. S' is S with an image taken where its particle is. Near the surface (s = 1)
/// a point without pressure stands for what is missing, at the depth that n tells: m_i = n^0 |S| / depth makes a linear
/// pressure exact (after the space potential particle, Tsuruta et al. 2015); no row is cut off at p = 0.
/// particles.surface is marked where s > 1/2.
void survey(const Fluid& fluid, const LatticeTable& table, const SurveyOptions& options, real dt, Survey& found);

}  // namespace greenwater
