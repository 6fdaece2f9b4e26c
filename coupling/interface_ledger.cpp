#include "coupling/interface_ledger.hpp"

namespace greenwater {

void InterfaceLedger::add(const Eigen::VectorXd& load, const Eigen::VectorXd& applied, const Eigen::VectorXd& seen,
                          const Eigen::VectorXd& speed, int dim, double depth, double dt, double least) {
  sums_.by_fluid += depth * dt * load.dot(seen);
  sums_.by_structure += depth * dt * applied.dot(speed);
  for (Eigen::Index i = 0; i < applied.size(); ++i) sums_.impulse[i % dim] += depth * dt * applied[i];
  watch(speed, least);
}

void InterfaceLedger::watch(const Eigen::VectorXd& speed, double least) {
  constexpr double opposite = -0.5;  // cosine between two accelerations that count as each other's reverse
  if (speed_.size() == 0) speed_ = jump_ = Eigen::VectorXd::Zero(speed.size());
  const Eigen::VectorXd jump = speed - speed_;
  const double size = jump.norm(), before = jump_.norm();
  if (jump.dot(jump_) < opposite * size * before && size > before && jump.lpNorm<Eigen::Infinity>() > least) {
    growth_ = alternations_ == 0 ? size / before : growth_ + (size / before - growth_) / (alternations_ + 1);
    ++alternations_;
  } else {
    alternations_ = 0;
    growth_ = 0;
  }
  speed_ = speed;
  jump_ = jump;
}

}  // namespace greenwater
