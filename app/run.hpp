#pragma once
// A run from its first step to its marker.

#include "app/command_line.hpp"
#include "app/scene.hpp"

namespace greenwater {

/// Builds the simulation, makes the run folder and steps to the end, to --max-steps, to a signal or to a failure.
/// Returns the exit code: 0 finished, 3 numbers failed, 4 file error, 5 out of memory, 75 stopped by a signal; the
/// reason stands in run.log, and on stderr when it is an error. Errors before the folder is made are thrown.
/// Kokkos must be initialised.
int run_case(const RunOptions& options, const Scene& scene, const CaseFile& file);

}  // namespace greenwater
