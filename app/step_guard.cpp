#include "app/step_guard.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "kernels/sample.hpp"

namespace greenwater {

StepGuard::StepGuard(const Scene& scene, bool walls_move, const Point& potential_zero, double first_energy)
    : spacing_(scene.mps.spacing),
      displacement_(scene.mps.undo.displacement * spacing_),
      distance_(scene.mps.undo.distance * spacing_),
      walls_move_(walls_move),
      judges_energy_(scene.gravity != Point{} && scene.body_force.empty()),
      potential_zero_(potential_zero),
      first_energy_(first_energy) {}

void StepGuard::keep(const Fluid& fluid, const Coupler& coupler) {
  Region region("undo");
  greenwater::keep(fluid.particles, before_);
  if (walls_move_) faces_ = fluid.faces.faces;
  coupler.keep(coupler_);
  time_ = fluid.time;
  again_ = false;
}

void StepGuard::check(const Fluid& fluid, const StepReport& report) const {
  Region region("undo");
  const double way = longest_way(fluid, before_);
  require<NumericsError>(std::isfinite(way), "a position or a velocity is not a number any more");
  require<NumericsError>(way <= displacement_, "a particle has gone ", way / spacing_,
                         " x spacing in one step, further than mps.undo.displacement = ", displacement_ / spacing_);
  if (again_ && judges_energy_) check_energy(fluid);
  if (report.nearest >= distance_) return;
  const int pairs = pairs_run_together(fluid, before_, static_cast<real>(distance_));
  require<NumericsError>(
      pairs == 0, pairs, pairs == 1 ? " pair" : " pairs",
      " of particles ran together in one step, nearer than mps.undo.distance = ", distance_ / spacing_, " x spacing");
}

void StepGuard::check_energy(const Fluid& fluid) const {
  constexpr double most = 0.1;  // of the fluid's energy, now or at the start
  const double rise = fluid_sums(fluid, potential_zero_).energy() - energy_, scale = std::max(energy_, first_energy_);
  require<NumericsError>(rise <= most * scale, "the fluid's energy has risen by ", rise / scale,
                         " of what it was, in one step");
}

void StepGuard::put_back(Fluid& fluid, Coupler& coupler) {
  Region region("undo");
  greenwater::put_back(before_, fluid.particles);
  coupler.put_back(coupler_);
  fluid.time = time_;
  if (judges_energy_ && !again_) energy_ = fluid_sums(fluid, potential_zero_).energy();
  again_ = true;
  if (!walls_move_) return;
  fluid.faces.faces = faces_;
  make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
}

}  // namespace greenwater
