#include "kernels/dense_inverse.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

void subtract(double factor, const double* from, double* to, int count) {
  if (factor == 0) return;
  for (int c = 0; c < count; ++c) to[c] -= factor * from[c];
}

void divide(double divisor, double* row, int count) {
  const double factor = 1 / divisor;
  for (int c = 0; c < count; ++c) row[c] *= factor;
}

}  // namespace

// A + added = U^T U; false where A is not positive. All loops run along rows, so that they are vectors.
bool DenseInverse::factor(const double* A, int size, double added) {
  end_.assign(size, 0);
  U_.assign(A, A + size * size);
  for (int k = 0; k < size; ++k) {
    double* row = &U_[k * size];
    row[k] += added;
    int& end = end_[k] = size;
    while (end > k + 1 && row[end - 1] == 0) --end;
    if (k > 0) end = std::max(end, end_[k - 1]);
    if (!(row[k] > 0)) return false;
    divide(std::sqrt(row[k]), row + k, end - k);
    for (int i = k + 1; i < end; ++i) subtract(row[i], row + i, &U_[i * size + i], end - i);
  }
  return true;
}

// U^T X = 1, then U X = X, and only the lower half: the upper one mirrors it.
void DenseInverse::invert_factors(double* X, int size) const {
  std::fill(X, X + size * size, 0.0);
  for (int k = 0; k < size; ++k) {
    const double* factors = &U_[k * size];
    double* row = X + k * size;
    row[k] = 1;
    divide(factors[k], row, k + 1);
    for (int i = k + 1; i < end_[k]; ++i) subtract(factors[i], row, X + i * size, k + 1);
  }
  for (int k = size - 1; k >= 0; --k) {
    const double* factors = &U_[k * size];
    double* row = X + k * size;
    for (int i = k + 1; i < end_[k]; ++i) subtract(factors[i], X + i * size, row, k + 1);
    divide(factors[k], row, k + 1);
  }
  for (int i = 0; i < size; ++i)
    for (int c = 0; c < i; ++c) X[c * size + i] = X[i * size + c];
}

void DenseInverse::invert(double* A, int size) {
  double most = 0;
  for (int i = 0; i < size; ++i) {
    most = std::max(most, A[i * size + i]);
    for (int j = 0; j < i; ++j) A[j * size + i] = 0.5 * (A[i * size + j] + A[j * size + i]);
  }
  // Something for all, in measure of the largest: rows that are next to nothing would have huge inverses, which do not fit
  // into a float.
  for (const double relative : {2e-4, 1e-2})
    if (factor(A, size, relative * most)) return invert_factors(A, size);
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) A[i * size + j] = i == j ? 1 / A[i * size + i] : 0;
}

}  // namespace greenwater
