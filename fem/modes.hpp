#pragma once
// The lowest natural frequencies of a structure and its shapes in them.

#include <Eigen/Dense>

#include "fem/solid.hpp"
#include "fem/supports.hpp"

namespace greenwater {

struct Modes {
  Eigen::VectorXd frequencies;  // [Hz], ascending; 0 for motions of a rigid body
  Eigen::MatrixXd shapes;       // a column for each, with shape.M.shape = 1 kg
};

/// The lowest modes of K - omega^2 M with K the tangent at u, by Lanczos' method with blocks on the inverse of K; at an
/// unstable u those nearest to zero, with frequency 0 where omega^2 is negative. Throws NumericsError when it does not
/// converge.
Modes lowest_modes(const Solid& solid, const Supports& supports, int count, const Eigen::VectorXd& u);
Modes lowest_modes(const Solid& solid, const Supports& supports, int count);

/// The part of a shape's kinetic energy that is motion along an axis: tells bending from sideways and axial modes.
double share_along(const Solid& solid, const Eigen::VectorXd& shape, int axis);

}  // namespace greenwater
