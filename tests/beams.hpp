#pragma once
// Timoshenko's cantilever, and the plates of polycarbonate as meshes.

#include <vector>

#include "fem/loads.hpp"
#include "fem/solid.hpp"
#include "fem/supports.hpp"

namespace greenwater::test {

/// A beam of unit width, clamped at 0 and free at its length.
struct Beam {
  double young = 0, shear = 0;    // E (or that of plane strain), G [Pa]
  double density = 0;             // [kg/m3]
  double height = 0, length = 0;  // h, L [m]
  double gyration = 1.0 / 12;     // of the cross-section's mass: squared radius over h^2
  double shear_area = 5.0 / 6;    // over h

  double bending() const { return young * height * height * height / 12; }  // E I [N m]
  double shearing() const { return shear_area * shear * height; }           // kappa G A [N/m]
  /// Natural frequencies [Hz], from the zeros of the determinant of clamped and free ends.
  std::vector<double> frequencies(int count) const;
  /// Tip under p [Pa] from the root to s [m]; and under a triangle of p at the root and nothing at the tip [m].
  double tip_of_partial(double p, double s) const;
  double tip_of_triangle(double p) const;
};

enum class Sides {
  beam,  // free, and the foot free to contract sideways: a beam
  free,  // free, the foot held
  held   // the width kept everywhere: plane strain
};

/// A plate 0.1 m high and 0.2 m wide, clamped at its foot: thickness along x, height along y, width along z.
struct Plate {
  Solid solid;
  Supports supports;
  double thickness;
  Sides sides;

  /// What a thin piece of it is as a beam.
  Beam beam() const;
  /// Mean displacement along x of the nodes at the tip [m].
  double tip(const Eigen::VectorXd& u) const;
};

Plate polycarbonate(double thickness, Sides sides, const SolidOptions& options, const std::array<int, 3>& divisions);
inline Plate polycarbonate(double thickness, Sides sides, const SolidOptions& options = {}) {
  return polycarbonate(thickness, sides, options, {1, 100, 1});
}

}  // namespace greenwater::test
