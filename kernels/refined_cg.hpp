#pragma once
// Conjugate gradients in float with the multigrid, inside a loop that takes the residual in the full precision: an
// iteration costs half of one in double, and the pressure is as exact as the loop's residual says.

#include "kernels/conjugate_gradient.hpp"
#include "kernels/multigrid.hpp"

namespace greenwater {

class RefinedCg {
 public:
  explicit RefinedCg(const CgOptions& options) : options_(options) {}

  /// As ConjugateGradient::solve(); iterations are those in float, together.
  SolveReport solve(const PressureSystem& system, Multigrid& multigrid, const ScalarField& p);

 private:
  void grow(int count);

  CgOptions options_;
  ScalarField Ap_;
  FloatField r_, first_, z_, d_, q_,
      x_;  // residual, z after the first sweep, preconditioned residual, direction, A d, sum
};

}  // namespace greenwater
