#pragma once
// A scene of water and walls that marches, with structures in it or without.

#include "app/build.hpp"
#include "app/build_coupling.hpp"
#include "app/simulation.hpp"
#include "app/step_guard.hpp"
#include "app/step_length.hpp"
#include "kernels/sample.hpp"

namespace greenwater {

class FluidSimulation : public Simulation {
 public:
  /// Throws CaseError when the scene cannot be built.
  explicit FluidSimulation(const Scene& scene);

  /// One fluid step, t to t + dt. Throws NumericsError when the pressure solve stalls (unless the case says warn), meets
  /// a number that is none, or the step breaks another of its limits: where steps can be undone when shorter ones fail too,
  /// with the state before the step; else at once, with that of the failed step.
  void step() override;
  /// The same with a first try of that length [s], which must not lead beyond the end of the run: a multiple of the
  /// structures' substep.
  void step_of(double dt);

  double time() const override { return fluid_.time; }
  std::int64_t steps() const override { return steps_; }
  /// The last step, before the first one that one [s].
  double dt() const { return dt_; }

  /// The numbers of the last step; its notices are handed out once.
  StepFacts facts();
  std::vector<std::string> history_header() const override;
  std::string thermo_header() const override;
  RunFacts run_facts() override;

  double sample(std::size_t probe) override;
  ProbeHead probe_head(std::size_t probe) const override;

  /// id, position, velocity, pressure, number_density and surface of every particle, in the order of the grid.
  Table fluid_table() const;
  /// The corners of every wall as it stands now [m]: two of a straight wall in 2-D, three of a triangle in 3-D.
  std::vector<WallShape> wall_shapes() const;
  Picture picture() const override;

  /// Particles, steps, memory, walls, effects.
  std::vector<std::string> plan() const override;

  const Fluid& fluid() const { return fluid_; }
  const Effects& effects() const { return effects_; }
  const Coupler& coupler() const { return coupler_; }

 private:
  void note(const std::string& kind, const std::string& text, std::int64_t count);
  /// Of one step.
  struct Tries {
    int failed = 0;
    double first = 0, least = 0;  // the first one, and the shortest that is allowed [s]
  };
  void take(double dt);
  double shorter(double dt, Tries& tries, const std::string& fault);
  double time_after(double dt) const;
  void refuse(const StepReport& report) const;
  bool stalls_are_borne(const StepReport& report) const;
  std::string stall_text(const StepReport& report) const;
  bool walls_move() const { return coupler_.any() || !effects_.at(Stage::walls).empty(); }
  void look_after(const StepReport& report);
  void look_after_coupling();
  void add_ledger(std::vector<double>& row) const;
  double sample_structure(const ProbeCase& probe);
  /// Particles that are there no more. What a step that is undone has retired is back, so nobody counts them one by one.
  std::int64_t lost() const { return at_start_ - fluid_.particles.count; }

  Scene scene_;
  std::vector<Structure> structures_;
  WallFaces walls_at_start_;
  Coupler coupler_;
  Packing packing_;  // of the start, where particles were spread
  Fluid fluid_;
  Effects effects_;
  std::unique_ptr<Scheme> scheme_;
  StepLength step_length_;
  std::unique_ptr<StepGuard> guard_;  // none where no step is undone
  double dt_ = 0;
  PointSampler sampler_;
  std::vector<Point> pressure_points_;                  // of each probe; only those of pressure probes mean anything
  std::vector<std::unique_ptr<Motion>> probe_motions_;  // of those on a wall that moves
  std::vector<int> reactions_;                          // of each probe; place in the step's report, or -1
  Point potential_zero_{};
  double first_energy_ = 0;
  std::int64_t steps_ = 0;
  std::int64_t at_start_ = 0;   // particles
  std::int64_t told_lost_ = 0;  // those that a notice has told of
  StepReport last_;
  std::vector<Notice> notices_;
};

}  // namespace greenwater
