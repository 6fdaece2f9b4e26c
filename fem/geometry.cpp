#include "fem/geometry.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "core/check.hpp"
#include "fem/shape_functions.hpp"
#include "fem/tensor.hpp"

namespace greenwater::element {
namespace {

/// At the centre, and at all corners shrunk towards it: 1 keeps them, 1 / sqrt(3) makes them the points of Gauss.
template <int Dim>
const Functions<Dim>& at_centre() {
  static const Functions<Dim> functions{Point<Dim>{}};
  return functions;
}

template <int Dim>
std::vector<Functions<Dim>> at_corners(double shrink) {
  std::vector<Functions<Dim>> all;
  for (int a = 0; a < 1 << Dim; ++a) {
    Point<Dim> xi = corner<Dim>(a);
    for (double& x : xi) x *= shrink;
    all.emplace_back(xi);
  }
  return all;
}

/// dX/dxi
template <int Dim>
Tensor<Dim, double> jacobian(const Geometry<Dim>& g, const Functions<Dim>& n) {
  Tensor<Dim, double> j;
  for (int a = 0; a < g.nodes; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) j(i, k) += g.place[a][i] * n.slope[a][k];
  return j;
}

/// dN_a/dX from the cofactors and the determinant of the Jacobian.
template <int Dim>
void set_gradients(const Functions<Dim>& n, const Tensor<Dim, double>& cofactor, double det,
                   double (&gradient)[1 << Dim][Dim]) {
  for (int a = 0; a < 1 << Dim; ++a)
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) gradient[a][i] += n.slope[a][k] * cofactor(i, k) / det;
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
  if (det > 1e-3 * edges) return;  // an angle of 0.06 degrees
  throw CaseError(text_of("solid element ", element + 1, " with nodes at ", place_of(mesh, element), " m is ",
                          det < -1e-3 * edges ? "inverted" : "degenerate",
                          Dim == 2 ? ": list its nodes anti-clockwise, and let no angle reach 0 or 180 degrees"
                                   : ": list the four nodes of one side anti-clockwise seen from inside and then those "
                                     "opposite them, and let no angle reach 0 or 180 degrees"));
}

/// Gradients of the incompatible modes: those of the centre, times xi_k j0/j.
template <int Dim>
void set_modes(const Functions<Dim>& n, const Tensor<Dim, double>& middle, double det, double (&mode)[Dim][Dim]) {
  const auto centre = cofactors(middle);
  const double ratio = determinant(middle, centre) / det;
  for (int k = 0; k < Dim; ++k) {
    double length = 0;
    for (int i = 0; i < Dim; ++i) length += centre(i, k) * centre(i, k);
    for (int i = 0; i < Dim; ++i) mode[k][i] = ratio * n.xi[k] * centre(i, k) / std::sqrt(length);
  }
}

template <int Dim>
void set_point(Geometry<Dim>& g, int p, const Functions<Dim>& n, double thickness) {
  const auto j = jacobian(g, n), cofactor = cofactors(j);
  const double det = determinant(j, cofactor);
  g.weight[p] = det * thickness;
  for (int a = 0; a < g.nodes; ++a) g.share[a] += n.shape[a] * g.weight[p];
  set_gradients(n, cofactor, det, g.gradient[p]);
  set_modes(n, jacobian(g, at_centre<Dim>()), det, g.mode[p]);
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
  static const auto corners = at_corners<Dim>(1), points = at_corners<Dim>(1 / std::sqrt(3.0));
  for (const auto& n : corners) require_sound(mesh, element, jacobian(g, n));
  const auto centre = jacobian(g, at_centre<Dim>()), cofactor = cofactors(centre);
  set_gradients(at_centre<Dim>(), cofactor, determinant(centre, cofactor), g.centre);
  for (int p = 0; p < g.points; ++p) set_point(g, p, points[p], Dim == 2 ? thickness : 1);
  return g;
}

template <int Dim>
LocalGradients<Dim> gradients_at(const Geometry<Dim>& g, const std::array<double, 3>& xi) {
  Point<Dim> at;
  for (int d = 0; d < Dim; ++d) at[d] = xi[d];
  const Functions<Dim> n(at);
  const auto j = jacobian(g, n), cofactor = cofactors(j);
  const double det = determinant(j, cofactor);
  LocalGradients<Dim> local;
  set_gradients(n, cofactor, det, local.shape);
  set_modes(n, jacobian(g, at_centre<Dim>()), det, local.mode);
  return local;
}

template LocalGradients<2> gradients_at(const Geometry<2>&, const std::array<double, 3>&);
template LocalGradients<3> gradients_at(const Geometry<3>&, const std::array<double, 3>&);
template Geometry<2> geometry_of(const SolidMesh&, int, double);
template Geometry<3> geometry_of(const SolidMesh&, int, double);

}  // namespace greenwater::element
