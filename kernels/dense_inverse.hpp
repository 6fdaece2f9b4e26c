#pragma once
// The inverse of a small matrix, on the host.

#include <vector>

namespace greenwater {

/// By Cholesky's factors, whose rows end with the last entry that is not zero: where unknowns are numbered line by line of
/// a grid that is soon, and this takes a fraction of what a general inverse does.
class DenseInverse {
 public:
  /// Puts the inverse of the symmetric matrix A(row, column) of `size` rows, which should be positive definite, in its
  /// place, symmetric to the last bit. What little is added to its diagonal (2e-4 of the largest entry) keeps rounding from
  /// making it singular where only compressibility holds a cluster of particles, and its inverse within the range of a
  /// float; where that is not enough, more.
  void invert(double* A, int size);

 private:
  bool factor(const double* A, int size, double added);
  void invert_factors(double* X, int size) const;

  std::vector<int> end_;   // (row) column behind the last entry that may not be zero
  std::vector<double> U_;  // (row, column)
};

}  // namespace greenwater
