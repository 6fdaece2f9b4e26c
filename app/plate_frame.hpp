#pragma once
// A plate in space.

#include "app/scene.hpp"

namespace greenwater {

/// The plate's axes: along its height; to the right of it, through its thickness; in 3-D over its width. And its corner
/// at the foot, on the left, in front.
struct PlateFrame {
  Point up, right, over, corner;
};
PlateFrame frame_of(const PlateCase& plate, int dimension);

bool inside_plate(const PlateCase& plate, const Point& x, int dimension);

}  // namespace greenwater
