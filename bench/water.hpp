#pragma once
// Water at a state, ready to go on: the one place of bench/ that knows how the solver is put together. A new
// preconditioner, or another way of solving, is one line in the tables of water.cpp.

#include <optional>

#include "app/build.hpp"
#include "bench/states.hpp"

namespace greenwater::bench {

/// A scene that marches like Simulation, but can be put back.
class Water {
 public:
  /// As the scene begins, or as `state` left it.
  Water(const Scene& scene, const std::optional<State>& state);

  /// Back to a state of the same scene.
  void put(const State& state);

  /// One step, in a region "step". Throws NumericsError when it fails.
  StepReport step();

  /// Sorts the particles into the grid as a step does, for build_rows().
  void sort();
  /// The rows of where the particles were sorted; `portable` the way they are built on GPUs.
  void build_rows(bool portable);

  State state() const;
  double time() const { return fluid_.time; }
  std::int64_t steps() const { return steps_; }
  const Fluid& fluid() const { return fluid_; }

 private:
  Scene scene_;
  Fluid fluid_;
  Effects effects_;
  std::unique_ptr<Scheme> scheme_;
  std::int64_t steps_ = 0;
};

/// Nodes that the multigrid would have in use for this fluid: those of its first level, and of all.
struct GridNodes {
  double first = 0, all = 0;
};
GridNodes nodes_in_use(const Fluid& fluid);

/// The fluid as the pressure solve of the next step sees it: x*, u*, n and rows between the walls of the scene and
/// those that `cut` adds, p still that of the step before.
Fluid before_pressure(const Scene& scene, const Scene& cut, const State& state);

/// A solver whose two parts are timed apart.
class TimedSolver {
 public:
  virtual ~TimedSolver() = default;
  /// What it has to do once for each system.
  virtual void set_up(const PressureSystem& system) = 0;
  virtual SolveReport solve(const PressureSystem& system, const ScalarField& p) = 0;
};

/// A way to precondition, by its name in results.
struct PreconditionerChoice {
  std::string name;
  bool usual;      // measured when nobody asks for it
  bool only_kept;  // it needs the weights beside the rows
  std::unique_ptr<TimedSolver> (*make)(const CgOptions&);
};
const std::vector<PreconditionerChoice>& all_preconditioners();

/// A way to solve: `option` is how it is asked for, `name` its name in results.
struct SolverChoice {
  std::string option, name;
  bool usual;
  bool keep_weights;
};
const std::vector<SolverChoice>& all_solvers();

/// Those that are named, in that order, or the usual ones. Throws CaseError for a name that is not known.
std::vector<PreconditionerChoice> chosen_preconditioners(const std::vector<std::string>& names);
std::vector<SolverChoice> chosen_solvers(const std::vector<std::string>& names);

}  // namespace greenwater::bench
