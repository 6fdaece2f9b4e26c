#pragma once
// What loads a structure: patterns of nodal forces with factors that change in time, pressure that follows its facets, and
// accelerations that vary in space and time.

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <vector>

#include "fem/solid.hpp"

namespace greenwater {

class Loads {
 public:
  using Factor = std::function<double(double)>;  // at a time [s]
  /// Writes an acceleration [m/s2] for each unknown, at a time [s].
  using Acceleration = std::function<void(double, Eigen::VectorXd&)>;

  /// A load [N] for each unknown that stays as it is.
  void add(const Eigen::VectorXd& pattern);
  /// A pattern times a factor.
  void add(Eigen::VectorXd pattern, Factor factor);
  /// Pressure [Pa] on facets where they are now, against their outer side.
  void add_follower(std::vector<Facet> facets, Factor pressure);
  /// Force per mass on the whole body, lumped as its mass. See prepare().
  void add_acceleration(Acceleration acceleration);

  /// Whether the load stays as it is.
  bool steady() const { return varying_.empty() && followers_.empty() && accelerations_.empty(); }
  /// Looks at accelerations, which are costly, at both ends of a span of time; evaluate() goes in straight lines between
  /// them: second order in its length. Allocates nothing but at the first time.
  void prepare(const Solid& solid, double from, double to);
  /// f = the load at time t, in the span prepared last, and displacement u [N]. Allocates nothing.
  void evaluate(const Solid& solid, double t, const Eigen::VectorXd& u, Eigen::VectorXd& f) const;

 private:
  struct Varying {
    Eigen::VectorXd pattern;
    Factor factor;
  };
  struct Follower {
    std::vector<Facet> facets;
    Factor pressure;
  };

  Eigen::VectorXd constant_;  // empty without any
  std::vector<Varying> varying_;
  std::vector<Follower> followers_;
  std::vector<Acceleration> accelerations_;
  double from_ = 0, to_ = 0;                   // [s]
  Eigen::VectorXd at_from_, at_to_, summand_;  // forces of all accelerations, and one of these [N]
};

/// Places [m] to numbers and vectors; in 2-D z = 0.
using FieldAt = std::function<double(const std::array<double, 3>&)>;
using VectorAt = std::function<std::array<double, 3>(const std::array<double, 3>&)>;

/// The weight of the body under an acceleration [m/s2].
Eigen::VectorXd gravity_pattern(const Solid& solid, const std::array<double, 3>& acceleration);

/// Pressure [Pa] against the outer side of facets of the body at rest, consistent with its shape functions.
Eigen::VectorXd pressure_pattern(const Solid& solid, const std::vector<Facet>& facets, const FieldAt& pressure);

/// Force per area [Pa] on facets of the body at rest, consistent with its shape functions.
Eigen::VectorXd traction_pattern(const Solid& solid, const std::vector<Facet>& facets, const VectorAt& traction);

/// A force [N] on one node.
Eigen::VectorXd nodal_pattern(const Solid& solid, int node, const std::array<double, 3>& force);

}  // namespace greenwater
