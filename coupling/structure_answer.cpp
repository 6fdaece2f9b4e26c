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

double largest_change(const std::vector<Eigen::MatrixXd>& from, const std::vector<Eigen::MatrixXd>& to) {
  double most = 0;
  for (std::size_t c = 0; c < from.size(); ++c) most = std::max(most, (from[c] - to[c]).cwiseAbs().maxCoeff());
  return most;
}

}  // namespace

StructureAnswer::Answer StructureAnswer::turned(Answer answer, const Turns& turns) {
  for (std::size_t c = 0; c < turns.size(); ++c) {
    const Eigen::Index size = turns[c].rows(), from = size * c;
    answer.matrix.middleRows(from, size) = (turns[c] * answer.matrix.middleRows(from, size)).eval();
    answer.matrix.middleCols(from, size) = (answer.matrix.middleCols(from, size) * turns[c].transpose()).eval();
    answer.leading.middleCols(from, size) = (answer.leading.middleCols(from, size) * turns[c].transpose()).eval();
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
  if (body.solid->linear()) {
    if (anew) now_ = at_rest_;
    return anew;
  }
  Turns turns = body.surface.turn_of_corners(displaced);
  if (!anew && largest_change(turns, turns_) < far) return false;
  turns_ = std::move(turns);
  now_ = turned(at_rest_, turns_);
  return true;
}

}  // namespace greenwater
