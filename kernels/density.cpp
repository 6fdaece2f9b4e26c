#include "kernels/density.hpp"

namespace greenwater {
namespace {

template <int Dim>
void mark_surface_in(const Fluid& fluid, real ratio, const FlagField& surface) {
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  const auto neighbours = Read<IndexField>(fluid.rows.near.number);
  const real limit = ratio * fluid.density.reference.n0;
  Kokkos::parallel_for(
      "greenwater::mark_surface", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i) { surface(i) = n(i) < limit || neighbours(i) < Dim + 1; });
}

}  // namespace

void mark_surface(Fluid& fluid, real ratio) {
  const FlagField surface = fluid.particles.surface;
  fluid.particles.dim == 2 ? mark_surface_in<2>(fluid, ratio, surface) : mark_surface_in<3>(fluid, ratio, surface);
}

real largest_compression(const Fluid& fluid) {
  if (fluid.particles.count == 0) return 0;
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  real largest = 0;
  Kokkos::parallel_reduce(
      "greenwater::largest_compression", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, real& most) { most = larger(most, n(i)); }, Kokkos::Max<real>(largest));
  return largest / fluid.density.reference.n0 - 1;
}

}  // namespace greenwater
