#pragma once
// Solution of a few symmetric equations, in any of the numbers of fem/pack.hpp.

namespace greenwater::element {

/// b = A^-1 b by A = L D L^T, without pivots, so for a definite A, of which the lower half is read and lost.
template <int N, class T>
void solve_symmetric(T (&a)[N][N], T (&b)[N]) {
  for (int j = 0; j < N; ++j) {
    const T inverse = 1.0 / a[j][j];
    for (int i = j + 1; i < N; ++i) {
      const T factor = a[i][j] * inverse;
      for (int k = i; k < N; ++k) a[k][i] -= factor * a[k][j];
      b[i] -= factor * b[j];
    }
  }
  for (int j = N - 1; j >= 0; --j) {
    for (int i = j + 1; i < N; ++i) b[j] -= a[i][j] * b[i];
    b[j] = b[j] / a[j][j];
  }
}

}  // namespace greenwater::element
