#include "app/plate_frame.hpp"

#include <cmath>

namespace greenwater {

PlateFrame frame_of(const PlateCase& plate, int dimension) {
  const double s = std::sin(plate.angle), c = std::cos(plate.angle);
  PlateFrame frame{{s, c, 0}, {c, -s, 0}, {0, 0, 0}, plate.base};
  if (dimension == 3) frame = {{s, 0, c}, {c, 0, -s}, {0, 1, 0}, plate.base};
  const double back = plate.base_side == "upstream" ? 0
                      : plate.base_side == "centre" ? plate.thickness / 2
                                                    : plate.thickness;
  for (int d = 0; d < dimension; ++d) frame.corner[d] -= back * frame.right[d] + plate.width / 2 * frame.over[d];
  return frame;
}

bool inside_plate(const PlateCase& plate, const Point& x, int dimension) {
  const PlateFrame frame = frame_of(plate, dimension);
  double up = 0, right = 0, over = 0;
  for (int d = 0; d < dimension; ++d) {
    up += (x[d] - frame.corner[d]) * frame.up[d];
    right += (x[d] - frame.corner[d]) * frame.right[d];
    over += (x[d] - frame.corner[d]) * frame.over[d];
  }
  return up >= 0 && up <= plate.height && right >= 0 && right <= plate.thickness && over >= 0 && over <= plate.width;
}

}  // namespace greenwater
