#include "fem/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr double accuracy = 1e-8;  // of squared frequencies, from one iteration to the next
constexpr int most_iterations = 500;

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> amount(-1, 1);
  Eigen::MatrixXd x(rows, columns);
  for (double& entry : x.reshaped()) entry = amount(generator);
  return x;
}

}  // namespace

Modes lowest_modes(const Solid& solid, const Supports& supports, int count, const Eigen::VectorXd& u) {
  const std::vector<int> free = free_unknowns(supports, solid.unknowns());
  const auto size = static_cast<Eigen::Index>(free.size());
  count = std::min<int>(count, static_cast<int>(size));
  const Eigen::Index width = std::min<Eigen::Index>(size, 2 * count + 8);
  const Eigen::VectorXd mass = solid.mass()(free);
  Eigen::SparseMatrix<double> k = part_of(solid.tangent(u), free);
  // A body that is not held has modes of frequency 0, so K alone need not have an inverse.
  const double shift = 1e-9 * k.diagonal().sum() / mass.sum();
  for (Eigen::Index i = 0; i < size; ++i) k.coeffRef(i, i) += shift * mass[i];
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> inverse(k);
  require<NumericsError>(inverse.info() == Eigen::Success, "the stiffness of the structure cannot be factorised");
  Eigen::MatrixXd x = random_columns(size, width);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(width);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Eigen::MatrixXd pushed = mass.asDiagonal() * x;
    x = inverse.solve(pushed);
    const Eigen::MatrixXd kx = x.transpose() * pushed, mx = x.transpose() * mass.asDiagonal() * x;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(kx, mx);
    x = x * small.eigenvectors();
    const Eigen::VectorXd values = small.eigenvalues();
    const bool settled = ((values - before).head(count).array().abs() <= accuracy * values.head(count).array()).all();
    before = values;
    if (!settled) continue;
    Modes modes{((values.head(count).array() - shift).max(0).sqrt() / (2 * std::numbers::pi)).matrix(),
                Eigen::MatrixXd::Zero(solid.unknowns(), count)};
    modes.shapes(free, Eigen::all) = x.leftCols(count);
    return modes;
  }
  throw NumericsError(
      text_of("the natural frequencies of the structure did not converge in ", most_iterations, " iterations"));
}

Modes lowest_modes(const Solid& solid, const Supports& supports, int count) {
  return lowest_modes(solid, supports, count, Eigen::VectorXd::Zero(solid.unknowns()));
}

double share_along(const Solid& solid, const Eigen::VectorXd& shape, int axis) {
  double along = 0, all = 0;
  for (Eigen::Index i = 0; i < shape.size(); ++i) {
    const double energy = solid.mass()[i] * shape[i] * shape[i];
    all += energy;
    if (i % solid.dim() == axis) along += energy;
  }
  return along / all;
}

}  // namespace greenwater
