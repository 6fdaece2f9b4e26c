#include "kernels/dense_inverse.hpp"

#include <Eigen/Dense>

namespace greenwater {

void invert_in_place(double* A, int size) {
  if (size == 0) return;
  using Matrix = Eigen::MatrixXd;
  Eigen::Map<Matrix> there(A, size, size);
  const Matrix symmetric = 0.5 * (there + there.transpose());
  // Something for all, in measure of the largest: rows that are next to nothing would have huge inverses, which do not fit
  // into a float.
  for (const double relative : {2e-4, 1e-2}) {
    Matrix held = symmetric;
    held.diagonal().array() += relative * symmetric.diagonal().maxCoeff();
    const Eigen::LLT<Matrix> factors(held);
    if (factors.info() != Eigen::Success) continue;
    there = factors.solve(Matrix::Identity(size, size));
    return;
  }
  there.setZero();
  there.diagonal() = symmetric.diagonal().cwiseInverse();
}

}  // namespace greenwater
