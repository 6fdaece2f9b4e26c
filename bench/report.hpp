#pragma once
// Results: JSON with its origin, and tables for people.

#include <nlohmann/json.hpp>
#include <string>

#include "app/bench_options.hpp"
#include "bench/scenes.hpp"
#include "bench/triad.hpp"

namespace greenwater::bench {

using Json = nlohmann::ordered_json;

/// Where figures come from: git, Kokkos, flags, back-end, host, processor, threads, date, environment. Kokkos need not
/// run: `threads` and `backend` are then those that the caller knows.
Json origin(const BenchOptions& options, int threads, const std::string& backend);

/// The frame of a result file; `kind` is the verb.
Json results(const std::string& kind, const Json& origin);

/// ms, ms_min, ms_max, ms_q1, ms_q3
void add_spread(Json& row, const Spread& ms);

/// case, dim, particles, state
Json row_of(const Size& size, int particles, const std::string& state);

/// The triads as a list of {bytes, gb_per_s, gb_per_s_min, gb_per_s_max}.
Json triad_list(const Triads& triads);

/// Writes --json, if it was asked for. Throws FileError.
void write_results(const BenchOptions& options, const Json& all);

/// Number with three figures, for tables: 0.0123, 1.23, 12.3, 123, 12345.
std::string figure(double value);

}  // namespace greenwater::bench
