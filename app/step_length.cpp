#include "app/step_length.hpp"

#include <algorithm>
#include <cmath>

#include "app/scene_shape.hpp"
#include "core/check.hpp"
#include "kernels/speed.hpp"

namespace greenwater {

double step_at_rest(const Scene& scene) {
  constexpr double share = 0.25;  // of what is stable
  const MpsCase& mps = scene.mps;
  double dt = mps.time_step;
  if (!mps.adaptive) return dt;
  for (const ViscosityCase& viscosity : scene.viscosity)
    dt = std::min(dt, share * mps.spacing * mps.spacing / (scene.dimension * viscosity.kinematic));
  const Point& g = scene.gravity;
  const double fall = std::hypot(g[0], g[1], g[2]);
  return fall > 0 ? std::min(dt, share * std::sqrt(mps.spacing / fall)) : dt;
}

StepLength::StepLength(const Scene& scene, double quantum)
    : adaptive_(scene.mps.adaptive),
      differ_(scene.mps.adaptive),
      at_rest_(step_at_rest(scene)),
      end_(scene.end),
      way_(scene.mps.courant * scene.mps.spacing),
      growth_(scene.mps.growth),
      quantum_(quantum) {
  for (const Shape& shape : shapes_of(scene))
    if (shape.geometry->motion) walls_.push_back({Motion(*shape.geometry->motion), reach_of(shape)});
}

double StepLength::next(const Fluid& fluid, double previous) const {
  if (!differ_) return at_rest_;
  const double grown = std::max(growth_ * previous, previous + quantum_);  // of few quanta a tenth is none
  const double longest = std::min(at_rest_, grown);
  const double dt = whole(adaptive_ ? slow_enough(fluid, longest) : longest);
  const double left = end_ - fluid.time;
  if (left <= 0 || left >= 2 * dt) return dt;
  return left <= dt ? whole(left) : whole(left / 2);
}

double StepLength::allowed(const Fluid& fluid) const {
  return adaptive_ ? whole(slow_enough(fluid, at_rest_)) : at_rest_;
}

double StepLength::end_of(double time, double dt) const {
  const double left = end_ - time;
  return left > 0 && std::abs(dt - left) <= quantum_ ? end_ : time + dt;
}

/// The multiple below, one at least.
double StepLength::whole(double dt) const {
  constexpr double round_off = 1e-9;
  return quantum_ > 0 ? std::max(1.0, std::floor(dt / quantum_ + round_off)) * quantum_ : dt;
}

double StepLength::slow_enough(const Fluid& fluid, double dt) const {
  const double speed = bulk_speed(fluid);
  require<NumericsError>(std::isfinite(speed), "t = ", fluid.time,
                         " s: a velocity is not a number; a shorter mps.time_step or a smaller spacing may help");
  if (speed * dt > way_) dt = way_ / speed;
  return slow_enough_for_walls(fluid.time, dt);
}

double StepLength::slow_enough_for_walls(double time, double longest) const {
  constexpr int halvings = 30;
  constexpr double shortest = 1e-3, round_off = 1e-9;
  const auto good = [&](double dt) {
    return std::all_of(walls_.begin(), walls_.end(), [&](const MovingWall& wall) {
      return longest_way(wall.motion, time, time + dt, wall.reach) <= (1 + round_off) * way_;
    });
  };
  if (good(longest)) return longest;
  double below = 0, above = longest;
  for (int k = 0; k < halvings; ++k) {
    const double middle = (below + above) / 2;
    (good(middle) ? below : above) = middle;
  }
  return below > shortest * longest ? below : longest;  // a wall that jumps does so most gently in a long step
}

}  // namespace greenwater
