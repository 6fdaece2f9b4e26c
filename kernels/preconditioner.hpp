#pragma once
// What stands between a residual and a direction of search: z = M r with M near the inverse of A, symmetric and positive.

#include <memory>

#include "kernels/pressure_system.hpp"

namespace greenwater {

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Looks at the assembled system, once each step.
  virtual void update(const PressureSystem& system) = 0;
  /// z = M r; r must be 0 where the surface is, and z is. Returns r . z.
  virtual accum apply(const ScalarField& r, const ScalarField& z) const = 0;
};

/// z = r
std::unique_ptr<Preconditioner> make_identity();
/// z = r / diagonal (Jacobi)
std::unique_ptr<Preconditioner> make_jacobi();

}  // namespace greenwater
