#pragma once
// What crosses the interface of a structure, and whether it does so soundly.

#include <Eigen/Dense>
#include <string>

namespace greenwater {

class InterfaceLedger {
 public:
  struct Sums {
    double by_fluid = 0;      // work of the fluid on its walls: its load times their way as it saw them [J]
    double by_structure = 0;  // work that the structure received: the load under which it marched times its way [J]
    double impulse[3] = {};   // of the fluid on the structure [N s]
    /// What staggering has made or lost [J].
    double mismatch() const { return by_fluid - by_structure; }
  };

  /// One step: load of the fluid at its end and load under which the structure marched [N/m or N], speeds of the corners
  /// as the fluid saw them and as the structure had them [m/s]; `depth` turns them into forces; changes of speed below
  /// `least` [m/s] are not looked at.
  void add(const Eigen::VectorXd& load, const Eigen::VectorXd& applied, const Eigen::VectorXd& seen,
           const Eigen::VectorXd& speed, int dim, double depth, double dt, double least = 0);

  const Sums& sums() const { return sums_; }

  /// How many steps in a row the accelerations of the walls have changed sign all together and grown, and by how much in
  /// each of them; 0 while they do not. In a staggered march of an incompressible fluid that factor is the added mass
  /// over the structure's.
  int alternations() const { return alternations_; }
  double growth() const { return growth_; }

 private:
  void watch(const Eigen::VectorXd& speed, double least);

  Sums sums_;
  Eigen::VectorXd speed_, jump_;
  int alternations_ = 0;
  double growth_ = 0;
};

}  // namespace greenwater
