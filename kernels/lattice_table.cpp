#include "kernels/lattice_table.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {

ShiftFunction shift_function(const Weight& w, real l0) {
  return {1 / w.radius, 1 / ShiftFunction::value(l0 / w.radius)};
}

namespace {

// Of a symmetric matrix, by size; by powers of it.
double largest_eigenvalue(const double (&A)[3][3]) {
  double v[3] = {1, 0.7, 0.4}, length = 0;
  for (int power = 0; power < 50; ++power) {
    double next[3] = {};
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) next[d] += A[d][e] * v[e];
    length = std::hypot(next[0], next[1], next[2]);
    if (length == 0) return 0;
    for (int d = 0; d < 3; ++d) v[d] = next[d] / length;
  }
  return length;
}

// Largest eigenvalue of the gradient that shifts, for small waves of disorder on the lattice [1/m^2].
double shift_stiffness(const Weight& weight, int dim, double l0) {
  const ShiftFunction shift = shift_function(weight, static_cast<real>(l0));
  const int reach = static_cast<int>(std::ceil(weight.radius / l0)), across = dim == 3 ? reach : 0;
  constexpr int waves = 8;
  constexpr double pi = 3.14159265358979323846;
  double stiffest = 0;
  for (int a = 0; a <= waves; ++a)
    for (int b = 0; b <= a; ++b)
      for (int c = 0; c <= (dim == 3 ? b : 0); ++c) {
        double A[3][3] = {};
        for (int kx = -reach; kx <= reach; ++kx)
          for (int ky = -reach; ky <= reach; ++ky)
            for (int kz = -across; kz <= across; ++kz) {
              const double x[3] = {l0 * kx, l0 * ky, l0 * kz};
              const double r = std::hypot(x[0], x[1], x[2]), step = 1e-4 * l0;
              if (r == 0 || r >= weight.radius) continue;
              const double slope = shift.slope(r),
                           change = (shift.slope(r + step) - shift.slope(r - step)) / (2 * step);
              const double wave = 1 - std::cos(pi / waves * (a * kx + b * ky + c * kz));
              for (int d = 0; d < dim; ++d)
                for (int e = 0; e < dim; ++e) A[d][e] += wave * ((d == e ? slope : 0) + change / r * x[d] * x[e]);
            }
        stiffest = std::max(stiffest, largest_eigenvalue(A));
      }
  return stiffest;
}

}  // namespace

LatticeTable make_lattice_table(const Weight& weight, int dim, coord spacing) {
  const int reach = static_cast<int>(std::ceil(weight.radius / spacing));
  const int across = dim == 3 ? reach : 0;
  double n0 = 0, n[3] = {}, S[3] = {};
  int near = 0;
  for (int ky = -reach; ky <= reach; ++ky)
    for (int kx = -reach; kx <= reach; ++kx)
      for (int kz = -across; kz <= across; ++kz) {
        const double r = std::sqrt(static_cast<double>(kx * kx + ky * ky + kz * kz));
        if (r == 0) continue;
        const double w = weight(static_cast<real>(r * spacing));
        near += w > 0;
        n0 += w;
        for (int row = 0; row < 3; ++row) {
          if (ky > row) continue;
          n[row] += w;
          S[row] -= w * ky;
        }
      }
  LatticeTable table{};
  for (int row = 0; row < 3; ++row) {
    table.missing[row] = static_cast<real>(1 - n[row] / n0);
    table.tilt[row] = static_cast<real>(S[row] / n[row]);
  }
  const double m = table.missing[0];
  // The second row is at the surface where its view is clearly one-sided; with a small radius it is not.
  const bool second = table.tilt[1] > table.tilt[0] / 5;
  table.full = second ? real(0.9) * table.tilt[1] : real(0.5) * table.tilt[0];
  table.none = table.full / 2;
  table.bulge = static_cast<real>((S[0] / n0 / 0.5 / m - 1) / m);
  table.shift = static_cast<real>(1 / shift_stiffness(weight, dim, spacing));
  table.few = near / 3;
  return table;
}

}  // namespace greenwater
