#pragma once
// What a structure answers to a load that is held over one step of the fluid.

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "fem/march.hpp"

namespace greenwater {

/// A = P^T U, with a column of U [m/N] for each column of P: the displacement after `steps` steps from rest under that
/// column of P as held load (unknowns x m) [N]. Of the structure in small displacement about its shape at rest, from the
/// steps of March themselves, so with half of the load in the first. Each mode has
///   (1 - cos(n theta)) / (m omega^2) >= 0,  2 sin(theta/2) = omega h,
/// without damping, at any omega h below 2; the whole load in the first step would make stiff modes answer against it.
/// A is symmetric, and positive semi-definite.
Eigen::MatrixXd held_load_answer(const Solid& solid, const Supports& supports, const Eigen::SparseMatrix<double>& p,
                                 const MarchOptions& options, int steps);

}  // namespace greenwater
