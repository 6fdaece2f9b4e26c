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

/// X(xi) = x by Newton's steps, each brought back into the element.
template <int Dim>
Found nearest_in(const SolidMesh& mesh, int element, const std::array<double, 3>& x) {
  using Vector = Eigen::Matrix<double, Dim, 1>;
  Vector xi = Vector::Zero(), off;
  const auto look = [&](auto&& use) {
    element::Point<Dim> at;
    for (int d = 0; d < Dim; ++d) at[d] = xi[d];
    const element::Functions<Dim> n(at);
    Eigen::Matrix<double, Dim, Dim> j = Eigen::Matrix<double, Dim, Dim>::Zero();
    for (int d = 0; d < Dim; ++d) off[d] = x[d];
    for (int a = 0; a < 1 << Dim; ++a) {
      const auto& node = mesh.nodes[mesh.elements[element][a]];
      for (int d = 0; d < Dim; ++d) {
        off[d] -= n.shape[a] * node[d];
        for (int k = 0; k < Dim; ++k) j(d, k) += n.slope[a][k] * node[d];
      }
    }
    use(j);
  };
  for (int step = 0; step < 20; ++step) {
    double moved = 0;
    look([&](const auto& j) {
      const Vector before = xi;
      xi = (xi + j.inverse() * off).cwiseMax(-1).cwiseMin(1);
      moved = (xi - before).template lpNorm<Eigen::Infinity>();
    });
    if (moved < 1e-14) break;
  }
  look([](const auto&) {});
  Found found{{element, {}}, off.squaredNorm()};
  for (int d = 0; d < Dim; ++d) found.place.xi[d] = xi[d];
  return found;
}

}  // namespace

MeshPlace place_in_mesh(const SolidMesh& mesh, const std::array<double, 3>& x) {
  expect(!mesh.elements.empty());
  double size = 0;
  for (int d = 0; d < mesh.dim; ++d)
    for (const int node : mesh.elements[0])
      size = std::max(size, std::abs(mesh.nodes[node][d] - mesh.nodes[mesh.elements[0][0]][d]));
  const double round_off = 1e-20 * size * size;
  Found best;
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    if (square_to_box(mesh, e, x) + round_off >= best.square) continue;
    const Found found = mesh.dim == 2 ? nearest_in<2>(mesh, e, x) : nearest_in<3>(mesh, e, x);
    if (found.square + round_off < best.square) best = found;
  }
  return best.place;
}

}  // namespace greenwater
