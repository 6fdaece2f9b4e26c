#pragma once
// Walls as something to be drawn: what goes to files, free of what the kernels make of it.

#include <array>
#include <vector>

namespace greenwater {

/// x, y, z of the corners of a wall [m]; z = 0 in 2-D. Two are the ends of a line, three or more go round a polygon.
using WallShape = std::vector<std::array<double, 3>>;

}  // namespace greenwater
