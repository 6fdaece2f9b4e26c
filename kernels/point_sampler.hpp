#pragma once
// Pressure at points, in the fluid and on walls.

#include <array>
#include <vector>

#include "kernels/fluid.hpp"

namespace greenwater {

/// How a pressure is read from the particles in sight of a point, weighted with w of the gradient's radius:
///   average  their mean, as the paper reads its loads (section 2.3, step 4): that of a place some 0.8 l0 off the wall
///   neumann  the value at the point of the pressure that varies linearly along the wall and fits them best; off the wall
///            it goes with the wall's condition dp/dn = rho (g - a_w) . n. In the open fluid: linear in all directions.
enum class Reading { average, neumann };

class PointSampler {
 public:
  /// [Pa]; 0 where no particle is in sight. Uses the last sort's cells. A point within a twentieth of l0 of a wall is on
  /// it; where walls meet at right angles, on all of them.
  std::vector<double> pressure(const Fluid& fluid, const std::vector<std::array<coord, 3>>& points, Reading reading);

 private:
  CoordField point_;
  ScalarField value_;
  CoordField::host_mirror_type point_host_;
  ScalarField::host_mirror_type value_host_;
};

}  // namespace greenwater
