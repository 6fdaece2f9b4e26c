#include "kernels/pressure_solver.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/biconjugate_gradient.hpp"
#include "kernels/blas.hpp"
#include "kernels/multigrid.hpp"
#include "kernels/preconditioner_with_term.hpp"
#include "kernels/pressure_vectors.hpp"

namespace greenwater {
namespace {

void clear_unless_finite(const ScalarField& p, int count) {
  if (!std::isfinite(blas::dot(p, p, count))) clear_pressure(p, count);
}

class Plain : public PressureSolver {
 public:
  Plain(std::unique_ptr<Preconditioner> preconditioner, const CgOptions& options)
      : preconditioner_(std::move(preconditioner)), cg_(options), bicg_(options) {}

  SolveReport solve(PressureSystem& system, const ScalarField& p) override {
    preconditioner_->update(system);
    return solve_again(system, p);
  }

  SolveReport solve_again(PressureSystem& system, const ScalarField& p) override {
    clear_unless_finite(p, system.count());
    const SolveReport report =
        system.symmetric() ? cg_.solve(system, *preconditioner_, p) : bicg_.solve(system, *preconditioner_, p);
    if (!report.converged) clear_unless_finite(p, system.count());
    if (system.closed()) system.remove_mean(p);
    return report;
  }

 private:
  std::unique_ptr<Preconditioner> preconditioner_;
  ConjugateGradient cg_;
  BiconjugateGradient bicg_;  // where the system is not symmetric; else it holds nothing
};

CgOptions shortened(CgOptions options, int most) {
  options.max_iterations = std::min(options.max_iterations, most);
  return options;
}

class WithMultigrid : public PressureSolver {
 public:
  explicit WithMultigrid(const SolverOptions& options)
      : first_way_(make_preconditioner_with_term(std::make_unique<Multigrid>()),
                   shortened(options.cg, options.most_multigrid_iterations)),
        last_resort_(make_jacobi(), options.cg),
        raise_(options.raise) {}

  SolveReport solve(PressureSystem& system, const ScalarField& p) override {
    return or_recovered(first_way_.solve(system, p), system, p);
  }

  SolveReport solve_again(PressureSystem& system, const ScalarField& p) override {
    return or_recovered(first_way_.solve_again(system, p), system, p);
  }

 private:
  SolveReport or_recovered(const SolveReport& first, PressureSystem& system, const ScalarField& p) {
    if (first.converged || !std::isfinite(first.residual)) return first;

    system.raise_diagonal(raise_);
    clear_pressure(p, system.count());
    SolveReport report = first_way_.solve(system, p);
    report.recovery = "a larger diagonal";
    if (!report.converged) {
      clear_pressure(p, system.count());
      const int before = report.iterations;
      report = last_resort_.solve(system, p);
      report.iterations += before;
      report.recovery = "a larger diagonal and Jacobi's preconditioner";
    }
    report.iterations += first.iterations;
    report.cause = first.cause;
    return report;
  }

  Plain first_way_, last_resort_;
  real raise_;
};

}  // namespace

std::unique_ptr<PressureSolver> make_pressure_solver(const SolverOptions& options) {
  switch (options.preconditioning) {
    case Preconditioning::jacobi: return std::make_unique<Plain>(make_jacobi(), options.cg);
    case Preconditioning::none: return std::make_unique<Plain>(make_identity(), options.cg);
    case Preconditioning::multigrid: break;
  }
  return std::make_unique<WithMultigrid>(options);
}

}  // namespace greenwater
