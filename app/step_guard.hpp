#pragma once
// Steps that can be undone: what a step starts from is kept, and what it must not do is looked at when it is over.

#include "app/scene.hpp"
#include "app/scheme.hpp"
#include "kernels/moves.hpp"

namespace greenwater {

class StepGuard {
 public:
  /// Of steps of the scene, whose walls move in them or not.
  StepGuard(const Scene& scene, bool walls_move);

  /// Before a step. Memory is kept, so that a steady step allocates nothing.
  void keep(const Fluid& fluid, const Coupler& coupler);

  /// After a step that has come to its end: throws NumericsError when a position or a velocity is not a number, when a
  /// particle has gone further than mps.undo.displacement, and when two have run together to less than mps.undo.distance.
  void check(const Fluid& fluid, const StepReport& report) const;

  /// Particles, walls, structures and time are what they were to the last bit, and in the same order. Rows and grid are
  /// those of the step that is undone: settle_rows() has to be called before the next step.
  void put_back(Fluid& fluid, Coupler& coupler) const;

 private:
  double spacing_;                  // [m]
  double displacement_, distance_;  // [m]
  bool walls_move_;
  Before before_;
  std::vector<WallFace> faces_;  // where walls move
  Coupler::State coupler_;
  double time_ = 0;  // [s]
};

}  // namespace greenwater
