#include "kernels/blas.hpp"

#ifdef GREENWATER_HAVE_KOKKOS_KERNELS
#include <KokkosBlas1_axpby.hpp>
#include <KokkosBlas1_dot.hpp>
#endif

namespace greenwater::blas {

#ifdef GREENWATER_HAVE_KOKKOS_KERNELS

namespace {
auto begin_of(const ScalarField& x, int count) { return Kokkos::subview(x, Kokkos::make_pair(0, count)); }
}  // namespace

accum dot(const ScalarField& x, const ScalarField& y, int count) {
  return count == 0 ? 0 : KokkosBlas::dot(begin_of(x, count), begin_of(y, count));
}

void axpby(real a, const ScalarField& x, real b, const ScalarField& y, int count) {
  if (count > 0) KokkosBlas::axpby(a, begin_of(x, count), b, begin_of(y, count));
}

#else

accum dot(const ScalarField& x, const ScalarField& y, int count) {
  accum sum = 0;
  Kokkos::parallel_reduce(
      "greenwater::dot", Range(0, count), KOKKOS_LAMBDA(const int i, accum& s) { s += accum(x(i)) * y(i); }, sum);
  return sum;
}

void axpby(real a, const ScalarField& x, real b, const ScalarField& y, int count) {
  Kokkos::parallel_for(
      "greenwater::axpby", Range(0, count),
      KOKKOS_LAMBDA(const int i) { y(i) = b == 0 ? a * x(i) : a * x(i) + b * y(i); });  // b = 0: y may hold anything
}

#endif

}  // namespace greenwater::blas
