#pragma once
// Conjugate gradients in full precision with the multigrid, which works in float: it only shows the way. The residual is
// taken anew at the end, so that the pressure is as exact as the report says.
//
// Directions in float, with a residual in double round them, would cost less each but are more: A p is a thousand times
// smaller than its terms where p is smooth, so float loses the residual after three digits and every round starts afresh.

#include "kernels/conjugate_gradient.hpp"
#include "kernels/multigrid.hpp"

namespace greenwater {

class RefinedCg {
 public:
  explicit RefinedCg(const CgOptions& options) : options_(options) {}

  /// As ConjugateGradient::solve().
  SolveReport solve(const PressureSystem& system, Multigrid& multigrid, const ScalarField& p);

 private:
  void grow(int count);

  CgOptions options_;
  ScalarField r_, d_, q_;         // residual, direction, A d
  FloatField rough_, first_, z_;  // r in float, after the first sweep, M r
};

}  // namespace greenwater
