#include "app/step_guard.hpp"

#include <cmath>

#include "core/check.hpp"

namespace greenwater {

StepGuard::StepGuard(const Scene& scene, bool walls_move)
    : spacing_(scene.mps.spacing),
      displacement_(scene.mps.undo.displacement * spacing_),
      distance_(scene.mps.undo.distance * spacing_),
      walls_move_(walls_move) {}

void StepGuard::keep(const Fluid& fluid, const Coupler& coupler) {
  Region region("undo");
  greenwater::keep(fluid.particles, before_);
  if (walls_move_) faces_ = fluid.faces.faces;
  coupler.keep(coupler_);
  time_ = fluid.time;
}

void StepGuard::check(const Fluid& fluid, const StepReport& report) const {
  Region region("undo");
  const double way = longest_way(fluid, before_);
  require<NumericsError>(std::isfinite(way), "a position or a velocity is not a number any more");
  require<NumericsError>(way <= displacement_, "a particle has gone ", way / spacing_,
                         " x spacing in one step, further than mps.undo.displacement = ", displacement_ / spacing_);
  if (report.nearest >= distance_) return;
  const int pairs = pairs_run_together(fluid, before_, static_cast<real>(distance_));
  require<NumericsError>(
      pairs == 0, pairs, pairs == 1 ? " pair" : " pairs",
      " of particles ran together in one step, nearer than mps.undo.distance = ", distance_ / spacing_, " x spacing");
}

void StepGuard::put_back(Fluid& fluid, Coupler& coupler) const {
  Region region("undo");
  greenwater::put_back(before_, fluid.particles);
  coupler.put_back(coupler_);
  fluid.time = time_;
  if (!walls_move_) return;
  fluid.faces.faces = faces_;
  make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
}

}  // namespace greenwater
