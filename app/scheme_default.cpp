#include "app/scheme.hpp"
#include "core/region.hpp"
#include "kernels/motion.hpp"
#include "kernels/operators/rigid_walls.hpp"
#include "kernels/speed.hpp"

namespace greenwater {
namespace {

class Default : public Scheme {
 public:
  using Scheme::step;

  explicit Default(const DefaultOptions& options)
      : options_(options), pressure_({}), solver_(make_pressure_solver(options.solver)) {
    if (options.separation > 0) separation_ = make_collision({options.separation, real(0.2), 5});
  }

  StepReport step(Fluid& fluid, Effects& effects, Coupler& coupler, real dt) override {
    StepReport report;

    // 1  who is near whom, and what but pressure and gravity does
    effects.run(Stage::wall_speeds, fluid, dt);
    coupler.foresee(fluid, dt);
    report.departed = settle_rows(fluid);
    if (options_.fits) fit_neighbourhoods(fluid, table_of(fluid));
    clear_acceleration(fluid);
    effects.run(Stage::force, fluid, dt);
    kick(fluid, dt);

    // 2  the pressure that keeps the flow free of divergence
    const real bulk = bulk_speed(fluid), U = options_.reference_speed > 0 ? options_.reference_speed : bulk;
    survey(fluid, table_of(fluid), survey_options(fluid, coupler, U, bulk * dt / static_cast<real>(fluid.spacing)), dt,
           survey_);
    if (looks_at_walls(fluid)) walls_.join(fluid, survey_, survey_.rhs, dt);
    report.solve = solve_pressure(fluid, coupler, dt);

    report.reactions = walls_.reactions(fluid);

    // 3  what the pressure does, and what is smoothed
    options_.smoothing.speed = U;
    accelerate(fluid, survey_, options_.smoothing, dt);

    // 4  particles and walls go on
    report.stopped = advance(fluid, survey_, dt);
    effects.run(Stage::walls, fluid, dt);
    coupler.place_walls(fluid, dt);
    if (separation_) report.nearest = keep_apart(fluid, dt);
    effects.run(Stage::after_move, fluid, dt);
    coupler.finish(fluid, dt);
    return report;
  }

  int watch(int body) override { return walls_.watch(body); }

 private:
  const LatticeTable& table_of(const Fluid& fluid) {
    if (table_.few == 0) table_ = make_lattice_table(fluid.gradient.weight, fluid.particles.dim, fluid.spacing);
    return table_;
  }

  bool looks_at_walls(const Fluid& fluid) const { return walls_.any_watched() || rigid_walls_move(fluid.faces); }

  // U: the flow's speed [m/s]; way: of the bulk of the fluid in this step, x spacing.
  SurveyOptions survey_options(const Fluid& fluid, const Coupler& coupler, real U, real way) const {
    SurveyOptions options;
    options.drift_speed = options_.drift * U;
    options.loads = looks_at_walls(fluid) || coupler.any();
    options.shifts = options_.shifting > 0;
    if (options.shifts) options.shift_rate = smaller(options_.shifting * way, options_.most_shifting);
    return options;
  }

  // Once, and again as long as structures say so.
  SolveReport solve_pressure(Fluid& fluid, Coupler& coupler, real dt) {
    pressure_.assemble(fluid, survey_.rhs, survey_.diagonal, survey_.fixed);
    if (options_.fits) replace_rows(fluid);
    if (survey_.closed) pressure_.close();
    if (options_.diagonal_factor > 1) pressure_.raise_diagonal(options_.diagonal_factor - 1);
    coupler.join(fluid, survey_, pressure_, dt);
    SolveReport report = solve(fluid);
    while (coupler.answer(fluid, pressure_, dt)) {
      const int before = report.iterations;
      report = solve_again(fluid);
      report.iterations += before;
    }
    if (coupler.weighs()) coupler.weigh(fluid, pressure_, *solver_, dt);
    return report;
  }

  void replace_rows(Fluid& fluid) {
    weigh_rows(fluid, survey_);
    pressure_.replace_rows(fluid.fits.weight, fluid.fits.diagonal);
  }

  SolveReport solve(Fluid& fluid) {
    Region region("pressure");
    return solver_->solve(pressure_, fluid.particles.pressure);
  }

  // Nothing but the walls' speeds has changed.
  SolveReport solve_again(Fluid& fluid) {
    Region region("pressure");
    return solver_->solve_again(pressure_, fluid.particles.pressure);
  }

  // Returns how near two have come to each other [m].
  real keep_apart(Fluid& fluid, real dt) {
    Region region("separation");
    separation_->apply(fluid, dt);
    return separation_->nearest();
  }

  DefaultOptions options_;
  PressureSystem pressure_;
  std::unique_ptr<PressureSolver> solver_;
  std::unique_ptr<Collision> separation_;
  LatticeTable table_{};
  Survey survey_;
  RigidWalls walls_;
};

}  // namespace

std::unique_ptr<Scheme> make_default(const DefaultOptions& options) { return std::make_unique<Default>(options); }

}  // namespace greenwater
