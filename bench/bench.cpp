#include "bench/bench.hpp"

#include "bench/measure.hpp"
#include "bench/water.hpp"
#include "core/kokkos.hpp"

namespace greenwater {
namespace {

using What = BenchOptions::What;

// Wrong names are complained about before any work.
void check(const BenchOptions& options) {
  for (const std::string& state : options.states) bench::time_of_state(state);
  for (const std::string& plate : options.plates) bench::scene_text(bench::size_near(options.dimension, 1000), plate);
  bench::chosen_preconditioners(options.preconditioners);
  bench::chosen_solvers(options.solvers);
  require(options.what == What::scaling || options.threads.size() < 2,
          "bench: error: --threads: only bench scaling takes several numbers of threads");
  require(options.what == What::pressure || options.tolerances.size() < 2,
          "bench: error: --tolerance: only bench pressure takes several");
}

void make_states(const BenchOptions& options) {
  const auto folder = bench::state_folder(options.cache);
  const auto sizes = options.sizes.empty() ? bench::usual_sizes(options.dimension, false) : options.sizes;
  const auto names = options.states.empty() ? std::vector<std::string>{"rest", "collapse", "splash"} : options.states;
  for (const int particles : sizes) bench::make_states(folder, bench::size_near(options.dimension, particles), names);
}

}  // namespace

int run_bench(const BenchOptions& options) {
  check(options);
  if (options.what == What::scaling) {
    bench::write_results(options, bench::bench_scaling(options));
    return 0;
  }
  const Runtime runtime(options.threads.empty() ? 0 : options.threads.front());
  switch (options.what) {
    case What::states: make_states(options); break;
    case What::step: bench::write_results(options, bench::bench_step(options)); break;
    case What::pressure: bench::write_results(options, bench::bench_pressure(options)); break;
    case What::fem: bench::write_results(options, bench::bench_fem(options)); break;
    case What::scaling: break;
  }
  return 0;
}

}  // namespace greenwater
