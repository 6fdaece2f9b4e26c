#include "fem/modes.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr double accuracy = 1e-7;  // of shapes; that of squared frequencies is its square
constexpr int most_blocks = 200;

/// M^1/2 (K + shift M)^-1 M^1/2
class Operator {
 public:
  Operator(const Solid& solid, const std::vector<int>& free, const Eigen::VectorXd& u)
      : root_(solid.mass()(free).cwiseSqrt()) {
    // A body that is not held has modes of frequency 0, so K alone need not have an inverse.
    Eigen::SparseMatrix<double> k = part_of(solid.tangent(u), free);
    shift_ = 1e-9 * k.diagonal().sum() / root_.squaredNorm();
    require<NumericsError>(std::isfinite(shift_),
                           "the stiffness of the structure over its mass is not a finite number: ",
                           "take values of a real material, and look at the unit of its sizes");
    for (Eigen::Index i = 0; i < k.cols(); ++i) k.coeffRef(i, i) += shift_ * root_[i] * root_[i];
    factor_.compute(k);
    require<NumericsError>(factor_.info() == Eigen::Success, "the stiffness of the structure cannot be factorised");
  }

  Eigen::MatrixXd operator()(const Eigen::MatrixXd& x) const {
    const Eigen::MatrixXd pushed = root_.asDiagonal() * x;
    return root_.asDiagonal() * Eigen::MatrixXd(factor_.solve(pushed));
  }

  double shift() const { return shift_; }
  const Eigen::VectorXd& root_of_mass() const { return root_; }

 private:
  Eigen::VectorXd root_;
  double shift_ = 0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index columns) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> amount(-1, 1);
  Eigen::MatrixXd x(rows, columns);
  for (double& entry : x.reshaped()) entry = amount(generator);
  return x;
}

/// Columns at right angles to each other and to `basis`, that span with it what x spans; fewer where x adds less.
Eigen::MatrixXd added_directions(const Eigen::MatrixXd& basis, Eigen::MatrixXd x) {
  for (int pass = 0; pass < 2 && x.cols() > 0; ++pass) {
    x -= basis * (basis.transpose() * x);
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(x);
    factors.setThreshold(1e-14);
    const Eigen::Index rank = std::min(factors.rank(), x.rows() - basis.cols());
    x = factors.householderQ() * Eigen::MatrixXd::Identity(x.rows(), rank);
  }
  return x;
}

Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(b.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

/// The lowest modes: values theta = 1 / (omega^2 + shift) of the operator, and its vectors M^1/2 x.
struct Pairs {
  Eigen::VectorXd theta;
  Eigen::MatrixXd vectors;
};

/// The best pairs within the span of `basis`, of which `pushed` is the operator's answer.
Pairs best_pairs(const Eigen::MatrixXd& basis, const Eigen::MatrixXd& pushed, int count) {
  const Eigen::MatrixXd small = basis.transpose() * pushed;
  require<NumericsError>(small.allFinite(),
                         "the natural frequencies of the structure are not finite numbers: look at its ",
                         "material, and at the unit of its sizes");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved((small + small.transpose()) / 2);
  const Eigen::VectorXd& theta = solved.eigenvalues();
  std::vector<int> order(theta.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return std::abs(theta[a]) > std::abs(theta[b]); });
  order.resize(std::min<std::size_t>(order.size(), count));
  std::sort(order.begin(), order.end(), [&](int a, int b) { return 1 / theta[a] < 1 / theta[b]; });
  return {theta(order), solved.eigenvectors()(Eigen::all, order)};
}

/// Lanczos' method with blocks: what the operator makes of a few random vectors, of that again, and so on. A block as
/// wide as `count` finds modes of equal frequency.
Pairs lowest_pairs(const Operator& invert, int count) {
  const Eigen::Index size = invert.root_of_mass().size();
  Eigen::MatrixXd basis(size, 0), pushed(size, 0);
  Eigen::MatrixXd block = random_columns(size, std::min<Eigen::Index>(size, count + 2));
  for (int turn = 0; turn < most_blocks; ++turn) {
    block = added_directions(basis, block);
    const bool all = block.cols() == 0;
    if (!all) {
      basis = beside(basis, block);
      block = invert(block);
      pushed = beside(pushed, block);
    }
    Pairs pairs = best_pairs(basis, pushed, count);
    if (pairs.theta.size() < count) continue;
    const Eigen::MatrixXd answer = pushed * pairs.vectors;
    const Eigen::MatrixXd wrong = answer - basis * pairs.vectors * pairs.theta.asDiagonal();
    if (!all && (wrong.colwise().norm().array() > accuracy * pairs.theta.transpose().array().abs()).any()) continue;
    pairs.vectors = answer.colwise().normalized();  // once more by the operator: smoother than what is in the basis
    return pairs;
  }
  throw NumericsError(text_of("the natural frequencies of the structure did not converge in ", most_blocks, " blocks"));
}

}  // namespace

Modes lowest_modes(const Solid& solid, const Supports& supports, int count, const Eigen::VectorXd& u) {
  const std::vector<int> free = free_unknowns(supports, solid.unknowns());
  count = std::min(count, static_cast<int>(free.size()));
  if (count <= 0) return {{}, Eigen::MatrixXd::Zero(solid.unknowns(), 0)};
  const Operator invert(solid, free, u);
  const Pairs pairs = lowest_pairs(invert, count);
  const Eigen::ArrayXd squares = (pairs.theta.array().inverse() - invert.shift()).max(0);
  Modes modes{(squares.sqrt() / (2 * std::numbers::pi)).matrix(), Eigen::MatrixXd::Zero(solid.unknowns(), count)};
  modes.shapes(free, Eigen::all) = invert.root_of_mass().cwiseInverse().asDiagonal() * pairs.vectors;
  return modes;
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
