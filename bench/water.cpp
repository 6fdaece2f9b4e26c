#include "bench/water.hpp"

#include "core/build_facts.hpp"
#include "io/suggest.hpp"
#include "kernels/density.hpp"
#include "kernels/motion.hpp"
#include "kernels/multigrid.hpp"

namespace greenwater::bench {
namespace {

template <class Field, class Value>
void copy_scalar(const std::vector<Value>& from, const Field& to) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), to);  // what is longer, stays
  for (std::size_t i = 0; i < from.size(); ++i) host(i) = static_cast<typename Field::value_type>(from[i]);
  Kokkos::deep_copy(to, host);
}

template <class Field>
void copy_vector(const std::vector<double>& from, const Field& to, int dim) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), to);  // what is longer, stays
  for (std::size_t k = 0; k < from.size(); ++k)
    host(k / dim, k % dim) = static_cast<typename Field::value_type>(from[k]);
  Kokkos::deep_copy(to, host);
}

template <class Value, class Field>
std::vector<Value> scalar_of(const Field& field, int count) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
  std::vector<Value> values(count);
  for (int i = 0; i < count; ++i) values[i] = static_cast<Value>(host(i));
  return values;
}

template <class Field>
std::vector<double> vector_of(const Field& field, int count, int dim) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
  std::vector<double> values;
  for (int i = 0; i < count; ++i)
    for (int d = 0; d < dim; ++d) values.push_back(host(i, d));
  return values;
}

void put_particles(const State& state, const Scene& scene, Fluid& fluid) {
  Particles& p = fluid.particles;
  expect(state.dim == p.dim && state.particles() <= static_cast<int>(p.id.extent(0)));
  p.count = state.particles();
  copy_scalar(state.id, p.id);
  copy_vector(state.position, p.position, p.dim);
  copy_vector(state.velocity, p.velocity, p.dim);
  copy_scalar(state.pressure, p.pressure);
  fluid.time = state.time;
  settle_rows(fluid);
  mark_surface(fluid, static_cast<real>(scene.mps.free_surface_ratio));
}

template <auto make_preconditioner>
class Plain : public TimedSolver {
 public:
  explicit Plain(const CgOptions& options) : preconditioner_(make_preconditioner()), cg_(options) {}
  void set_up(const PressureSystem& system) override { preconditioner_->update(system); }
  SolveReport solve(const PressureSystem& system, const ScalarField& p) override {
    return cg_.solve(system, *preconditioner_, p);
  }

 private:
  std::unique_ptr<Preconditioner> preconditioner_;
  ConjugateGradient cg_;
};

std::unique_ptr<Preconditioner> make_multigrid() { return std::make_unique<Multigrid>(); }

template <class Solver>
std::unique_ptr<TimedSolver> made(const CgOptions& options) {
  return std::make_unique<Solver>(options);
}

template <class Choice>
std::vector<Choice> chosen(const std::vector<Choice>& all, const std::vector<std::string>& names,
                           std::string Choice::*name, const std::string& what) {
  std::vector<Choice> found;
  std::vector<std::string> known;
  for (const Choice& choice : all) {
    known.push_back(choice.*name);
    if (names.empty() && choice.usual) found.push_back(choice);
  }
  for (const std::string& wish : names) {
    const auto at = std::find_if(all.begin(), all.end(), [&](const Choice& c) { return c.*name == wish; });
    require(at != all.end(), "bench: error: no ", what, " \"", wish, "\"; known: ", listed(known));
    found.push_back(*at);
  }
  return found;
}

}  // namespace

const std::vector<PreconditionerChoice>& all_preconditioners() {
  // clang-format off
  static const std::vector<PreconditionerChoice> all{
      {"jacobi", true, false, made<Plain<make_jacobi>>},
      {"multigrid", true, true, made<Plain<make_multigrid>>},
      {"none", false, false, made<Plain<make_identity>>}};
  // clang-format on
  return all;
}

const std::vector<SolverChoice>& all_solvers() {
  static const std::vector<SolverChoice> all{{"cg", "cg", true, true},
                                             {"recomputed", "cg, weights recomputed", false, false}};
  return all;
}

std::vector<PreconditionerChoice> chosen_preconditioners(const std::vector<std::string>& names) {
  return chosen(all_preconditioners(), names, &PreconditionerChoice::name, "preconditioner");
}

std::vector<SolverChoice> chosen_solvers(const std::vector<std::string>& names) {
  return chosen(all_solvers(), names, &SolverChoice::option, "solver");
}

Water::Water(const Scene& scene, const std::optional<State>& state)
    : scene_(scene),
      fluid_(build_fluid(scene, build_walls(scene))),
      effects_(build_effects(scene, fluid_)),
      scheme_(build_scheme(scene, fluid_)) {
  if (state) put(*state);
}

void Water::put(const State& state) {
  put_particles(state, scene_, fluid_);
  steps_ = state.steps;
}

StepReport Water::step() {
  Region region("step");
  const double dt = scene_.mps.time_step;
  const StepReport report = scheme_->step(fluid_, effects_, static_cast<real>(dt));
  ++steps_;
  fluid_.time = static_cast<accum>(steps_) * dt;
  require<NumericsError>(report.solve.converged && report.departed.not_a_number == 0, "step ", steps_,
                         " failed: ", report.departed.not_a_number,
                         " positions are no numbers; pressure: ", report.solve.cause, " after ",
                         report.solve.iterations, " iterations");
  return report;
}

void Water::sort() { fluid_.grid.sort(fluid_.particles); }

void Water::build_rows(bool portable) {
  RowOptions options = row_options(fluid_);
  options.portable = portable;
  fluid_.rows.build(fluid_.particles, fluid_.grid, fluid_.walls, options);
}

State Water::state() const {
  const Particles& p = fluid_.particles;
  State state;
  state.dim = p.dim;
  state.steps = steps_;
  state.time = fluid_.time;
  state.made_by = build_facts().git;
  state.id = scalar_of<int>(p.id, p.count);
  state.position = vector_of(p.position, p.count, p.dim);
  state.velocity = vector_of(p.velocity, p.count, p.dim);
  state.pressure = scalar_of<double>(p.pressure, p.count);
  return state;
}

GridNodes nodes_in_use(const Fluid& fluid) {
  GridNodes nodes;
  if (!fluid.keep_weights) return nodes;
  PressureSystem system({});
  system.assemble(fluid, 1);
  Multigrid multigrid;
  multigrid.update(system);
  const LevelStack& stack = multigrid.levels().stack();
  for (int l = 0; l < stack.count; ++l) nodes.all += stack.level[l].active * node_lanes;
  nodes.first = stack.level[0].active * node_lanes;
  return nodes;
}

Fluid before_pressure(const Scene& scene, const Scene& cut, const State& state) {
  Fluid fluid = build_fluid(scene, build_walls(scene));
  Effects effects = build_effects(scene, fluid);
  put_particles(state, scene, fluid);
  const real dt = static_cast<real>(scene.mps.time_step);
  clear_acceleration(fluid);
  effects.run(Stage::force, fluid, dt);
  effects.run(Stage::walls, fluid, dt);
  predict(fluid, dt);
  effects.run(Stage::after_move, fluid, dt);
  fluid.faces = build_walls(cut);
  make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
  settle_rows(fluid);
  mark_surface(fluid, static_cast<real>(scene.mps.free_surface_ratio));
  return fluid;
}

}  // namespace greenwater::bench
