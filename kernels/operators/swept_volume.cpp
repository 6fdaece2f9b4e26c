#include "kernels/operators/swept_volume.hpp"

#include <cmath>

namespace greenwater {

real source_per_volume(const Fluid& fluid, double dt) {
  return static_cast<real>(-fluid.rho / (dt * std::pow(fluid.spacing, fluid.particles.dim)));
}

void SweptVolume::add_to(const ScalarField& b, const FlagField& fixed, real factor) {
  if (entries_.empty()) return;
  if (one_.extent(0) == 0) {
    one_ = ScalarField("greenwater::swept_unit", 1);
    Kokkos::deep_copy(one_, real(1));
  }
  term_.set_rows(1, entries_);
  term_.add_source(fixed, factor, one_, b);
  entries_.clear();
}

}  // namespace greenwater
