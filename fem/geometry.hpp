#pragma once
// One element before it moves: gradients of its shape functions and weights at the 2^dim points of Gauss.

#include <array>

#include "core/solid_mesh.hpp"

namespace greenwater::element {

template <int Dim>
struct Geometry {
  static constexpr int nodes = 1 << Dim;
  static constexpr int points = 1 << Dim;

  double place[nodes][Dim] = {};             // X     from the mean of the nodes [m]
  double gradient[points][nodes][Dim] = {};  // dN_a/dX at the points [1/m]
  double centre[nodes][Dim] = {};            // dN_a/dX at the centre [1/m]
  double weight[points] = {};                // volume of the points; in 2-D area times thickness [m3]
  double share[nodes] = {};                  // integral of N_a [m3]
  // Gradients of the incompatible modes 1 - xi_k^2, up to a length: with the centre's Jacobian, scaled by j0/j, so that
  // their integral is zero and constant strain stays exact (Taylor, Beresford, Wilson, IJNME 10:1211, 1976) [-]
  double mode[points][Dim][Dim] = {};

  double volume() const {
    double sum = 0;
    for (const double w : weight) sum += w;
    return sum;
  }
};

/// Throws CaseError, naming the element and its place, for one that is inverted or degenerate at a point of Gauss or at
/// a corner. `thickness` [m] is that of a 2-D element.
template <int Dim>
Geometry<Dim> geometry_of(const SolidMesh& mesh, int element, double thickness);

/// What Geometry has at the points of Gauss, at any other.
template <int Dim>
struct LocalGradients {
  double shape[1 << Dim][Dim] = {};  // dN_a/dX [1/m]
  double mode[Dim][Dim] = {};        // of the incompatible modes [-]
};

/// At natural coordinates xi, each from -1 to 1.
template <int Dim>
LocalGradients<Dim> gradients_at(const Geometry<Dim>& g, const std::array<double, 3>& xi);

}  // namespace greenwater::element
