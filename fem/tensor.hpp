#pragma once
// Small tensors of any of the numbers of fem/pack.hpp.

#include "fem/pack.hpp"

namespace greenwater::element {

template <int Dim, class T>
struct Tensor {
  T m[Dim][Dim] = {};
  T& operator()(int i, int j) { return m[i][j]; }
  const T& operator()(int i, int j) const { return m[i][j]; }
};

template <int Dim, class T>
Tensor<Dim, T> identity() {
  Tensor<Dim, T> t;
  for (int d = 0; d < Dim; ++d) t(d, d) = T{} + 1.0;
  return t;
}

template <int Dim, class T>
T trace(const Tensor<Dim, T>& t) {
  T sum = t(0, 0);
  for (int d = 1; d < Dim; ++d) sum += t(d, d);
  return sum;
}

/// A B
template <int Dim, class T>
Tensor<Dim, T> product(const Tensor<Dim, T>& a, const Tensor<Dim, T>& b) {
  Tensor<Dim, T> c;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < Dim; ++k) c(i, j) += a(i, k) * b(k, j);
  return c;
}

/// A^T B
template <int Dim, class T>
Tensor<Dim, T> transposed_product(const Tensor<Dim, T>& a, const Tensor<Dim, T>& b) {
  Tensor<Dim, T> c;
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < Dim; ++k) c(i, j) += a(k, i) * b(k, j);
  return c;
}

/// det(A) A^-T
template <int Dim, class T>
Tensor<Dim, T> cofactors(const Tensor<Dim, T>& a) {
  Tensor<Dim, T> c;
  if constexpr (Dim == 2) {
    c(0, 0) = a(1, 1), c(0, 1) = -a(1, 0);
    c(1, 0) = -a(0, 1), c(1, 1) = a(0, 0);
  } else {
    for (int i = 0; i < 3; ++i) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
      for (int j = 0; j < 3; ++j) {
        const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
        c(i, j) = a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
      }
    }
  }
  return c;
}

/// The determinant of A, from its cofactors too.
template <int Dim, class T>
T determinant(const Tensor<Dim, T>& a, const Tensor<Dim, T>& cofactors_of_a) {
  T det = a(0, 0) * cofactors_of_a(0, 0);
  for (int j = 1; j < Dim; ++j) det += a(0, j) * cofactors_of_a(0, j);
  return det;
}

/// The rotation R of F = R U, U symmetric: the mean of R and R^-T again and again, from F (Higham 1986). Every step
/// squares the distance, so that after one below 1e-8 what is left is round-off.
template <int Dim, class T>
Tensor<Dim, T> rotation_of(const Tensor<Dim, T>& f) {
  Tensor<Dim, T> r = f;
  for (int step = 0; step < 50; ++step) {
    const Tensor<Dim, T> c = cofactors(r);
    const T half = 0.5 / determinant(r, c);
    T moved{};
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        const T change = half * c(i, j) - 0.5 * r(i, j);
        r(i, j) += change;
        moved += change * change;
      }
    }
    if (!(largest(moved) > 1e-16)) break;
  }
  return r;
}

}  // namespace greenwater::element
