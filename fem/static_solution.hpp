#pragma once
// Where a structure rests under its loads.

#include <Eigen/Dense>
#include <string>

#include "fem/loads.hpp"
#include "fem/solid.hpp"
#include "fem/supports.hpp"

namespace greenwater {

struct StaticOptions {
  int load_steps = 1;       // in which loads and motions grow; more for large rotation
  int max_iterations = 50;  // of each
  double tolerance = 1e-9;  // of the force that is left beside those there are, or of a step beside the displacement
  double time = 0;          // of loads and motions [s]
};

struct StaticSolution {
  Eigen::VectorXd u;   // [m]
  int iterations = 0;  // of all steps
  double residual = 0;
  bool converged = false;
  std::string cause;  // when not
};

/// Newton's method with the exact tangent. Loads that follow the body converge more slowly, as the tangent leaves out
/// their change.
StaticSolution solve_static(const Solid& solid, const Supports& supports, const Loads& loads,
                            const StaticOptions& options = {});

}  // namespace greenwater
