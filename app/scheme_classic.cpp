#include "app/scheme.hpp"
#include "kernels/density.hpp"
#include "kernels/motion.hpp"

namespace greenwater {

Departed settle_rows(Fluid& fluid) {
  Departed departed;
  {
    Region region("sort");
    departed = fluid.grid.sort(fluid.particles);
  }
  Region region("rows");
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  return departed;
}

namespace {

class Classic : public Scheme {
 public:
  using Scheme::step;

  explicit Classic(const ClassicOptions& options)
      : options_(options), pressure_(options.pressure), solver_(make_pressure_solver(options.solver)) {}

  StepReport step(Fluid& fluid, Effects& effects, Coupler& coupler, real dt) override {
    // 0  where structures go
    coupler.foresee(fluid, dt);
    if (coupler.repeats_steps()) copy(fluid.particles, start_);
    StepReport report = up_to_pressure(fluid, effects, coupler, dt);
    while (coupler.answer_of_whole_step(fluid, dt)) {
      const int before = report.solve.iterations;
      copy(start_, fluid.particles);
      settle_rows(fluid);  // as the first attempt has sorted them
      report = up_to_pressure(fluid, effects, coupler, dt);
      report.solve.iterations += before;
    }

    // 4  what the pressure does
    pressure_gradient(fluid);
    report.stopped += correct(fluid, dt);
    coupler.finish(fluid, dt);
    return report;
  }

 private:
  StepReport up_to_pressure(Fluid& fluid, Effects& effects, Coupler& coupler, real dt) {
    StepReport report;

    // 1  explicit part: everything but pressure
    clear_acceleration(fluid);
    effects.run(Stage::force, fluid, dt);
    effects.run(Stage::walls, fluid, dt);
    coupler.place_walls(fluid, dt);
    report.stopped = predict(fluid, dt);
    effects.run(Stage::after_move, fluid, dt);

    // 2  who is near whom now, and n
    report.departed = settle_rows(fluid);

    // 3  implicit part: the pressure that brings n back to n^0
    mark_surface(fluid, options_.surface_ratio);
    report.solve = solve_pressure(fluid, dt);
    clip_pressure(fluid);
    return report;
  }

  SolveReport solve_pressure(Fluid& fluid, real dt) {
    Region region("pressure");
    pressure_.assemble(fluid, dt);
    return solver_->solve(pressure_, fluid.particles.pressure);
  }

  ClassicOptions options_;
  PressureSystem pressure_;
  std::unique_ptr<PressureSolver> solver_;
  Particles start_;  // of a step that may be made again; else empty
};

}  // namespace

std::unique_ptr<Scheme> make_classic(const ClassicOptions& options) { return std::make_unique<Classic>(options); }

}  // namespace greenwater
