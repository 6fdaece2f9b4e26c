#pragma once
// What a case will cost, by arithmetic alone: nothing is allocated for it.

#include <string>
#include <vector>

#include "app/scene.hpp"

namespace greenwater {

struct Plan {
  double particles = 0, steps = 0, frames = 0;  // as double: a wrong spacing must not overflow them
  bool at_most = false;                         // the count is that of the bounds of what is filled
  bool at_least = false;                        // the steps are those of water at rest, and adapt
  double memory = 0;                            // [bytes], estimated
  double disk = 0;                              // [bytes], estimated
  double cfl = 0;                               // of the front of a collapse, 2 sqrt(g H) dt / spacing [-]
  std::vector<std::string> warnings;
};

/// The cells of the fluid's lattice along x, y, z, in its bounds; their product is the particle count, where the region is
/// a box.
std::array<double, 3> lattice_cells(const FluidCase& fluid, double spacing, int dimension);

/// How many particle distances the front of a collapse runs in one step: 2 sqrt(g H) dt / spacing; not more than mps.courant
/// where steps adapt.
double front_cfl(const Scene& scene);

Plan plan_of(const Scene& scene);

/// Throws ResourceError when the plan does not fit into `memory` [bytes], or into the program's own counters.
void require_memory(const Plan& plan, double memory, const Scene& scene);

/// The plan for people.
std::vector<std::string> plan_lines(const Plan& plan, const Scene& scene);

}  // namespace greenwater
