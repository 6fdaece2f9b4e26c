#include "kernels/pressure_vectors.hpp"

namespace greenwater {

void hold_surface(const FlagField& fixed, const ScalarField& p, int count) {
  Kokkos::parallel_for(
      "greenwater::hold_surface", Range(0, count), KOKKOS_LAMBDA(const int i) {
        if (fixed(i)) p(i) = 0;
      });
}

void clear_pressure(const ScalarField& p, int count) {
  Kokkos::parallel_for(
      "greenwater::clear_pressure", Range(0, count), KOKKOS_LAMBDA(const int i) { p(i) = 0; });
}

}  // namespace greenwater
