#include "kernels/speed.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace greenwater {
namespace {

template <int Dim>
real max_speed_in(const Fluid& fluid) {
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const real infinite = std::numeric_limits<real>::infinity();
  real fastest2 = 0;
  Kokkos::parallel_reduce(
      "greenwater::max_speed", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, real& most) {
        const auto ui = load<Dim>(u, i);
        const real speed2 = dot(ui, ui);
        most = larger(most, speed2 < infinite ? speed2 : infinite);  // a maximum would overlook what is no number
      },
      Kokkos::Max<real>(fastest2));
  if (fastest2 == infinite) return std::numeric_limits<real>::quiet_NaN();
  return std::sqrt(larger(fastest2, real(0)));
}

// Rung k holds the speeds from v_(k+1) to v_k = max 2^(-k/4); the last one reaches down to 0.
constexpr int rungs = 33;

real top_of(int rung, real fastest) { return rung < rungs ? fastest * std::exp2(real(-rung) / 4) : real(0); }

/// How many particles stand on each rung. A functor and not a lambda, because that is how every Kokkos from 3.4 on sums
/// an array.
template <int Dim>
struct CountOnRungs {
  using value_type = int[];
  unsigned value_count = rungs;
  Read<VectorField> u;
  real top2[rungs];  // v_k^2 [m^2/s^2]

  KOKKOS_INLINE_FUNCTION void operator()(const int i, int* number) const {
    const auto ui = load<Dim>(u, i);
    const real speed2 = dot(ui, ui);
    int rung = 0;
    for (int k = 1; k < rungs; ++k) rung += speed2 <= top2[k] ? 1 : 0;
    ++number[rung];
  }
};

template <int Dim>
std::array<int, rungs> count_on_rungs(const Fluid& fluid, real fastest) {
  CountOnRungs<Dim> count;
  count.u = fluid.particles.velocity;
  for (int k = 0; k < rungs; ++k) count.top2[k] = top_of(k, fastest) * top_of(k, fastest);
  std::array<int, rungs> number{};
  const Kokkos::View<int*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> result(number.data(), rungs);
  Kokkos::parallel_reduce("greenwater::max_speed_rungs", Range(0, fluid.particles.count), count, result);
  Kokkos::fence();  // with a view as its result a reduction need not be done when it returns
  return number;
}

}  // namespace

real max_speed(const Fluid& fluid) {
  return fluid.particles.dim == 2 ? max_speed_in<2>(fluid) : max_speed_in<3>(fluid);
}

real bulk_speed(const Fluid& fluid) {
  constexpr double drops = 1e-3;  // of all particles
  const real fastest = max_speed(fluid);
  if (!(fastest > 0)) return fastest;
  const auto number = fluid.particles.dim == 2 ? count_on_rungs<2>(fluid, fastest) : count_on_rungs<3>(fluid, fastest);
  double left = drops * fluid.particles.count;  // of those who may be faster
  int rung = 0;
  for (; number[rung] <= left; ++rung) left -= number[rung];
  const real top = top_of(rung, fastest), bottom = top_of(rung + 1, fastest);
  return top - (top - bottom) * static_cast<real>(left / number[rung]);
}

}  // namespace greenwater
