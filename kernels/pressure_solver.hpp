#pragma once
// The one way into the solvers of the pressure: which it is, and what is tried when it fails.

#include <memory>

#include "kernels/conjugate_gradient.hpp"

namespace greenwater {

enum class Preconditioning { multigrid, jacobi, none };

struct SolverOptions {
  Preconditioning preconditioning = Preconditioning::multigrid;
  CgOptions cg;                        // how exact, and how long
  int most_multigrid_iterations = 40;  // more than a system needs that is not nearly singular
  real raise = real(1e-3);             // part by which the diagonal is made larger when the multigrid fails
};

class PressureSolver {
 public:
  virtual ~PressureSolver() = default;
  /// Solves A p = b, with p as first guess; p is set to 0 where the surface is and is always finite.
  virtual SolveReport solve(PressureSystem& system, const ScalarField& p) = 0;
  /// The same system as in the last solve() with another right side: what was made of the matrix is used once more.
  virtual SolveReport solve_again(PressureSystem& system, const ScalarField& p) = 0;
};

/// With multigrid: conjugate gradients with it, for rows that are not symmetric stabilised biconjugate ones. When that fails (a closed cluster
/// without a surface particle, say), the system's diagonal is made larger, which stays so, and it is tried again from
/// zero, and then conjugate gradients with the diagonal. The report tells why the first way failed, as its cause, and what
/// helped; its residual is that of the system that was solved last. When nothing helps, p is the last iterate or zero.
/// With jacobi or none: conjugate gradients as they are; nothing of the multigrid is made.
std::unique_ptr<PressureSolver> make_pressure_solver(const SolverOptions& options);

}  // namespace greenwater
