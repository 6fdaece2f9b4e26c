#pragma once
// Elements whose force is linear in the displacement, as they stand (small) or in a frame that turns with them
// (corotational).

#include "fem/element_rules.hpp"
#include "fem/geometry.hpp"
#include "fem/tensor.hpp"

namespace greenwater::element {

/// W = d.K d/2 with d = R^T (X + u) - X, and R the rotation in the deformation gradient at the centre. The force is
/// the exact gradient of W, the change of R included, and so has no moment.
template <int Dim, bool Turning>
struct LinearElement {
  static constexpr int dim = Dim;
  static constexpr int nodes = 1 << Dim;
  static constexpr int unknowns = Dim * nodes;

  template <class D>
  struct Data {
    D stiffness[unknowns][unknowns];  // K     [N/m]
    D place[nodes][Dim];              // X     from the mean of the nodes [m]
    D centre[nodes][Dim];             // b     dN_a/dX at the centre [1/m]
  };

  Rules rules;

  Data<double> make(const Geometry<Dim>& g) const;
  static Data<double> shape(const Geometry<Dim>& g);

  template <class D, class T>
  T energy(const Data<D>& e, const T (&u)[nodes][Dim]) const {
    T d[unknowns], g[unknowns];
    local_displacement(e, u, frame(e, u), d);
    multiply(e.stiffness, d, g);
    T sum = d[0] * g[0];
    for (int i = 1; i < unknowns; ++i) sum += d[i] * g[i];
    return 0.5 * sum;
  }

  template <class D, class T>
  void force(const Data<D>& e, const T (&u)[nodes][Dim], T (&f)[nodes][Dim]) const {
    T d[unknowns], g[unknowns];
    const Frame<T> turned = frame(e, u);
    local_displacement(e, u, turned, d);
    multiply(e.stiffness, d, g);
    if constexpr (Turning) take_moment_out(e, turned, d, g);
    for (int a = 0; a < nodes; ++a) {
      for (int i = 0; i < Dim; ++i) {
        if constexpr (Turning) {
          f[a][i] = turned.r(i, 0) * g[Dim * a];
          for (int j = 1; j < Dim; ++j) f[a][i] += turned.r(i, j) * g[Dim * a + j];
        } else {
          f[a][i] = g[Dim * a + i];
        }
      }
    }
  }

  /// At the natural coordinates xi.
  Stress stress(const Geometry<Dim>& g, const double (&u)[nodes][Dim], const std::array<double, 3>& xi) const;

 private:
  template <class T>
  struct Frame {
    Tensor<Dim, T> f, r;  // F = R U
  };

  /// grad d at xi, incompatible modes included.
  Tensor<Dim, double> gradient(const Geometry<Dim>& g, const double (&d)[unknowns],
                               const std::array<double, 3>& xi) const;

  template <class D, class T>
  static Frame<T> frame(const Data<D>& e, const T (&u)[nodes][Dim]) {
    Frame<T> turned;
    if constexpr (Turning) {
      turned.f = identity<Dim, T>();
      for (int a = 1; a < nodes; ++a)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) turned.f(i, j) += e.centre[a][j] * (u[a][i] - u[0][i]);
      turned.r = rotation_of(turned.f);
    }
    return turned;
  }

  /// d = R^T u + (R^T - I) X, up to a translation.
  template <class D, class T>
  static void local_displacement(const Data<D>& e, const T (&u)[nodes][Dim], const Frame<T>& turned, T (&d)[unknowns]) {
    for (int a = 0; a < nodes; ++a) {
      T x[Dim];
      for (int i = 0; i < Dim; ++i) x[i] = u[a][i] - u[0][i];
      if constexpr (Turning) {
        for (int i = 0; i < Dim; ++i) x[i] += e.place[a][i];
        for (int i = 0; i < Dim; ++i) {
          d[Dim * a + i] = turned.r(0, i) * x[0] - e.place[a][i];
          for (int j = 1; j < Dim; ++j) d[Dim * a + i] += turned.r(j, i) * x[j];
        }
      } else {
        for (int i = 0; i < Dim; ++i) d[i + Dim * a] = x[i];
      }
    }
  }

  /// g = K d. In blocks of rows that fit the registers; K is symmetric, so that rows lie side by side.
  template <class D, class T>
  static void multiply(const D (&k)[unknowns][unknowns], const T (&d)[unknowns], T (&g)[unknowns]) {
    constexpr int block = 8;
    for (int first = 0; first < unknowns; first += block) {
      T sum[block];
      for (int i = 0; i < block; ++i) sum[i] = T{};
      for (int j = 0; j < unknowns; ++j)
        for (int i = 0; i < block; ++i) sum[i] += k[j][first + i] * d[j];
      for (int i = 0; i < block; ++i) g[first + i] = sum[i];
    }
  }

  /// g_a -= Z b_a, Z skew with U Z + Z U = sum of g_a y_a^T - y_a g_a^T, y = X + d: what the turning of R adds to the
  /// gradient.
  template <class D, class T>
  static void take_moment_out(const Data<D>& e, const Frame<T>& turned, const T (&d)[unknowns], T (&g)[unknowns]) {
    Tensor<Dim, T> moment;
    for (int a = 0; a < nodes; ++a) {
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < i; ++j) {
          const T yi = d[Dim * a + i] + e.place[a][i], yj = d[Dim * a + j] + e.place[a][j];
          moment(i, j) += g[Dim * a + i] * yj - yi * g[Dim * a + j];
        }
      }
    }
    const Tensor<Dim, T> z = skew_solution(transposed_product(turned.r, turned.f), moment);
    for (int a = 0; a < nodes; ++a)
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j)
          if (i != j) g[Dim * a + i] -= e.centre[a][j] * z(i, j);
  }

  /// Z skew with U Z + Z U = Q skew, of which the entries below the diagonal are read. With axial vectors
  /// (tr(U) I - U) z = q.
  template <class T>
  static Tensor<Dim, T> skew_solution(const Tensor<Dim, T>& u, const Tensor<Dim, T>& q) {
    Tensor<Dim, T> z;
    if constexpr (Dim == 2) {
      z(1, 0) = q(1, 0) / trace(u);
      z(0, 1) = -z(1, 0);
    } else {
      Tensor<3, T> s;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          s(i, j) = i == j ? u((i + 1) % 3, (i + 1) % 3) + u((i + 2) % 3, (i + 2) % 3) : -u(i, j);
      const Tensor<3, T> c = cofactors(s);
      const T inverse = 1.0 / determinant(s, c);
      const T axis[3] = {q(2, 1), -q(2, 0), q(1, 0)};
      T w[3];
      for (int i = 0; i < 3; ++i) w[i] = inverse * (c(i, 0) * axis[0] + c(i, 1) * axis[1] + c(i, 2) * axis[2]);
      z(2, 1) = w[0], z(1, 2) = -w[0];
      z(0, 2) = w[1], z(2, 0) = -w[1];
      z(1, 0) = w[2], z(0, 1) = -w[2];
    }
    return z;
  }
};

}  // namespace greenwater::element
