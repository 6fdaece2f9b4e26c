#include "fem/linear_element.hpp"

#include <Eigen/Dense>

namespace greenwater::element {
namespace {

/// Mean of the gradients over the volume: what the change of volume of the whole element comes from.
template <int Dim>
void mean_gradients(const Geometry<Dim>& g, double (&mean)[1 << Dim][Dim]) {
  const double volume = g.volume();
  for (int a = 0; a < g.nodes; ++a) {
    for (int i = 0; i < Dim; ++i) {
      mean[a][i] = 0;
      for (int p = 0; p < g.points; ++p) mean[a][i] += g.gradient[p][a][i] * g.weight[p] / volume;
    }
  }
}

/// Adds the block of functions a and b, with gradients ga and gb, and va and vb for the change of volume:
/// (lambda + 2 mu / Dim) va vb^T + mu (gb ga^T + ga.gb I - 2 / Dim ga gb^T).
template <int Dim, class Block>
void add_block(Block block, const Lame& lame, const double* ga, const double* gb, const double* va, const double* vb) {
  double dot = 0;
  for (int d = 0; d < Dim; ++d) dot += ga[d] * gb[d];
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) {
      block(i, j) += (lame.lambda + 2 * lame.mu / Dim) * va[i] * vb[j] + lame.mu * (gb[i] * ga[j]) -
                     2 * lame.mu / Dim * ga[i] * gb[j] + (i == j ? lame.mu * dot : 0);
    }
  }
}

/// K of the nodes and, after them, of the incompatible modes.
template <int Dim>
Eigen::MatrixXd whole_stiffness(const Geometry<Dim>& g, const Lame& lame, ElementKind kind) {
  const int functions = g.nodes + (kind == ElementKind::incompatible ? Dim : 0);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(Dim * functions, Dim * functions);
  double mean[Geometry<Dim>::nodes][Dim];
  mean_gradients(g, mean);
  for (int p = 0; p < g.points; ++p) {
    const auto gradient = [&](int a) { return a < g.nodes ? g.gradient[p][a] : g.mode[p][a - g.nodes]; };
    const auto swelling = [&](int a) { return kind == ElementKind::mean_dilatation ? mean[a] : gradient(a); };
    const Lame weighted{lame.lambda * g.weight[p], lame.mu * g.weight[p]};
    for (int a = 0; a < functions; ++a) {
      for (int b = 0; b < functions; ++b) {
        add_block<Dim>(k.block<Dim, Dim>(Dim * a, Dim * b), weighted, gradient(a), gradient(b), swelling(a),
                       swelling(b));
      }
    }
  }
  return k;
}

}  // namespace

template <int Dim, bool Turning>
auto LinearElement<Dim, Turning>::make(const Geometry<Dim>& g) const -> Data<double> {
  Eigen::MatrixXd k = whole_stiffness(g, rules.lame, rules.kind);
  const int inner = static_cast<int>(k.rows()) - unknowns;
  if (inner > 0) {
    const Eigen::MatrixXd kiu = k.bottomLeftCorner(inner, unknowns);
    k.topLeftCorner(unknowns, unknowns) -= kiu.transpose() * k.bottomRightCorner(inner, inner).llt().solve(kiu);
  }
  Data<double> e = shape(g);
  for (int i = 0; i < unknowns; ++i)
    for (int j = 0; j < unknowns; ++j) e.stiffness[i][j] = (k(i, j) + k(j, i)) / 2;
  return e;
}

// Without the stiffness.
template <int Dim, bool Turning>
auto LinearElement<Dim, Turning>::shape(const Geometry<Dim>& g) -> Data<double> {
  Data<double> e{};
  for (int a = 0; a < nodes; ++a) {
    for (int d = 0; d < Dim; ++d) {
      e.place[a][d] = g.place[a][d];
      e.centre[a][d] = g.centre[a][d];
    }
  }
  return e;
}

template <int Dim, bool Turning>
Tensor<Dim, double> LinearElement<Dim, Turning>::gradient(const Geometry<Dim>& g, const double (&d)[unknowns],
                                                          const std::array<double, 3>& xi) const {
  const LocalGradients<Dim> local = gradients_at(g, xi);
  Tensor<Dim, double> h;
  for (int a = 0; a < nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) h(i, j) += d[Dim * a + i] * local.shape[a][j];
  if (rules.kind != ElementKind::incompatible) return h;
  const Eigen::MatrixXd k = whole_stiffness(g, rules.lame, rules.kind);
  const int inner = static_cast<int>(k.rows()) - unknowns;
  const Eigen::VectorXd push = k.bottomLeftCorner(inner, unknowns) * Eigen::Map<const Eigen::VectorXd>(d, unknowns);
  const Eigen::VectorXd amount = -k.bottomRightCorner(inner, inner).llt().solve(push);
  for (int m = 0; m < Dim; ++m)
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) h(i, j) += amount[Dim * m + i] * local.mode[m][j];
  return h;
}

template <int Dim, bool Turning>
Stress LinearElement<Dim, Turning>::stress(const Geometry<Dim>& g, const double (&u)[nodes][Dim],
                                           const std::array<double, 3>& xi) const {
  const Data<double> e = shape(g);
  const auto turned = frame(e, u);
  double d[unknowns], mean[nodes][Dim];
  local_displacement(e, u, turned, d);
  const Tensor<Dim, double> h = gradient(g, d, xi);
  const double own = trace(h);
  double swelling = own;
  if (rules.kind == ElementKind::mean_dilatation) {
    mean_gradients(g, mean);
    swelling = 0;
    for (int i = 0; i < unknowns; ++i) swelling += d[i] * mean[i / Dim][i % Dim];
  }
  Tensor<Dim, double> s;
  for (int i = 0; i < Dim; ++i) {
    for (int j = 0; j < Dim; ++j) s(i, j) = rules.lame.mu * (h(i, j) + h(j, i));
    s(i, i) += rules.lame.lambda * swelling + 2 * rules.lame.mu / Dim * (swelling - own);
  }
  if constexpr (Turning) {
    Tensor<Dim, double> transposed;
    for (int i = 0; i < Dim; ++i)
      for (int j = 0; j < Dim; ++j) transposed(i, j) = turned.r(j, i);
    s = product(product(turned.r, s), transposed);
  }
  return stress_of(s, rules.plane == Plane::strain ? rules.lame.lambda * swelling : 0);
}

template struct LinearElement<2, false>;
template struct LinearElement<2, true>;
template struct LinearElement<3, false>;
template struct LinearElement<3, true>;

}  // namespace greenwater::element
