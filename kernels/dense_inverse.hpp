#pragma once
// The inverse of a small matrix, on the host.

namespace greenwater {

constexpr int largest_dense = 128;

/// The inverse of the symmetric matrix A(row, column) of `size` rows, which should be positive definite, in its place.
/// What little is added to its diagonal (2e-4 of the largest entry) keeps rounding from making it singular where only
/// compressibility holds a cluster of particles, and its inverse within the range of a float; where that is not enough, more.
void invert_in_place(double* A, int size);

}  // namespace greenwater
