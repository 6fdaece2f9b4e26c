#pragma once
// From the typed case to fields, walls, effects and schemes: the only place that maps words to classes.

#include "app/build_walls.hpp"
#include "app/motion.hpp"
#include "app/scheme.hpp"
#include "kernels/packing.hpp"

namespace greenwater {

/// Particles on the lattice inside the fluid's region (not inside solids), or spread evenly in it, walls, grid, weights;
/// rows built. What spreading has done goes to `packing`. Throws CaseError when there is no particle or not the expected
/// number of them.
Fluid build_fluid(const Scene& scene, const WallFaces& walls, Packing* packing = nullptr);

/// Just the effects that the scene names; what they hold in the fluid is there from now on.
Effects build_effects(const Scene& scene, Fluid& fluid);

std::unique_ptr<Scheme> build_scheme(const Scene& scene, const Fluid& fluid);

/// Where the pressure probe reads: its point, or, of a point on a wall, the place just off that wall on the side that the
/// probe faces; a box faces its inside by itself. Throws CaseError on any other wall when the case does not say.
Point pressure_point(const Scene& scene, const WallFaces& walls, const ProbeCase& probe);

/// The motion with which a pressure probe goes: that of the wall its point is on; null when none moves it.
std::unique_ptr<Motion> motion_of(const Scene& scene, const WallFaces& walls, const ProbeCase& probe);

}  // namespace greenwater
