#pragma once
// Where panels touch, and the mirrors that come of it.

#include "kernels/wall_geometry.hpp"

namespace greenwater {

/// To panels and their pieces adds the joints, and the mirrors: of each panel, and of each corner. `bounds`: of each
/// panel. Throws CaseError when two panels meet at less than 5 degrees.
void add_mirrors(const WallFaces& walls, const std::vector<wall_geometry::Bounds>& bounds, coord tolerance,
                 WallPanels& made);

}  // namespace greenwater
