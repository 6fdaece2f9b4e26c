#pragma once
// From the geometries of the case to walls as faces, and how they move.

#include "app/scene.hpp"
#include "core/wall_faces.hpp"
#include "kernels/effects/effect.hpp"

namespace greenwater {

/// All faces of the scene's geometries, with their names.
WallFaces build_walls(const Scene& scene);

/// Beyond the edges of a domain that repeats itself along this axis walls go on: adds copies of the faces from
/// `first_face` on that come within reach of it.
void repeat_walls(WallFaces& walls, const Scene& scene, int axis, std::size_t first_face);

/// How the scene's walls move; empty when they all stand.
WallMotion build_motion(const Scene& scene);

/// Lowest and highest corner of walls, wherever they go, and fluid [m].
struct Extent {
  Point low, high;
};
Extent scene_extent(const Scene& scene, WallFaces walls);

/// Whether a box closes the scene at this low (0) or high (1) end of an axis, at `at` [m].
bool closed_at(const Scene& scene, int axis, int end, double at);

}  // namespace greenwater
