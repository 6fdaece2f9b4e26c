#pragma once
// Where the particles are at the start.

#include <vector>

#include "app/scene.hpp"

namespace greenwater {

/// Cell centres of the lattice in the fluid's box or ball, not in solids (see Room), with the fluid's jitter, where it has
/// one: the same at every call and on every machine. With packing "relaxed" as many places as have room by volume; they
/// still have to be spread, and to be shaken after that. Throws CaseError when there is none.
std::vector<Point> fill(const Scene& scene);

}  // namespace greenwater
