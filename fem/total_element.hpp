#pragma once
// Elements in Green's strain: any rotation, any strain.

#include "fem/element_rules.hpp"
#include "fem/geometry.hpp"
#include "fem/small_solve.hpp"
#include "fem/tensor.hpp"

namespace greenwater::element {

/// W = sum of w W(F) over the points. Incompatible: F = I + grad u + sum of a_k (x) grad M_k, with the a_k that make W
/// least, found by Newton's method within each call: the answer does not depend on what was before. Mean dilatation:
/// F (theta/J)^(1/Dim) in place of F, theta the ratio of volumes of the whole element.
template <int Dim>
struct TotalElement {
  static constexpr int dim = Dim;
  static constexpr int nodes = 1 << Dim;
  static constexpr int points = 1 << Dim;
  static constexpr int modes = Dim * Dim;  // Dim vectors a_k

  template <class D>
  struct Data {
    D gradient[points][nodes][Dim];  // dN_a/dX [1/m]
    D weight[points];                // [m3]
    D mode[points][Dim][Dim];        // grad M_k [-]
  };

  Rules rules;

  Data<double> make(const Geometry<Dim>& g) const {
    Data<double> e;
    for (int p = 0; p < points; ++p) {
      e.weight[p] = g.weight[p];
      for (int a = 0; a < nodes; ++a)
        for (int d = 0; d < Dim; ++d) e.gradient[p][a][d] = g.gradient[p][a][d];
      for (int k = 0; k < Dim; ++k)
        for (int d = 0; d < Dim; ++d) e.mode[p][k][d] = g.mode[p][k][d];
    }
    return e;
  }

  template <class D, class T>
  T energy(const Data<D>& e, const T (&u)[nodes][Dim]) const {
    Gradients<T> h;
    deform(e, u, h);
    if (rules.kind == ElementKind::mean_dilatation) share_dilatation(e, h);
    T sum{};
    for (int p = 0; p < points; ++p) sum += e.weight[p] * respond(h[p]).energy;
    return sum;
  }

  template <class D, class T>
  void force(const Data<D>& e, const T (&u)[nodes][Dim], T (&f)[nodes][Dim]) const {
    Gradients<T> h, stress;
    deform(e, u, h);
    if (rules.kind == ElementKind::mean_dilatation) {
      shared_stress(e, h, stress);
    } else {
      for (int p = 0; p < points; ++p) {
        const Response<T> r = respond(h[p]);
        stress[p] = product(r.f, r.s);
      }
    }
    for (int a = 0; a < nodes; ++a) {
      for (int i = 0; i < Dim; ++i) {
        T sum{};
        for (int p = 0; p < points; ++p) {
          T power = e.gradient[p][a][0] * stress[p](i, 0);
          for (int j = 1; j < Dim; ++j) power += e.gradient[p][a][j] * stress[p](i, j);
          sum += e.weight[p] * power;
        }
        f[a][i] = sum;
      }
    }
  }

  /// Cauchy's, at the natural coordinates xi.
  Stress stress(const Geometry<Dim>& g, const double (&u)[nodes][Dim], const std::array<double, 3>& xi) const;

 private:
  template <class T>
  using Gradients = Tensor<Dim, T>[points];

  /// What the material answers to a gradient of displacement.
  template <class T>
  struct Response {
    Tensor<Dim, T> f, s;    // F, and second Piola-Kirchhoff [Pa]
    Tensor<Dim, T> carry;   // F (linear) or F^-T (neo-Hookean): takes a gradient to the tangent's vectors
    Tensor<Dim, T> spread;  // F F^T, of the linear law
    T shear, energy;        // mu, or mu - lambda ln J [Pa]; W [J/m3]
  };

  template <class T>
  Response<T> respond(const Tensor<Dim, T>& h) const {
    return rules.law == Law::linear ? respond_linear(h) : respond_neo_hookean(h);
  }

  template <class T>
  Response<T> respond_linear(const Tensor<Dim, T>& h) const {
    Response<T> r;
    const Tensor<Dim, T> square = transposed_product(h, h);
    Tensor<Dim, T> strain;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        r.f(i, j) = i == j ? h(i, j) + 1.0 : h(i, j);
        strain(i, j) = 0.5 * (h(i, j) + h(j, i) + square(i, j));
      }
    }
    const T swelling = trace(strain);
    r.energy = 0.5 * rules.lame.lambda * (swelling * swelling);
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        r.s(i, j) = 2 * rules.lame.mu * strain(i, j);
        r.energy += rules.lame.mu * (strain(i, j) * strain(i, j));
      }
      r.s(i, i) += rules.lame.lambda * swelling;
    }
    r.carry = r.f;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j)
        for (int k = 0; k < Dim; ++k) r.spread(i, j) += r.f(i, k) * r.f(j, k);
    r.shear = T{} + rules.lame.mu;
    return r;
  }

  template <class T>
  Response<T> respond_neo_hookean(const Tensor<Dim, T>& h) const {
    Response<T> r;
    r.f = h;
    for (int i = 0; i < Dim; ++i) r.f(i, i) += T{} + 1.0;
    const Tensor<Dim, T> c = cofactors(r.f);
    const T det = determinant(r.f, c);
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) r.carry(i, j) = c(i, j) / det;
    const T log_det = log_of(det);
    const auto [lambda, mu] = rules.lame;
    r.shear = T{} + mu - lambda * log_det;
    const Tensor<Dim, T> inverse = transposed_product(r.carry, r.carry);  // C^-1
    r.energy = 0.5 * lambda * (log_det * log_det) - mu * log_det;
    for (int i = 0; i < Dim; ++i) {
      for (int j = 0; j < Dim; ++j) {
        r.s(i, j) = -(r.shear * inverse(i, j));
        r.energy += 0.5 * mu * (r.f(i, j) * r.f(i, j));
      }
      r.s(i, i) += T{} + mu;
    }
    r.energy += T{} - 0.5 * mu * Dim;
    return r;
  }

  /// F at xi, mean dilatation and incompatible modes included.
  Tensor<Dim, double> deformation(const Geometry<Dim>& g, const double (&u)[nodes][Dim],
                                  const std::array<double, 3>& xi) const;

  /// h = grad u, with the incompatible modes where the element has them.
  template <class D, class T>
  void deform(const Data<D>& e, const T (&u)[nodes][Dim], Gradients<T>& h) const {
    T amount[modes];
    deform(e, u, h, amount);
  }

  /// Tells the a_k too, component by component; 0 where there are no modes.
  template <class D, class T>
  void deform(const Data<D>& e, const T (&u)[nodes][Dim], Gradients<T>& h, T (&amount)[modes]) const {
    for (int m = 0; m < modes; ++m) amount[m] = T{};
    for (int p = 0; p < points; ++p) {
      h[p] = {};
      for (int a = 1; a < nodes; ++a)
        for (int i = 0; i < Dim; ++i)
          for (int j = 0; j < Dim; ++j) h[p](i, j) += e.gradient[p][a][j] * (u[a][i] - u[0][i]);
    }
    if (rules.kind != ElementKind::incompatible) return;
    for (int step = 0; step < 30; ++step) {
      T residual[modes] = {}, tangent[modes][modes] = {};
      for (int p = 0; p < points; ++p) add_modes(e.weight[p], e.mode[p], respond(h[p]), residual, tangent);
      solve_symmetric(tangent, residual);
      double moved = 0;
      for (int m = 0; m < modes; ++m) {
        moved = std::max(moved, largest(residual[m]));
        amount[m] -= residual[m];
      }
      for (int p = 0; p < points; ++p)
        for (int k = 0; k < Dim; ++k)
          for (int i = 0; i < Dim; ++i)
            for (int j = 0; j < Dim; ++j) h[p](i, j) -= e.mode[p][k][j] * residual[Dim * k + i];
      if (!(moved > 1e-8)) break;  // squared by the next step: round-off
    }
  }

  /// Adds dW/da_k and, below the diagonal, d2W/da_k da_l of one point.
  template <class D, class T>
  void add_modes(const D& weight, const D (&mode)[Dim][Dim], const Response<T>& r, T (&residual)[modes],
                 T (&tangent)[modes][modes]) const {
    T sg[Dim][Dim], carried[Dim][Dim];  // S g_k, and the tangent's vectors
    for (int k = 0; k < Dim; ++k) {
      for (int i = 0; i < Dim; ++i) {
        sg[k][i] = carried[k][i] = T{};
        for (int j = 0; j < Dim; ++j) {
          sg[k][i] += mode[k][j] * r.s(i, j);
          carried[k][i] += mode[k][j] * r.carry(i, j);
        }
      }
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) residual[Dim * k + i] += weight * (r.f(i, j) * sg[k][j]);
    }
    for (int k = 0; k < Dim; ++k) {
      for (int l = 0; l <= k; ++l) {
        T geometric{}, dot{};
        for (int j = 0; j < Dim; ++j) {
          geometric += mode[k][j] * sg[l][j];
          if (rules.law == Law::linear)
            dot += T{} + mode[k][j] * mode[l][j];
          else
            dot += carried[k][j] * carried[l][j];
        }
        for (int i = 0; i < Dim; ++i) {
          for (int j = 0; j < Dim; ++j) {
            T entry = rules.lame.lambda * (carried[k][i] * carried[l][j]) + r.shear * (carried[l][i] * carried[k][j]);
            if (rules.law == Law::linear) entry += r.shear * (dot * r.spread(i, j));
            if (rules.law != Law::linear && i == j) entry += r.shear * dot;
            if (i == j) entry += geometric;
            tangent[Dim * k + i][Dim * l + j] += weight * entry;
          }
        }
      }
    }
  }

  /// J at a point.
  template <class T>
  static T volume_ratio(const Tensor<Dim, T>& h) {
    Tensor<Dim, T> f = h;
    for (int i = 0; i < Dim; ++i) f(i, i) += T{} + 1.0;
    return determinant(f, cofactors(f));
  }

  /// Turns F into F (theta/J)^(1/Dim) at all points. Returns the element's volume now.
  template <class D, class T>
  static T share_dilatation(const Data<D>& e, Gradients<T>& h) {
    T ratio[points], volume{};
    D before{};
    for (int p = 0; p < points; ++p) {
      ratio[p] = volume_ratio(h[p]);
      volume += e.weight[p] * ratio[p];
      before += e.weight[p];
    }
    for (int p = 0; p < points; ++p) {
      const T scale = power_of(volume / (before * ratio[p]), 1.0 / Dim);
      for (int i = 0; i < Dim; ++i) {
        for (int j = 0; j < Dim; ++j) h[p](i, j) = scale * h[p](i, j);
        h[p](i, i) += scale - 1.0;
      }
    }
    return volume;
  }

  /// First Piola-Kirchhoff stress of mean dilatation, c P + F^-T (J sum(w q) / v - q): P that of c F, c = (theta/J)^(1/Dim),
  /// q = c P:F / Dim, v the volume now.
  template <class D, class T>
  void shared_stress(const Data<D>& e, const Gradients<T>& h, Gradients<T>& stress) const {
    Gradients<T> shared;
    for (int p = 0; p < points; ++p) shared[p] = h[p];
    const T volume = share_dilatation(e, shared);
    T pressure[points], whole{};
    for (int p = 0; p < points; ++p) {
      const Response<T> r = respond(shared[p]);
      stress[p] = product(r.f, r.s);
      pressure[p] = T{};
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) pressure[p] += (1.0 / Dim) * (stress[p](i, j) * r.f(i, j));
      whole += e.weight[p] * pressure[p];
    }
    for (int p = 0; p < points; ++p) {
      Tensor<Dim, T> f = h[p];
      for (int i = 0; i < Dim; ++i) f(i, i) += T{} + 1.0;
      const Tensor<Dim, T> c = cofactors(f);
      const T ratio = determinant(f, c);
      const T scale = (shared[p](0, 0) + 1.0) / f(0, 0);
      const T rest = (ratio * whole / volume - pressure[p]) / ratio;
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) stress[p](i, j) = scale * stress[p](i, j) + rest * c(i, j);
    }
  }
};

}  // namespace greenwater::element
