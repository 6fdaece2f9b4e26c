#pragma once
// How the pressure of each particle pushes the walls that it has images in. D is how a wall's normal velocity enters the
// divergence of the survey, by way of images; its transpose times V = l0^d is a force per pressure, so that both do the
// same work. The entries of one particle and one panel stand together in one push, at their mean place: the velocity of
// a panel is linear along it, so that nothing of its work is lost.
//
// Positions and rows must be those of the survey, which must have kept its divergence_correction.

#include <vector>

#include "core/point_math.hpp"
#include "kernels/survey.hpp"

namespace greenwater {

struct WallPush {
  int particle = 0;
  int face = 0;            // one of the panel's faces: in its plane, and its velocity is that of the panel
  Triple place{};          // of the panel's plane, where the paths to the images are thrown back [m]
  Triple normal{};         // unit, into the wall
  double area = 0;         // force per pressure along the normal [m], in 3-D [m^2]; below 0 in a bad neighbourhood only
  Triple from_particle{};  // place - x_i [m]
  Triple flow{};           // velocity of the particle [m/s]
  double flow_gradient[3][3] = {};  // (d, e) du_d / dx_e, of neighbours alone: exact for a linear flow [1/s]
  Triple drive{};                   // g and body force of the particle [m/s^2]
};

/// All pushes on a body, in the order of the particles as they are sorted now. A wall that moves with v at the place changes
/// the divergence of the particle by area (normal . v) / V.
std::vector<WallPush> wall_pushes(const Fluid& fluid, const Survey& survey, int body);

/// Velocity of the fluid over a point of the wall, x_q - x_i from the particle; beside it to first order, as in a rotation, and
/// along the normal as the particle has it: a difference to the second row, carried on to the wall, would be as large as that
/// row is out of step, and more the farther the first one is from the wall, which no solve takes back.
inline Triple flow_at(const WallPush& push, const Triple& from_particle) {
  Triple u = push.flow;
  const Triple way = sum(from_particle, scaled(push.normal, -dot(from_particle, push.normal)));
  for (int d = 0; d < 3; ++d)
    for (int e = 0; e < 3; ++e) u[d] += push.flow_gradient[d][e] * way[e];
  return u;
}

}  // namespace greenwater
