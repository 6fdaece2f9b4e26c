#pragma once
// How one fluid step is made: the order of the verbs. One file per scheme.

#include <memory>

#include "kernels/effects/effect.hpp"
#include "kernels/pressure_solver.hpp"

namespace greenwater {

/// What happened in a step.
struct StepReport {
  SolveReport solve;
  int stopped = 0;    // ways that crossed a wall and were stopped there
  Departed departed;  // particles that left the domain
};

class Scheme {
 public:
  virtual ~Scheme() = default;
  /// One step from t to t + dt. Rows are those of the positions of the pressure solve afterwards.
  virtual StepReport step(Fluid& fluid, Effects& effects, real dt) = 0;
};

struct ClassicOptions {
  PressureOptions pressure;
  SolverOptions solver;
  real surface_ratio = real(0.97);  // beta: n < beta n^0 is the surface
};

/// The semi-implicit MPS method as the paper uses it.
std::unique_ptr<Scheme> make_classic(const ClassicOptions& options);

/// Sorts the particles into the grid and builds their rows; returns how many left the domain. Needed once before the
/// first step, which starts from rows.
Departed settle_rows(Fluid& fluid);

}  // namespace greenwater
