#pragma once
// Where the particles are at the start.

#include <vector>

#include "app/scene.hpp"

namespace greenwater {

/// Cell centres of the lattice in the fluid's box or ball, or in the inside of a geometry below the level; not in plates. In an
/// inside that the lattice does not fit to there are as many as have room by volume, and they still have to be spread:
/// see needs_spreading(). With the fluid's jitter, where it has one: the same at every call and on every machine. Throws
/// CaseError when there is none.
std::vector<Point> fill(const Scene& scene);

/// Whether the fluid fills the inside of something other than a box.
bool needs_spreading(const Scene& scene);

}  // namespace greenwater
