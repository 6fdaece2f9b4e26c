#pragma once
// How long a step is: always the same, or as long as the flow allows; and shorter for a while after one was undone.

#include <vector>

#include "app/motion.hpp"
#include "kernels/fluid.hpp"

namespace greenwater {

/// The longest step of the run [s]: mps.time_step; where steps adapt not more than 0.25 l0^2 / (dim nu), for viscosity is
/// explicit, and 0.25 sqrt(l0 / g), which moves a particle at rest by a thirtieth of l0.
double step_at_rest(const Scene& scene);

class StepLength {
 public:
  /// `quantum`: where steps differ they are multiples of it, a substep of structures [s]; 0: of nothing.
  explicit StepLength(const Scene& scene, double quantum = 0);

  /// The longest step of the run [s].
  double at_rest() const { return at_rest_; }
  /// Whether steps differ: where they adapt, and from the first one on that was undone. Else the time is a multiple of one.
  bool differ() const { return differ_; }
  /// From now on they do.
  void let_differ() { differ_ = true; }

  /// The step from fluid.time on [s]. Where steps adapt: the bulk of the fluid, and no wall, moves further than courant l0
  /// in it. Where they differ it is at most growth x `previous` [s] (infinite: there is none), and such that the last step
  /// ends at the end of the run without being tiny, because a density error is worth a pressure of 1/dt^2. Throws
  /// NumericsError when a velocity is not a number.
  double next(const Fluid& fluid, double previous) const;

  /// The longest step from fluid.time on that the fluid, its walls and the case allow, whatever was before [s].
  double allowed(const Fluid& fluid) const;
  /// Half of a step, or as much as a quantum allows [s]: `dt` itself when it cannot be shorter.
  double half(double dt) const { return whole(dt / 2); }
  /// The end of the step from `time` on, and that of the run itself when it is the last [s].
  double end_of(double time, double dt) const;

 private:
  struct MovingWall {
    Motion motion;
    double reach;  // [m] from its axis
  };
  double whole(double dt) const;
  double slow_enough(const Fluid& fluid, double dt) const;
  double slow_enough_for_walls(double time, double longest) const;

  bool adaptive_, differ_;
  double at_rest_, end_;  // [s]
  double way_;            // courant l0 [m]
  double growth_;         // [-]
  double quantum_;        // [s]
  std::vector<MovingWall> walls_;
};

}  // namespace greenwater
