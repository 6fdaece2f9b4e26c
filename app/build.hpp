#pragma once
// From the typed case to fields, walls, effects and schemes: the only place that maps words to classes.

#include "app/scene.hpp"
#include "app/scheme.hpp"

namespace greenwater {

/// All faces of the scene's geometries, with their names; stretches that lie on one line and touch are one face.
WallFaces build_walls(const Scene& scene);

/// Particles on the lattice inside the fluid's region (not inside plates), walls, grid, weights; rows built.
/// Throws CaseError when there is no particle or not the expected number of them.
Fluid build_fluid(const Scene& scene, const WallFaces& walls);

/// Just the effects that the scene names.
Effects build_effects(const Scene& scene);

std::unique_ptr<Scheme> build_scheme(const Scene& scene);

/// Where the pressure probe reads: its point, or, of a point on a wall, the place just off that wall on the side that the
/// probe faces; a box faces its inside by itself. Throws CaseError on any other wall when the case does not say.
Point pressure_point(const Scene& scene, const WallFaces& walls, const ProbeCase& probe);

/// Lowest and highest corner of walls and fluid [m].
struct Extent {
  Point low, high;
};
Extent scene_extent(const Scene& scene, const WallFaces& walls);

}  // namespace greenwater
