#pragma once
// Walls as faces, on the host: straight segments in 2-D. Fluid may be on either side of a face, or on both.

#include <array>
#include <string>
#include <vector>

#include "core/real.hpp"

namespace greenwater {

struct WallFace {
  std::array<std::array<coord, 3>, 2> end;  // end points [m]; z = 0 in 2-D
  std::array<coord, 3> velocity{};          // of the whole face over the step [m/s]
  std::array<coord, 3> acceleration{};      // [m/s^2]
  int body = 0;                             // which named geometry it belongs to
};

struct WallFaces {
  std::vector<WallFace> faces;
  std::vector<std::string> bodies;  // names of the geometries, as in the case file
};

/// Faces on one line that touch or overlap become one, so that nobody has two images there (only faces of equal motion;
/// the longer piece gives the body's name). `tolerance` is a length [m] far below the particle distance.
void merge_collinear(WallFaces& walls, coord tolerance);

}  // namespace greenwater
