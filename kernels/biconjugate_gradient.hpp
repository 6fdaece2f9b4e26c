#pragma once
// Stabilised biconjugate gradients (BiCGSTAB, van der Vorst 1992) for pressure systems that are not symmetric.

#include "kernels/conjugate_gradient.hpp"

namespace greenwater {

class BiconjugateGradient {
 public:
  explicit BiconjugateGradient(const CgOptions& options) : options_(options) {}

  /// As ConjugateGradient::solve(), for any matrix. An iteration takes two products with it and with the preconditioner,
  /// about as much as two of conjugate gradients.
  SolveReport solve(const PressureSystem& system, const Preconditioner& preconditioner, const ScalarField& p);

 private:
  CgOptions options_;
  ScalarField r_, shadow_, d_, v_, t_, z_;  // residual, that of the start, direction, A M d, A M r, M d or M r
};

}  // namespace greenwater
