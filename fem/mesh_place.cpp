#include "fem/mesh_place.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "core/check.hpp"
#include "fem/shape_functions.hpp"

namespace greenwater {
namespace {

struct Found {
  MeshPlace place;
  double square = 1e300;  // of the distance [m2]
};

/// Square of the distance to the box round an element: no place of the element is nearer.
double square_to_box(const SolidMesh& mesh, int element, const std::array<double, 3>& x) {
  double square = 0;
  for (int d = 0; d < mesh.dim; ++d) {
    double low = 1e300, high = -1e300;
    for (int a = 0; a < mesh.nodes_per_element(); ++a) {
      low = std::min(low, mesh.nodes[mesh.elements[element][a]][d]);
      high = std::max(high, mesh.nodes[mesh.elements[element][a]][d]);
    }
    const double off = std::max({low - x[d], x[d] - high, 0.0});
    square += off * off;
  }
  return square;
}

template <int Dim>
struct Offset {
  Eigen::Matrix<double, Dim, 1> vector;                                             // x - X(xi) [m]
  Eigen::Matrix<double, Dim, Dim> slope = Eigen::Matrix<double, Dim, Dim>::Zero();  // dX/dxi

  Offset(const SolidMesh& mesh, int element, const Eigen::Matrix<double, Dim, 1>& xi, const std::array<double, 3>& x) {
    element::Point<Dim> at;
    for (int d = 0; d < Dim; ++d) {
      at[d] = xi[d];
      vector[d] = x[d];
    }
    const element::Functions<Dim> n(at);
    for (int a = 0; a < 1 << Dim; ++a) {
      const auto& node = mesh.nodes[mesh.elements[element][a]];
      for (int d = 0; d < Dim; ++d) {
        vector[d] -= n.shape[a] * node[d];
        for (int k = 0; k < Dim; ++k) slope(d, k) += n.slope[a][k] * node[d];
      }
    }
  }
};

/// X(xi) = x by Newton's steps, each brought back into the element.
template <int Dim>
Found nearest_in(const SolidMesh& mesh, int element, const std::array<double, 3>& x) {
  Eigen::Matrix<double, Dim, 1> xi = Eigen::Matrix<double, Dim, 1>::Zero(), before;
  int steps = 0;
  do {
    const Offset<Dim> off(mesh, element, xi, x);
    before = xi;
    xi = (xi + off.slope.inverse() * off.vector).cwiseMax(-1).cwiseMin(1);
  } while ((xi - before).cwiseAbs().maxCoeff() > 1e-14 && ++steps < 20);
  Found found{{element, {}}, Offset<Dim>(mesh, element, xi, x).vector.squaredNorm()};
  for (int d = 0; d < Dim; ++d) found.place.xi[d] = xi[d];
  return found;
}

Found nearest(const SolidMesh& mesh, int element, const std::array<double, 3>& x) {
  return mesh.dim == 2 ? nearest_in<2>(mesh, element, x) : nearest_in<3>(mesh, element, x);
}

/// Of squared distances.
double round_off_of(const SolidMesh& mesh) {
  const std::array<double, 3>&first = mesh.nodes[mesh.elements[0][0]], &opposite = mesh.nodes[mesh.elements[0][2]];
  double sum = 0;
  for (int d = 0; d < mesh.dim; ++d) sum += 1e-20 * (first[d] - opposite[d]) * (first[d] - opposite[d]);
  return sum;
}

}  // namespace

bool is_inside(const SolidMesh& mesh, const std::array<double, 3>& x) {
  const double round_off = round_off_of(mesh);
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e)
    if (square_to_box(mesh, e, x) <= round_off && nearest(mesh, e, x).square <= round_off) return true;
  return false;
}

MeshPlace place_in_mesh(const SolidMesh& mesh, const std::array<double, 3>& x) {
  expect(!mesh.elements.empty());
  const double round_off = round_off_of(mesh);
  Found best;
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    if (square_to_box(mesh, e, x) + round_off >= best.square) continue;
    const Found found = nearest(mesh, e, x);
    if (found.square + round_off < best.square) best = found;
  }
  return best.place;
}

}  // namespace greenwater
