#include "coupling/structure_answer.hpp"

#include <algorithm>
#include <cmath>

#include "fem/held_load_answer.hpp"

namespace greenwater {
namespace {

Eigen::MatrixXd leading_of(const Eigen::MatrixXd& C) {
  constexpr Eigen::Index most = 3;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(C);  // smallest first
  const Eigen::Index size = C.rows(), count = std::min(most, size);
  Eigen::MatrixXd leading(count, size);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index from = size - 1 - k;
    leading.row(k) = std::sqrt(std::max(0.0, solved.eigenvalues()[from])) * solved.eigenvectors().col(from).transpose();
  }
  return leading;
}

}  // namespace

StructureAnswer::Answer StructureAnswer::turned(Answer answer, const Eigen::VectorXd& turn) {
  for (Eigen::Index c = 0; c < turn.size(); ++c) {
    const Eigen::Matrix2d by = Eigen::Rotation2Dd(turn[c]).toRotationMatrix();
    answer.matrix.middleRows<2>(2 * c) = (by * answer.matrix.middleRows<2>(2 * c)).eval();
    answer.matrix.middleCols<2>(2 * c) = (answer.matrix.middleCols<2>(2 * c) * by.transpose()).eval();
    answer.leading.middleCols<2>(2 * c) = (answer.leading.middleCols<2>(2 * c) * by.transpose()).eval();
  }
  return answer;
}

bool StructureAnswer::renew(const ElasticBody& body, const Eigen::VectorXd& displaced, double dt) {
  constexpr double much = 1.25, far = 2e-3;  // of steps; [rad]
  const bool anew = dt_ == 0 || dt > much * dt_ || dt_ > much * dt;
  if (anew) {
    dt_ = dt;
    const Eigen::SparseMatrix<double> patterns = body.surface.mean().transpose();
    at_rest_.matrix = body.surface.depth() / dt *
                      held_load_answer(*body.solid, *body.supports, patterns, body.options, substeps(body, dt));
    at_rest_.leading = leading_of(at_rest_.matrix);
  }
  const bool turns = body.surface.fluid_dim() == 2 && !body.solid->linear();
  if (!turns) {
    if (anew) now_ = at_rest_;
    return anew;
  }
  const Eigen::VectorXd turn = body.surface.turn_of_corners(displaced);
  if (!anew && (turn - turn_).lpNorm<Eigen::Infinity>() < far) return false;
  turn_ = turn;
  now_ = turned(at_rest_, turn);
  return true;
}

}  // namespace greenwater
