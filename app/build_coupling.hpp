#pragma once
// Structures in a fluid: their wet surfaces as walls, and what couples them.

#include "app/structure.hpp"
#include "coupling/coupler.hpp"

namespace greenwater {

/// The structures of the scene, in substeps that make up the fluid's step (where that adapts, its longest one; then all of
/// them have the same substep).
std::vector<Structure> build_structures(const Scene& scene);

/// Adds the wet surfaces of the structures to the walls, where the structures are now, each as a body of its name.
/// Throws CaseError when a structure has none that fits the fluid.
std::vector<WetSurface> add_wet_surfaces(const Scene& scene, const std::vector<Structure>& structures,
                                         WallFaces& walls);

/// Couples them; the structures must outlive it, and stay where they are in memory.
Coupler build_coupler(const Scene& scene, std::vector<Structure>& structures, std::vector<WetSurface> surfaces,
                      const WallFaces& walls);

/// How they are coupled and, of plates, what the added mass will be, for people.
std::vector<std::string> coupling_lines(const Scene& scene);

/// The stretch of a plate that a structure_pressure probe looks at: two particle distances around its height, moved up or
/// down to lie on the plate, or all of it when it is shorter.
PlateBand band_of(const Scene& scene, const ProbeCase& probe);

}  // namespace greenwater
