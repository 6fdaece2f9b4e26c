#pragma once
// Loads on a wet surface: from pressures that are read on it, and as pressures for people.

#include "coupling/wet_surface.hpp"
#include "kernels/point_sampler.hpp"

namespace greenwater {

/// Forces on the corners [N/m], in 3-D [N], of the pressure on the fluid's side of each face as it stands now: read at
/// places not farther apart than the particles, and shared out by the shape functions with which the corners' velocities
/// make that of a place.
Eigen::VectorXd read_loads(PointSampler& sampler, const Fluid& fluid, const WetSurface& surface, int first_face,
                           Reading reading);

/// A stretch of a plate, between two heights, with its two faces.
struct PlateBand {
  std::array<double, 3> foot{}, up{},
      across{};              // [m]; unit vectors along the height and from its left face to the right
  double low = 0, high = 0;  // [m] above the foot
};

/// The pressure difference over a plate in a band [Pa]: force of the left face less that of the right one, along `across`,
/// each over the area of the band. `faces` are those of the surface at rest. Corners that the band cuts count in part.
double pressure_difference(const WetSurface& surface, const Eigen::VectorXd& on_corners, const PlateBand& band);

}  // namespace greenwater
