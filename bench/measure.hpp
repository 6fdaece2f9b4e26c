#pragma once
// The measurements; each prints its tables and returns its results as JSON.

#include "bench/report.hpp"

namespace greenwater::bench {

/// The whole step by region. Kokkos must be initialised.
Json bench_step(const BenchOptions& options);

/// The pressure solve in all its variants. Kokkos must be initialised.
Json bench_pressure(const BenchOptions& options);

/// A structure's substep against plain products of its elements' matrices. Kokkos must be initialised.
Json bench_fem(const BenchOptions& options);

/// The whole step over sizes and threads. Starts this program again for each of them, as Kokkos starts once in a process,
/// and must not be initialised here. Throws ResourceError when one of them fails.
Json bench_scaling(const BenchOptions& options);

}  // namespace greenwater::bench
