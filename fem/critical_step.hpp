#pragma once
// The longest step that explicit time integration of a structure may take.

#include <Eigen/Dense>

#include "fem/solid.hpp"
#include "fem/supports.hpp"

namespace greenwater {

/// An upper estimate of the highest natural angular frequency at u [rad/s], within 1e-3: Lanczos' method on M^-1 K, whose
/// value lies below the true one, plus the bound of its residual. 0 when nothing is free to move. Throws
/// NumericsError when stiffness over mass is not a finite number.
double highest_frequency(const Solid& solid, const Supports& supports, const Eigen::VectorXd& u);
double highest_frequency(const Solid& solid, const Supports& supports);

/// 2 / omega_max [s], where central differences become unstable; infinite when nothing is free to move.
double critical_step(const Solid& solid, const Supports& supports);

}  // namespace greenwater
