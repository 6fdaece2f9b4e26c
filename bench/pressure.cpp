// The pressure solve in all its variants, which take turns, so that their ratios hold where the machine's speed drifts.

#include <fmt/format.h>

#include <cmath>

#include "bench/bytes.hpp"
#include "bench/measure.hpp"
#include "bench/water.hpp"
#include "core/kokkos.hpp"
#include "kernels/blas.hpp"

namespace greenwater::bench {
namespace {

/// The equation of one state, for one way of solving it.
struct Problem {
  Problem(const Fluid& water, const SolverChoice& choice, const PressureOptions& options, double step)
      : solver(choice), fluid(water), system(options), dt(static_cast<real>(step)) {
    fluid.keep_weights = choice.keep_weights;  // the rows have them; only the operator asks
    system.assemble(fluid, dt);
  }

  SolverChoice solver;
  Fluid fluid;
  PressureSystem system;
  real dt;
  std::vector<double> assemble_ms;
};

struct Variant {
  Problem* problem;
  TimedSolver* solver;
  std::string name, guess;  // of the preconditioner, of the start
  double tolerance;
  std::vector<double> setup_ms = {}, solve_ms = {}, ms = {};
  SolveReport report = {};
  double residual = 0;  // |b - A p| / |b|, computed anew at the end
};

class Comparison {
 public:
  Comparison(const BenchOptions& options, const Scene& scene, const Fluid& fluid)
      : fluid_(fluid),
        p_(fluid.particles.pressure),
        previous_(uncleared<ScalarField>("greenwater::bench_previous", p_.extent(0))),
        work_(uncleared<ScalarField>("greenwater::bench_product", p_.extent(0))) {
    Kokkos::deep_copy(previous_, p_);
    const PressureOptions equation{
        .diagonal_factor = 1,
        .source_factor = static_cast<real>(scene.mps.relaxation_factor),
        .compressibility = static_cast<real>(scene.mps.compressibility),
        .source = options.source == "density" ? PressureSource::density : PressureSource::divergence};
    for (const SolverChoice& solver : chosen_solvers(options.solvers))
      problems_.push_back(std::make_unique<Problem>(fluid_, solver, equation, scene.mps.time_step));
    tolerances_ = options.tolerances.empty() ? std::vector{1e-4, 1e-6, 1e-8} : options.tolerances;
    for (const PreconditionerChoice& choice : chosen_preconditioners(options.preconditioners)) add(choice);
  }

  void run(int rounds) {
    warm_up();
    for (int round = 0; round < rounds; ++round) {
      for (auto& problem : problems_)
        problem->assemble_ms.push_back(ms_of([&] { problem->system.assemble(problem->fluid, problem->dt); }));
      for (Variant& variant : variants_) measure(variant);
    }
  }

  const std::vector<Variant>& variants() const { return variants_; }

  /// Time of A p [ms].
  Spread product(bool keep_weights, int rounds) {
    constexpr int at_least = 20;
    Fluid fluid = fluid_;
    fluid.keep_weights = keep_weights;
    PressureSystem system({});
    system.assemble(fluid, 1);
    system.apply(previous_, work_);
    std::vector<double> times;
    for (int k = 0; k < std::max(rounds, at_least); ++k)
      times.push_back(ms_of([&] { system.apply(previous_, work_); }));
    return spread_of(times);
  }

 private:
  void add(const PreconditionerChoice& choice) {
    for (auto& problem : problems_) {
      if (choice.only_kept && !problem->solver.keep_weights) continue;
      const std::size_t first = solvers_.size();
      for (const double tolerance : tolerances_)
        solvers_.push_back(choice.make({.tolerance = static_cast<real>(tolerance), .max_iterations = 20'000}));
      for (const char* guess : {"zero", "previous"})
        for (std::size_t k = 0; k < tolerances_.size(); ++k)
          variants_.push_back({problem.get(), solvers_[first + k].get(), choice.name, guess, tolerances_[k]});
    }
  }

  // All that is allocated at first use is, and the caches know the rows.
  void warm_up() {
    for (Variant& variant : variants_) {
      variant.solver->set_up(variant.problem->system);
      if (&variant == &variants_.front()) Kokkos::deep_copy(p_, previous_);
      variant.solver->solve(variant.problem->system, p_);  // from the solution before: short
    }
  }

  void measure(Variant& v) {
    const PressureSystem& system = v.problem->system;
    v.guess == "zero" ? Kokkos::deep_copy(p_, real(0)) : Kokkos::deep_copy(p_, previous_);
    v.setup_ms.push_back(ms_of([&] { v.solver->set_up(system); }));
    v.solve_ms.push_back(ms_of([&] { v.report = v.solver->solve(system, p_); }));
    v.ms.push_back(v.setup_ms.back() + v.solve_ms.back());
    v.residual = residual(system);
  }

  double residual(const PressureSystem& system) {
    const int count = system.count();
    system.apply(p_, work_);
    blas::axpby(1, system.rhs(), -1, work_, count);
    const double b = std::sqrt(blas::dot(system.rhs(), system.rhs(), count));
    return b > 0 ? std::sqrt(blas::dot(work_, work_, count)) / b : 0;
  }

  Fluid fluid_;
  ScalarField p_, previous_, work_;
  std::vector<double> tolerances_;
  std::vector<std::unique_ptr<Problem>> problems_;
  std::vector<std::unique_ptr<TimedSolver>> solvers_;
  std::vector<Variant> variants_;
};

// The variant that stands for 1: the first preconditioner, all else alike.
const Variant& yardstick(const std::vector<Variant>& all, const Variant& v) {
  for (const Variant& other : all)
    if (other.problem == v.problem && other.guess == v.guess && other.tolerance == v.tolerance) return other;
  return v;
}

Json variant_row(const Json& base, const std::vector<Variant>& all, const Variant& v) {
  const Spread ms = spread_of(v.ms);
  Json row = base;
  row["solver"] = v.problem->solver.name;
  row["preconditioner"] = v.name;
  row["guess"] = v.guess;
  row["tolerance"] = v.tolerance;
  row["iterations"] = v.report.iterations;
  add_spread(row, ms);
  row["setup_ms"] = spread_of(v.setup_ms).median;
  row["solve_ms"] = spread_of(v.solve_ms).median;
  row["assemble_ms"] = spread_of(v.problem->assemble_ms).median;
  row["ratio"] = ms.median / spread_of(yardstick(all, v).ms).median;
  row["ratio_to"] = yardstick(all, v).name;
  row["residual"] = v.residual;
  row["converged"] = v.report.converged;
  row["cause"] = std::string(v.report.cause);
  return row;
}

Json product_row(const Json& base, const Fluid& fluid, bool keep_weights, const Spread& ms, Triads& triads) {
  Counts counts;
  counts.dim = fluid.particles.dim;
  counts.particles = fluid.particles.count;
  counts.entries = static_cast<double>(fluid.rows.near.entries);
  counts.places = static_cast<double>(fluid.rows.near.stored);
  counts.image_entries = static_cast<double>(fluid.rows.images.entries);
  counts.image_places = static_cast<double>(fluid.rows.images.stored);
  counts.walls = fluid.walls.count > 0;
  const Traffic traffic = product_traffic(counts, keep_weights);
  triads.measure(traffic.touched);
  const double rate = 1e-6 * traffic.moved / ms.median, triad = triads.at(traffic.touched).median;
  Json row = base;
  row["weights"] = keep_weights ? "kept" : "recomputed";
  add_spread(row, ms);
  row["ns_per_entry"] = 1e6 * ms.median / (counts.entries + counts.image_entries);
  row["bytes"] = traffic.moved;
  row["gb_per_s"] = rate;
  row["triad_gb_per_s"] = triad;
  row["share"] = rate / triad;
  return row;
}

std::string cell(const Json& row, const char* key) { return figure(row[key].get<double>()); }

void print_head(const Json& base) {
  fmt::print("\n{} particles, {}-D, {}, cut by: {}\n", base["particles"].get<int>(), base["dim"].get<int>(),
             base["state"].get<std::string>(), base["plate"].get<std::string>());
  fmt::print("  {:<23}{:<13}{:<10}{:>8}{:>6}{:>10}{:>20}{:>10}{:>9}\n", "solver", "precond.", "guess", "to", "its",
             "ms", "min - max", "set-up", "ratio");
}

void print_row(const Json& row) {
  fmt::print("  {:<23}{:<13}{:<10}{:>8}{:>6}{:>10}{:>20}{:>10}{:>9}{}\n", row["solver"].get<std::string>(),
             row["preconditioner"].get<std::string>(), row["guess"].get<std::string>(),
             fmt::format("{:.0e}", row["tolerance"].get<double>()), row["iterations"].get<int>(), cell(row, "ms"),
             cell(row, "ms_min") + " - " + cell(row, "ms_max"), cell(row, "setup_ms"), cell(row, "ratio"),
             row["converged"].get<bool>() ? "" : "  stopped: " + row["cause"].get<std::string>());
}

void print_product(const Json& row) {
  fmt::print("  A p, weights {:<10} {} ms ({} - {}), {} ns per entry, {} GB/s, {:.0f} % of the triad's {}\n",
             row["weights"].get<std::string>(), cell(row, "ms"), cell(row, "ms_min"), cell(row, "ms_max"),
             cell(row, "ns_per_entry"), cell(row, "gb_per_s"), 100 * row["share"].get<double>(),
             cell(row, "triad_gb_per_s"));
}

struct Results {
  Json rows = Json::array(), products = Json::array();
  Triads triads;
};

void measure(const BenchOptions& options, const Size& size, const std::string& name, const std::string& plate,
             Results& to) {
  const State state = state_at(state_folder(options.cache), size, name);
  const Scene scene = bench_scene(size, options.sets);
  const Fluid fluid = before_pressure(scene, bench_scene(size, options.sets, plate), state);
  Json base = row_of(size, state.particles(), name);
  base["plate"] = plate;
  base["threads"] = Runtime::concurrency();
  print_head(base);
  Comparison comparison(options, scene, fluid);
  comparison.run(options.rounds);
  for (const Variant& variant : comparison.variants()) {
    to.rows.push_back(variant_row(base, comparison.variants(), variant));
    print_row(to.rows.back());
  }
  for (const bool keep : {true, false}) {
    to.products.push_back(product_row(base, fluid, keep, comparison.product(keep, options.rounds), to.triads));
    print_product(to.products.back());
  }
  std::fflush(stdout);
}

std::vector<std::string> or_else(const std::vector<std::string>& asked, const std::vector<std::string>& usual) {
  return asked.empty() ? usual : asked;
}

}  // namespace

Json bench_pressure(const BenchOptions& options) {
  Results to;
  const auto sizes = options.sizes.empty() ? usual_sizes(options.dimension, false) : options.sizes;
  for (const int particles : sizes)
    for (const std::string& state : or_else(options.states, {"rest", "collapse", "splash"}))
      for (const std::string& plate : or_else(options.plates, {"none", "plate", "barrier"}))
        measure(options, size_near(options.dimension, particles), state, plate, to);
  Json all = results("pressure", origin(options, Runtime::concurrency(), Runtime::space_name()));
  all["triad"] = triad_list(to.triads);
  all["rows"] = to.rows;
  all["products"] = to.products;
  return all;
}

}  // namespace greenwater::bench
