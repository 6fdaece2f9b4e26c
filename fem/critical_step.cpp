#include "fem/critical_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr double accuracy = 1e-4;  // of omega^2
constexpr int most_steps = 400;

double shortest_edge(const SolidMesh& mesh) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    for (int side = 0; side < mesh.sides_per_element(); ++side) {
      const auto nodes = nodes_of(mesh, {static_cast<int>(e), side});
      const auto &a = mesh.nodes[nodes[0]], &b = mesh.nodes[nodes[1]];
      least = std::min(least, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  }
  return least;
}

/// M^-1/2 K M^-1/2 on the free unknowns, from differences of the force: no matrix is made.
class ScaledStiffness {
 public:
  ScaledStiffness(const Solid& solid, const Supports& supports, const Eigen::VectorXd& u)
      : solid_(solid), u_(u), root_(solid.mass().cwiseSqrt().cwiseInverse()), before_(u.size()), after_(u.size()) {
    for (const int i : supports.held) root_[i] = 0;
    length_ = 1e-6 * shortest_edge(solid.mesh());
  }

  Eigen::VectorXd operator()(const Eigen::VectorXd& x) {
    const Eigen::VectorXd way = root_.cwiseProduct(x);
    const double step = length_ / way.lpNorm<Eigen::Infinity>();
    solid_.internal_force(u_ - step * way, before_);
    solid_.internal_force(u_ + step * way, after_);
    return root_.cwiseProduct(after_ - before_) / (2 * step);
  }

  Eigen::VectorXd start() const {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> amount(-1, 1);
    Eigen::VectorXd x(u_.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) x[i] = root_[i] > 0 ? amount(generator) : 0;
    return x;
  }

 private:
  const Solid& solid_;
  const Eigen::VectorXd& u_;
  Eigen::VectorXd root_;  // m^-1/2, 0 where held
  Eigen::VectorXd before_, after_;
  double length_;
};

}  // namespace

double highest_frequency(const Solid& solid, const Supports& supports, const Eigen::VectorXd& u) {
  ScaledStiffness k(solid, supports, u);
  Eigen::VectorXd q = k.start(), last = Eigen::VectorXd::Zero(q.size());
  if (q.isZero(0)) return 0;
  q.normalize();
  Eigen::VectorXd diagonal(most_steps), beside(most_steps);
  double square = 0;
  for (int step = 0; step < most_steps; ++step) {
    Eigen::VectorXd next = k(q);
    diagonal[step] = q.dot(next);
    next -= diagonal[step] * q;
    if (step > 0) next -= beside[step - 1] * last;
    beside[step] = next.norm();
    require<NumericsError>(std::isfinite(diagonal[step]) && std::isfinite(beside[step]),
                           "the stiffness of the structure over its mass is more than numbers can hold (young = ",
                           solid.material().young, " Pa, density = ", solid.material().density,
                           " kg/m^3): take values of a real material, and look at the unit of its sizes");
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(diagonal.head(step + 1), beside.head(step));
    const double residual = beside[step] * std::abs(ritz.eigenvectors()(step, step));
    square = ritz.eigenvalues()[step] + residual;
    if (residual <= accuracy * square) break;
    last = q;
    q = next / beside[step];
  }
  return std::sqrt(square);
}

double highest_frequency(const Solid& solid, const Supports& supports) {
  return highest_frequency(solid, supports, Eigen::VectorXd::Zero(solid.unknowns()));
}

double critical_step(const Solid& solid, const Supports& supports) {
  const double omega = highest_frequency(solid, supports);
  return omega > 0 ? 2 / omega : std::numeric_limits<double>::infinity();
}

}  // namespace greenwater
