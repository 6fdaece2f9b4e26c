#pragma once
// Reading the fluid: at points, on walls, over all of it. Nothing here changes it.

#include <array>
#include <optional>
#include <vector>

#include "kernels/point_sampler.hpp"

namespace greenwater {

/// A piece of wall that takes pressure from both sides.
struct WallPatch {
  std::array<coord, 3> centre;  // [m]
  std::array<coord, 3> normal;  // unit; from side 2 to side 1
  double area = 0;              // [m] in 2-D (per metre of depth), [m^2] in 3-D
};

/// Cuts the faces of one body into patches no longer than `length`.
std::vector<WallPatch> wall_patches(const WallFaces& walls, int body, coord length);

/// Force of the water on the patches [N/m] in 2-D, [N] in 3-D: sum of (p_2 - p_1) normal area, the pressures read just
/// off each side.
std::array<double, 3> wall_force(PointSampler& sampler, const Fluid& fluid, const std::vector<WallPatch>& patches,
                                 Reading reading);

/// Furthest wet x: highest x of a particle that touches others, and half a spacing [m]; the lowest number there is when
/// no particle does.
double wave_front(const Fluid& fluid);

/// Height of the surface at x: the highest particle of the column of one spacing's width around x (in 3-D and around y,
/// where that is given), and half a spacing [m]; in 2-D along y, in 3-D along z. The lowest number there is over an empty
/// column.
double surface_height(const Fluid& fluid, coord x, std::optional<coord> y = {});

/// Particles in a box.
std::int64_t particle_count(const Fluid& fluid, const std::array<coord, 3>& low, const std::array<coord, 3>& high);

/// Sums over the fluid.
struct FluidSums {
  double kinetic = 0;        // [J/m] in 2-D, [J] in 3-D
  double potential = 0;      // [J/m]; above `reference`, the point that has none
  double max_speed = 0;      // [m/s]; not a number when any speed is not
  double density_error = 0;  // root mean square of n / n^0 - 1 where no surface is [-]

  double energy() const { return kinetic + potential; }
};
FluidSums fluid_sums(const Fluid& fluid, const std::array<coord, 3>& reference);

}  // namespace greenwater
