#pragma once
// How the pressure of particles pushes the corners of wet surfaces.

#include "coupling/wet_surface.hpp"
#include "kernels/added_term.hpp"
#include "kernels/operators/wall_quadrature.hpp"

namespace greenwater {

/// The places of a wet surface, whose faces stand among all walls from `first_face` on.
WallQuadrature quadrature_of(const WetSurface& surface, const WallFaces& walls, int first_face, const GridShape& grid,
                             double spacing);

/// D^T V: one force per pressure [m], in 3-D [m^2], for each particle and unknown that it pushes: number first_unknown + dim
/// corner + d. What acts at a place is shared out to the corners of its face by the shape functions with which their
/// velocities make that of the place. In the order of the particles.
void add_wall_rows(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature, const WetSurface& surface,
                   int dim, int first_face, int first_unknown, std::vector<AddedEntry>& rows);

/// The pressure at the places is that of the particles that push there and rho (g - a) . (x_q - x_i), a the acceleration of
/// the wall. The part of g, as forces on the corners [N/m], in 3-D [N]: known before the pressure is.
Eigen::VectorXd known_load(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature,
                           const WetSurface& surface, int dim, int first_face, double rho);

/// The part of a is that of a mass that goes with the wall, the fluid between it and the first particles:
///   M_ab = rho sum_kq W_kq N_a(x_q) N_b(x_q) |n_q . (x_q - x_i)| n_q n_q^T   [kg/m], in 3-D [kg]
/// for all unknowns of the surface; symmetric, positive semi-definite.
Eigen::SparseMatrix<double> layer_mass(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature,
                                       const WetSurface& surface, int dim, int first_face, double rho);

}  // namespace greenwater
