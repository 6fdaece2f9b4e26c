#pragma once
// Walls for a while, where the fluid of the start ends without one: they keep particles together while they are spread.

#include "app/scene.hpp"
#include "core/wall_faces.hpp"

namespace greenwater {

/// The walls and, as one more body "rim", what closes the fluid's region: the parts of a box's sides on which no wall
/// lies and that are in no solid; a lid on an inside; a ball as a polygon of sides no longer than a spacing, in 3-D of
/// triangles no longer than two, with the ball's own measure. Where space repeats itself, the rim goes on with it.
WallFaces with_rim(const Scene& scene, const WallFaces& walls);

}  // namespace greenwater
