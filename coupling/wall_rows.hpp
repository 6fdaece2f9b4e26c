#pragma once
// How the pressure of particles pushes the corners of wet surfaces.

#include "coupling/wet_surface.hpp"
#include "kernels/added_term.hpp"
#include "kernels/reaction.hpp"

namespace greenwater {

/// One force per pressure [m], in 3-D [m^2], for each particle and unknown that it pushes: number first_unknown + dim
/// corner + d. A push is shared out to the corners of its face by the shape functions with which their velocities make
/// that of its place. `first_face`: of the surface's faces among all walls. In the order of the particles.
void add_wall_rows(const std::vector<WallPush>& pushes, const WallFaces& walls, const WetSurface& surface,
                   int first_face, int first_unknown, std::vector<AddedEntry>& rows);

/// The shares of the corners at a place of a segment (2-D) or triangle; their sum is 1.
std::array<double, 3> shares_at(const WallFace& face, int dim, const std::array<double, 3>& place);

}  // namespace greenwater
