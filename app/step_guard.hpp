#pragma once
// Steps that can be undone: what a step starts from is kept, and what it must not do is looked at when it is over.

#include "app/scene.hpp"
#include "app/scheme.hpp"
#include "kernels/moves.hpp"

namespace greenwater {

class StepGuard {
 public:
  /// Of steps of the scene, whose walls move in them or not. `first_energy`: of the fluid at the start, its potential counted
  /// from `potential_zero` [J/m], in 3-D [J].
  StepGuard(const Scene& scene, bool walls_move, const Point& potential_zero, double first_energy);

  /// Before a step. Memory is kept, so that a steady step allocates nothing.
  void keep(const Fluid& fluid, const Coupler& coupler);

  /// After a step that has come to its end: throws NumericsError when a position or a velocity is not a number, when a
  /// particle has gone further than mps.undo.displacement, and when two have run together to less than mps.undo.distance;
  /// of a step that is made again also when the fluid's energy has risen by more than a tenth: what threw a particle too far
  /// throws it less far in a shorter step, even if it is as fast.
  void check(const Fluid& fluid, const StepReport& report) const;

  /// Particles, walls, structures and time are what they were to the last bit, and in the same order. Rows and grid are
  /// those of the step that is undone: settle_rows() has to be called before the next step.
  void put_back(Fluid& fluid, Coupler& coupler);

 private:
  void check_energy(const Fluid& fluid) const;

  double spacing_;                  // [m]
  double displacement_, distance_;  // [m]
  bool walls_move_;
  bool judges_energy_;  // there is an energy to measure a rise by, and no work of body forces in it
  Point potential_zero_;
  double first_energy_;
  bool again_ = false;  // the step is made again
  double energy_ = 0;   // before it
  Before before_;
  std::vector<WallFace> faces_;  // where walls move
  Coupler::State coupler_;
  double time_ = 0;  // [s]
};

}  // namespace greenwater
