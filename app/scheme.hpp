#pragma once
// How one fluid step is made: the order of the verbs. One file per scheme.

#include <array>
#include <memory>
#include <vector>

#include "coupling/coupler.hpp"
#include "kernels/acceleration.hpp"
#include "kernels/effects/effect.hpp"
#include "kernels/pressure_solver.hpp"

namespace greenwater {

/// What happened in a step.
struct StepReport {
  SolveReport solve;
  int stopped = 0;                               // ways that crossed a wall and were stopped there
  Departed departed;                             // particles that left the domain
  real nearest = 0;                              // how near two particles came to each other [m]; 0: nobody has looked
  std::vector<std::array<double, 3>> reactions;  // on the bodies that are watched, in their order [N/m], 3-D: [N]
};

class Scheme {
 public:
  virtual ~Scheme() = default;
  /// One step from t to t + dt. Rows are those of the positions of the pressure solve afterwards.
  virtual StepReport step(Fluid& fluid, Effects& effects, Coupler& coupler, real dt) = 0;
  /// Without structures.
  StepReport step(Fluid& fluid, Effects& effects, real dt) {
    Coupler none;
    return step(fluid, effects, none, dt);
  }

  /// Asks for the reaction of a body (kernels/operators/rigid_walls.hpp) in every report from now on; returns its place there, or -1
  /// from a scheme that knows none.
  virtual int watch(int /*body*/) { return -1; }
};

struct ClassicOptions {
  PressureOptions pressure;
  SolverOptions solver;
  real surface_ratio = real(0.97);  // beta: n < beta n^0 is the surface
};

/// The semi-implicit MPS method as the paper uses it.
std::unique_ptr<Scheme> make_classic(const ClassicOptions& options);

struct DefaultOptions {
  bool fits = false;  // derivatives by least squares, where they can be trusted: the scheme "high"
  SolverOptions solver;
  real reference_speed = 0;  // U of the flow [m/s]: that of its energy, not of a splash; 0: its bulk's in each step
  real drift = real(0.3);    // speed with which density errors are undone, x U
  real shifting = 7;         // part of disorder that is undone while the fluid goes l0 ...
  real most_shifting = real(1.5);  // ... and in one step at most
  SmoothingOptions smoothing;      // its speed is set to U
  real diagonal_factor = 1;        // C, on the diagonal of the pressure's rows: above 1 the fluid gives way to pressure
  real separation = real(0.6);     // particles closer than this, x spacing, and approaching are held apart; 0: not
};

/// The scheme for all that is not the paper's: calm at rest, with tension, and without a row cut off at the surface. With fits
/// it is the scheme "high".
std::unique_ptr<Scheme> make_default(const DefaultOptions& options);

/// Sorts the particles into the grid and builds their rows; returns how many left the domain. Needed once before the
/// first step, which starts from rows.
Departed settle_rows(Fluid& fluid);

}  // namespace greenwater
