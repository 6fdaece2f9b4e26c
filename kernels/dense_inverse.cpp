#include "kernels/dense_inverse.hpp"

#include <Eigen/Dense>

namespace greenwater {

void invert_in_place(double* A, int size) {
  if (size == 0) return;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, largest_dense, largest_dense>;
  Eigen::Map<Matrix> there(A, size, size);
  const Matrix symmetric = 0.5 * (there + there.transpose());
  for (const double relative : {1e-5, 1e-2}) {
    Matrix held = symmetric;
    held.diagonal() *= 1 + relative;
    const Eigen::LLT<Matrix> factors(held);
    if (factors.info() != Eigen::Success) continue;
    there = factors.solve(Matrix::Identity(size, size));
    return;
  }
  there.setZero();
  there.diagonal() = symmetric.diagonal().cwiseInverse();
}

}  // namespace greenwater
