#pragma once
// Where particles are before they are spread: as many as have room, in about the right places.

#include <vector>

#include "app/room.hpp"

namespace greenwater {

/// So many places in the room as its measure over that of a particle, to the nearest number: those of a lattice that is
/// stretched to the region's bounds, with as few taken out (beside edges that cut the lattice, else far apart from each
/// other) or put in (into the largest gaps) as can be. None of them is just on a wall that a lattice plane is on: all are
/// shifted a little, by up to 1e-5 spacings.
std::vector<Point> relaxed_start(const Room& room, const Scene& scene);

}  // namespace greenwater
