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
  explicit Classic(const ClassicOptions& options)
      : options_(options), pressure_(options.pressure), solver_(make_pressure_solver(options.solver)) {}

  StepReport step(Fluid& fluid, Effects& effects, real dt) override {
    StepReport report;

    // 1  explicit part: everything but pressure
    clear_acceleration(fluid);
    effects.run(Stage::force, fluid, dt);
    effects.run(Stage::walls, fluid, dt);
    report.stopped = predict(fluid, dt);
    effects.run(Stage::after_move, fluid, dt);

    // 2  who is near whom now, and n
    report.departed = settle_rows(fluid);

    // 3  implicit part: the pressure that brings n back to n^0
    mark_surface(fluid, options_.surface_ratio);
    report.solve = solve_pressure(fluid, dt);
    clip_pressure(fluid);

    // 4  what the pressure does
    pressure_gradient(fluid);
    report.stopped += correct(fluid, dt);
    return report;
  }

 private:
  SolveReport solve_pressure(Fluid& fluid, real dt) {
    Region region("pressure");
    pressure_.assemble(fluid, dt);
    return solver_->solve(pressure_, fluid.particles.pressure);
  }

  ClassicOptions options_;
  PressureSystem pressure_;
  std::unique_ptr<PressureSolver> solver_;
};

}  // namespace

std::unique_ptr<Scheme> make_classic(const ClassicOptions& options) { return std::make_unique<Classic>(options); }

}  // namespace greenwater
