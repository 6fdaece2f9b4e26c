#pragma once
// Preconditioned conjugate gradients for the pressure.

#include <string_view>

#include "kernels/preconditioner.hpp"

namespace greenwater {

struct CgOptions {
  real tolerance = real(1e-8);  // of |b - A p| / |b|
  real absolute = 0;            // of |b - A p| [Pa/m^2]; whichever is met first
  int max_iterations = 2000;
};

struct SolveReport {
  int iterations = 0;
  real residual = 0;  // |b - A p| / |b| at the end (0 for b = 0)
  bool converged = true;
  std::string_view cause = "converged";  // why it stopped, or why the first way did not work
  std::string_view recovery = {};        // what helped then; empty when nothing was needed
};

class ConjugateGradient {
 public:
  explicit ConjugateGradient(const CgOptions& options) : options_(options) {}

  /// Solves A p = b, with p as first guess; p is set to 0 where the surface is. On failure p is the last iterate and the
  /// report names the cause: a matrix or preconditioner that is not positive on a direction (a closed cluster without a
  /// surface particle), a number that is not one, too many iterations.
  SolveReport solve(const PressureSystem& system, const Preconditioner& preconditioner, const ScalarField& p);

 private:
  CgOptions options_;
  ScalarField r_, z_, d_, q_;  // residual, preconditioned residual, direction, A d
};

}  // namespace greenwater
