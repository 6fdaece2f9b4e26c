#pragma once
// All elements of a body, as many at a time as a register holds.

#include <array>
#include <memory>

#include "fem/element_rules.hpp"
#include "fem/pack.hpp"

namespace greenwater::element {

class Elements {
 public:
  virtual ~Elements() = default;

  /// The force on every node of every element at u [N], which the next call overwrites.
  virtual const double* forces(const double* u) = 0;
  /// Where in them the force on a node of an element begins; those along the other axes follow `lanes` apart.
  virtual int place_of(int element, int node) const = 0;
  virtual double energy(const double* u) const = 0;
  /// d2W/du2 of one element, row by row [N/m].
  virtual void tangent(const SolidMesh& mesh, int element, const double* u, double* k) const = 0;
  virtual Stress stress(const SolidMesh& mesh, int element, const double* u, const std::array<double, 3>& xi) const = 0;
};

/// Elements that are equal up to a translation share what is stored of them.
std::unique_ptr<Elements> make_elements(const SolidMesh& mesh, const Rules& rules, Kinematics kinematics,
                                        double thickness);

}  // namespace greenwater::element
