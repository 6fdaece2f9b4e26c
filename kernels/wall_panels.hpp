#pragma once
// From faces to panels, corners and mirrors, on the host.

#include <vector>

#include "kernels/mirror_wall.hpp"

namespace greenwater {

struct WallPanels {
  std::vector<Panel> panels;
  std::vector<Piece> pieces;  // of panel p: first_piece ... last_piece - 1
  std::vector<Rim> rims;      // of panel p: first_rim ... last_rim - 1
  std::vector<Joint> joints;
  std::vector<int> joint_of_panel;  // of panel p: first_joint ... last_joint - 1
  std::vector<Mirror> mirrors;      // those of the panels first, then corners
};

/// Faces that lie in one plane, touch, and move alike become one panel; two panels that touch make a corner: right-angled
/// ones with one image more, others with a joint and as many reflections as fit. In 3-D also the corners of three panels
/// of which one stands at right angles to the others. `tolerance`: a length far below the particle distance [m].
/// Throws CaseError when two panels meet at less than 5 degrees.
WallPanels find_panels(const WallFaces& faces, coord tolerance);

}  // namespace greenwater
