#pragma once
// Shape functions of the reference element [-1, 1]^Dim.

#include <array>

namespace greenwater::element {

template <int Dim>
using Point = std::array<double, Dim>;

/// Corner a of the reference element: the first four nodes go round, the next four lie above them.
template <int Dim>
Point<Dim> corner(int a) {
  Point<Dim> xi;
  xi[0] = a % 4 == 1 || a % 4 == 2 ? 1 : -1;
  xi[1] = a % 4 >= 2 ? 1 : -1;
  if constexpr (Dim == 3) xi[2] = a >= 4 ? 1 : -1;
  return xi;
}

/// Shape functions and their slopes at one point of the reference element.
template <int Dim>
struct Functions {
  Point<Dim> xi;
  double shape[1 << Dim];       // N_a
  double slope[1 << Dim][Dim];  // dN_a/dxi_k

  explicit Functions(const Point<Dim>& at) : xi(at) {
    for (int a = 0; a < 1 << Dim; ++a) {
      const Point<Dim> c = corner<Dim>(a);
      shape[a] = 1;
      for (int k = 0; k < Dim; ++k) {
        shape[a] *= (1 + c[k] * xi[k]) / 2;
        slope[a][k] = c[k] / 2;
        for (int d = 0; d < Dim; ++d) slope[a][k] *= d == k ? 1 : (1 + c[d] * xi[d]) / 2;
      }
    }
  }
};

}  // namespace greenwater::element
