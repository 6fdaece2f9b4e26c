#include "fem/static_solution.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace greenwater {
namespace {

/// One solution by Newton's method at a share of loads and motions.
class Newton {
 public:
  Newton(const Solid& solid, const Supports& supports, const Loads& loads, const StaticOptions& options)
      : solid_(solid),
        supports_(supports),
        loads_(loads),
        options_(options),
        free_(free_unknowns(supports, solid.unknowns())),
        inner_(solid.unknowns()),
        outer_(solid.unknowns()) {
    solution_.u = Eigen::VectorXd::Zero(solid.unknowns());
    loads_.prepare(solid, options.time, options.time);
  }

  /// Whether it got there.
  bool advance_to(double share) {
    Eigen::VectorXd jump = Eigen::VectorXd::Zero(solid_.unknowns()), moved = jump;
    for (const auto& motion : supports_.motions) {
      motion.displacement(options_.time, moved);
      for (const int i : motion.unknowns) jump[i] = share * moved[i] - solution_.u[i];
    }
    for (int iteration = 0; iteration <= options_.max_iterations; ++iteration) {
      const bool jumps = iteration == 0 && !jump.isZero(0);
      update_residual(share);
      if (!std::isfinite(solution_.residual)) return fail("the forces are no longer finite: take more load steps");
      if (solution_.residual <= options_.tolerance && !jumps) return true;
      if (iteration == options_.max_iterations) break;
      const Eigen::SparseMatrix<double> tangent = solid_.tangent(solution_.u);
      if (!factorise(tangent)) return fail("the tangent is singular: hold the structure so that it cannot move freely");
      Eigen::VectorXd left = outer_ - inner_;
      if (jumps) left -= tangent * jump;
      if (jumps) solution_.u += jump;
      const Eigen::VectorXd step = factor_.solve(Eigen::VectorXd(left(free_)));
      solution_.u(free_) += step;
      ++solution_.iterations;
      // Under a small load, round-off of places leaves a force that is not small beside it.
      if (step.lpNorm<Eigen::Infinity>() <= options_.tolerance * solution_.u.lpNorm<Eigen::Infinity>()) return true;
    }
    return fail("Newton's method did not converge: take more load steps");
  }

  StaticSolution take() { return std::move(solution_); }
  void succeed() { solution_.converged = true; }

 private:
  bool factorise(const Eigen::SparseMatrix<double>& tangent) {
    factor_.compute(part_of(tangent, free_));
    if (factor_.info() != Eigen::Success) return false;
    const Eigen::VectorXd pivots = factor_.vectorD().cwiseAbs();
    return pivots.minCoeff() > 1e-14 * pivots.maxCoeff();
  }

  bool fail(const char* cause) {
    solution_.cause = cause;
    return false;
  }

  void update_residual(double share) {
    solid_.internal_force(solution_.u, inner_);
    loads_.evaluate(solid_, options_.time, solution_.u, outer_);
    outer_ *= share;
    const double scale = inner_.norm() + outer_.norm();
    solution_.residual = scale > 0 ? (outer_ - inner_)(free_).norm() / scale : 0;
  }

  const Solid& solid_;
  const Supports& supports_;
  Loads loads_;
  const StaticOptions& options_;
  std::vector<int> free_;
  Eigen::VectorXd inner_, outer_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  StaticSolution solution_;
};

}  // namespace

StaticSolution solve_static(const Solid& solid, const Supports& supports, const Loads& loads,
                            const StaticOptions& options) {
  Newton newton(solid, supports, loads, options);
  for (int step = 1; step <= options.load_steps; ++step) {
    if (!newton.advance_to(static_cast<double>(step) / options.load_steps)) return newton.take();
  }
  newton.succeed();
  return newton.take();
}

}  // namespace greenwater
