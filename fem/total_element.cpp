#include "fem/total_element.hpp"

namespace greenwater::element {

template <int Dim>
Tensor<Dim, double> TotalElement<Dim>::deformation(const Geometry<Dim>& g, const double (&u)[nodes][Dim],
                                                   const std::array<double, 3>& xi) const {
  Gradients<double> h;
  double amount[modes];
  const Data<double> e = make(g);
  deform(e, u, h, amount);
  const LocalGradients<Dim> local = gradients_at(g, xi);
  Tensor<Dim, double> f = identity<Dim, double>();
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      for (int a = 0; a < nodes; ++a) f(i, j) += u[a][i] * local.shape[a][j];
      for (int k = 0; k < Dim; ++k) f(i, j) += amount[Dim * k + i] * local.mode[k][j];
    }
  }
  if (rules.kind != ElementKind::mean_dilatation) return f;
  double volume = 0;
  for (int p = 0; p < points; ++p) volume += e.weight[p] * volume_ratio(h[p]);
  const double scale = std::pow(volume / g.volume() / determinant(f, cofactors(f)), 1.0 / Dim);
  for (auto& row : f.m)
    for (double& entry : row) entry *= scale;
  return f;
}

template <int Dim>
Stress TotalElement<Dim>::stress(const Geometry<Dim>& g, const double (&u)[nodes][Dim],
                                 const std::array<double, 3>& xi) const {
  Tensor<Dim, double> h = deformation(g, u, xi);
  for (int d = 0; d < Dim; ++d) h(d, d) -= 1;
  const Response<double> r = respond(h);
  double ratio = determinant(r.f, cofactors(r.f));
  double across = 0;
  if (Dim == 2) {
    double swelling = -Dim;  // tr(C) - 2 = 2 tr(E)
    for (const auto& row : r.f.m)
      for (const double entry : row) swelling += entry * entry;
    if (rules.plane == Plane::stress)
      ratio *= std::sqrt(1 - rules.lame.lambda / (2 * rules.lame.mu) * swelling);  // E_zz = -lambda tr(E) / (2 mu)
    else
      across = rules.lame.lambda * (rules.law == Law::linear ? swelling / 2 : std::log(ratio)) / ratio;
  }
  Tensor<Dim, double> cauchy;
  const Tensor<Dim, double> nominal = product(r.f, r.s);
  for (int i = 0; i < Dim; ++i)
    for (int j = 0; j < Dim; ++j)
      for (int k = 0; k < Dim; ++k) cauchy(i, j) += nominal(i, k) * r.f(j, k) / ratio;
  return stress_of(cauchy, across);
}

template struct TotalElement<2>;
template struct TotalElement<3>;

}  // namespace greenwater::element
