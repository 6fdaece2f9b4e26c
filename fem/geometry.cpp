#include "fem/geometry.hpp"

#include <array>
#include <cmath>
#include <string>

#include "core/check.hpp"
#include "fem/tensor.hpp"

namespace greenwater::element {
namespace {

template <int Dim>
using Point = std::array<double, Dim>;

/// Corner a of the reference element [-1, 1]^Dim: the first four nodes go round, the next four lie above them.
template <int Dim>
Point<Dim> corner(int a) {
  Point<Dim> xi;
  xi[0] = a % 4 == 1 || a % 4 == 2 ? 1 : -1;
  xi[1] = a % 4 >= 2 ? 1 : -1;
  if constexpr (Dim == 3) xi[2] = a >= 4 ? 1 : -1;
  return xi;
}

template <int Dim>
double shape(int a, const Point<Dim>& xi) {
  double n = 1;
  for (int d = 0; d < Dim; ++d) n *= (1 + corner<Dim>(a)[d] * xi[d]) / 2;
  return n;
}

/// dN_a/dxi_k
template <int Dim>
double slope(int a, int k, const Point<Dim>& xi) {
  double n = corner<Dim>(a)[k] / 2;
  for (int d = 0; d < Dim; ++d) {
    if (d != k) n *= (1 + corner<Dim>(a)[d] * xi[d]) / 2;
  }
  return n;
}

/// dX/dxi
template <int Dim>
Tensor<Dim, double> jacobian(const Geometry<Dim>& g, const Point<Dim>& xi) {
  Tensor<Dim, double> j;
  for (int a = 0; a < g.nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) j(i, k) += g.place[a][i] * slope<Dim>(a, k, xi);
  return j;
}

std::string place_of(const SolidMesh& mesh, int element) {
  std::string text;
  for (int a = 0; a < mesh.nodes_per_element(); ++a) {
    const auto& x = mesh.nodes[mesh.elements[element][a]];
    text += text_of(a ? ", (" : "(", x[0], ", ", x[1]);
    text += mesh.dim == 3 ? text_of(", ", x[2], ")") : ")";
  }
  return text;
}

template <int Dim>
void require_sound(const SolidMesh& mesh, int element, const Tensor<Dim, double>& j) {
  const double det = determinant(j, cofactors(j));
  double edges = 1;
  for (int k = 0; k < Dim; ++k) {
    double square = 0;
    for (int i = 0; i < Dim; ++i) square += j(i, k) * j(i, k);
    edges *= std::sqrt(square);
  }
  // A thousandth: an angle of 0.06 degrees.
  require(det > 1e-3 * edges, "solid element ", element + 1, " with nodes at ", place_of(mesh, element), " m is ",
          det < -1e-3 * edges ? "inverted" : "degenerate",
          Dim == 2 ? ": list its nodes anti-clockwise, and let no angle reach 0 or 180 degrees"
                   : ": list the four nodes of one side anti-clockwise seen from inside and then those opposite them, "
                     "and let no angle reach 0 or 180 degrees");
}

template <int Dim>
void set_centre(Geometry<Dim>& g, const Tensor<Dim, double>& cofactor, double det) {
  for (int a = 0; a < g.nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) g.centre[a][i] += slope<Dim>(a, k, Point<Dim>{}) * cofactor(i, k) / det;
}

template <int Dim>
void set_point(Geometry<Dim>& g, int p, const Point<Dim>& xi, double thickness) {
  const auto j = jacobian<Dim>(g, xi);
  const auto cofactor = cofactors(j);
  const double det = determinant(j, cofactor);
  g.weight[p] = det * thickness;
  for (int a = 0; a < g.nodes; ++a) {
    g.share[a] += shape<Dim>(a, xi) * g.weight[p];
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) g.gradient[p][a][i] += slope<Dim>(a, k, xi) * cofactor(i, k) / det;
  }
  const auto middle = jacobian<Dim>(g, Point<Dim>{});
  const auto centre = cofactors(middle);
  const double ratio = determinant(middle, centre) / det;  // j0/j
  for (int k = 0; k < Dim; ++k) {
    double length = 0;
    for (int i = 0; i < Dim; ++i) length += centre(i, k) * centre(i, k);
    for (int i = 0; i < Dim; ++i) g.mode[p][k][i] = ratio * xi[k] * centre(i, k) / std::sqrt(length);
  }
}

}  // namespace

template <int Dim>
Geometry<Dim> geometry_of(const SolidMesh& mesh, int element, double thickness) {
  Geometry<Dim> g;
  const auto& nodes = mesh.elements[element];
  for (int d = 0; d < Dim; ++d) {
    double mean = 0;
    for (int a = 0; a < g.nodes; ++a) mean += mesh.nodes[nodes[a]][d] / g.nodes;
    for (int a = 0; a < g.nodes; ++a) g.place[a][d] = mesh.nodes[nodes[a]][d] - mean;
  }
  for (int a = 0; a < g.nodes; ++a) require_sound(mesh, element, jacobian<Dim>(g, corner<Dim>(a)));
  const auto centre = jacobian<Dim>(g, Point<Dim>{});
  set_centre(g, cofactors(centre), determinant(centre, cofactors(centre)));
  for (int p = 0; p < g.points; ++p) {
    auto xi = corner<Dim>(p);
    for (double& x : xi) x /= std::sqrt(3.0);
    set_point<Dim>(g, p, xi, Dim == 2 ? thickness : 1);
  }
  return g;
}

template Geometry<2> geometry_of(const SolidMesh&, int, double);
template Geometry<3> geometry_of(const SolidMesh&, int, double);

}  // namespace greenwater::element
