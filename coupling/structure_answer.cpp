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

double largest(const Eigen::SparseMatrix<double>& m) {
  return m.nonZeros() == 0 ? 0 : m.coeffs().cwiseAbs().maxCoeff();
}

std::vector<Eigen::Index> columns_with_entries(const Eigen::SparseMatrix<double>& m) {
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < m.outerSize(); ++k)
    if (m.col(k).nonZeros() > 0) columns.push_back(k);
  return columns;
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
    changed_ |= anew;
    return anew;
  }
  Turns turns = body.surface.turn_of_corners(displaced);
  if (!anew && largest_change(turns, turns_) < far) return false;
  turns_ = std::move(turns);
  now_ = turned(at_rest_, turns_);
  changed_ = true;
  return true;
}

bool StructureAnswer::take_layer(const Eigen::SparseMatrix<double>& L) {
  constexpr double little = 0.02;  // of its largest entry
  if (!changed_ && largest(L - layer_) <= little * largest(layer_)) return false;
  changed_ = false;
  layer_ = L;
  wet_ = columns_with_entries(L);
  const Eigen::MatrixXd among_wet = Eigen::MatrixXd(L)(wet_, wet_);
  C_of_wet_ = now_.matrix(Eigen::all, wet_);
  const Eigen::MatrixXd C_among_wet = C_of_wet_(wet_, Eigen::all);
  resistance_ =
      (Eigen::MatrixXd::Identity(among_wet.rows(), among_wet.cols()) + among_wet * C_among_wet).lu().solve(among_wet);
  with_layer_.matrix = now_.matrix;
  with_layer_.matrix.noalias() -= (C_of_wet_ * resistance_) * C_of_wet_.transpose();
  // Of what leads in C alone, l^T l, by the same formula.
  const Eigen::MatrixXd& l = now_.leading;
  const Eigen::MatrixXd resisted = Eigen::MatrixXd::Identity(l.rows(), l.rows()) + l * L * l.transpose();
  with_layer_.leading = resisted.llt().matrixL().solve(l);
  return true;
}

Eigen::VectorXd StructureAnswer::with_layer(const Eigen::VectorXd& v) const {
  return v - C_of_wet_ * (resistance_ * v(wet_));
}

}  // namespace greenwater
