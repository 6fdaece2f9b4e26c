#pragma once
// Matrices of the size of space, of numbers or of packs of them.

#include "core/fields.hpp"

namespace greenwater {

/// Symmetric matrix; row by row from the diagonal on: xx xy yy, or xx xy xz yy yz zz.
template <int Dim, class T>
struct Symmetric {
  static constexpr int size = Dim * (Dim + 1) / 2;
  T c[size];

  KOKKOS_INLINE_FUNCTION static constexpr int place(int a, int b) {
    return a <= b ? a * Dim - a * (a - 1) / 2 + b - a : place(b, a);
  }
  KOKKOS_INLINE_FUNCTION T& operator()(int a, int b) { return c[place(a, b)]; }
  KOKKOS_INLINE_FUNCTION T operator()(int a, int b) const { return c[place(a, b)]; }

  /// + s v v^T
  KOKKOS_INLINE_FUNCTION void add_square(const T& s, const Vec<Dim, T>& v) {
    for (int a = 0; a < Dim; ++a)
      for (int b = a; b < Dim; ++b) (*this)(a, b) += s * v[a] * v[b];
  }
  /// + s I
  KOKKOS_INLINE_FUNCTION void add_unit(const T& s) {
    for (int a = 0; a < Dim; ++a) (*this)(a, a) += s;
  }
  KOKKOS_INLINE_FUNCTION T trace() const {
    T sum{};
    for (int a = 0; a < Dim; ++a) sum += (*this)(a, a);
    return sum;
  }
};

/// Adjugate: the inverse times the determinant.
template <class T>
KOKKOS_INLINE_FUNCTION Symmetric<2, T> adjugate(const Symmetric<2, T>& m) {
  return {{m.c[2], -m.c[1], m.c[0]}};
}
template <class T>
KOKKOS_INLINE_FUNCTION Symmetric<3, T> adjugate(const Symmetric<3, T>& m) {
  const T &xx = m.c[0], &xy = m.c[1], &xz = m.c[2], &yy = m.c[3], &yz = m.c[4], &zz = m.c[5];
  return {{yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy, xx * zz - xz * xz, xy * xz - xx * yz,
           xx * yy - xy * xy}};
}

/// Determinant, from the adjugate.
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T determinant(const Symmetric<Dim, T>& m, const Symmetric<Dim, T>& adjugate) {
  T sum{};
  for (int a = 0; a < Dim; ++a) sum += m(0, a) * adjugate(0, a);
  return sum;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec<Dim, T> product(const Symmetric<Dim, T>& m, const Vec<Dim, T>& v) {
  Vec<Dim, T> r{};
  for (int a = 0; a < Dim; ++a)
    for (int b = 0; b < Dim; ++b) r[a] += m(a, b) * v[b];
  return r;
}

}  // namespace greenwater
