#pragma once
// The verb `bench`: what a step costs on this machine, and what of it the machine could have done.

#include "app/bench_options.hpp"

namespace greenwater {

/// Does what was asked and prints it; starts Kokkos itself. Returns the exit code; throws CaseError for a wrong option,
/// and whatever the solver throws.
int run_bench(const BenchOptions& options);

}  // namespace greenwater
