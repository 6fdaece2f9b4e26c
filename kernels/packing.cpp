#include "kernels/packing.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

// Of the lattice's waves the stiffest is undone by a push of 1 / 1.64 (2-D, radius 2.1 l0); beyond twice that it would grow.
constexpr real rate = real(0.3), most_way = real(0.15);  // x spacing
// How much more of it those give and take who are crowded. Without it n is off by a third more where rows end; with twice
// as much steps have to be shorter.
constexpr real crowded = 3;

template <int Dim>
void find_push(const Fluid& fluid, const VectorField& push) {
  const auto near = around<Dim>(fluid);
  const auto w = fluid.density.weight;
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  const real n0 = fluid.density.reference.n0, per_n0 = crowded / n0;
  const real l0 = static_cast<real>(fluid.spacing), factor = -rate * l0 / n0;
  const real touching = static_cast<real>(1e-6) * l0;
  Kokkos::parallel_for(
      "greenwater::find_push", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const Pack own = load_pack(n, i);
        Vec<Dim, Pack> sum{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack distance = sqrt(dot(r, r)), both = 1 + per_n0 * (own + gather_pack(n, j) - 2 * n0);
          const Pack force = smaller(larger(both, Pack{}), all_lanes<Pack>(real(2))) * image.share * w(distance);
          sum = along(sum, zero_unless(distance > touching, force / distance), r);
        });
        store_pack(push, i, along(Vec<Dim, Pack>{}, all_lanes<Pack>(factor), sum));
      });
}

template <int Dim>
void add_push(const Fluid& fluid, const VectorField& push, real kept, const VectorField& way) {
  const real cap = most_way * static_cast<real>(fluid.spacing);
  Kokkos::parallel_for(
      "greenwater::add_push", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        Vec<Dim, real> v;
        for (int d = 0; d < Dim; ++d) v[d] = kept * way(i, d) + push(i, d);
        const real length = sqrt(dot(v, v)), scale = length > cap ? cap / length : real(1);
        for (int d = 0; d < Dim; ++d) way(i, d) = scale * v[d];
      });
}

template <int Dim>
void go_in_sight_in(const Fluid& fluid, const VectorField& way) {
  const auto x = fluid.particles.position;
  const auto walls = fluid.walls;
  const auto grid = fluid.grid.shape();
  Kokkos::parallel_for(
      "greenwater::go_in_sight", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        const auto from = load<Dim>(x, i);
        Vec<Dim, coord> to;
        for (int d = 0; d < Dim; ++d) to[d] = from[d] + way(i, d);
        if (sight_from(walls, grid, from).sees(from, to)) store(x, i, to);
      });
}

void settle(Fluid& fluid) {
  fluid.grid.sort(fluid.particles);
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
}

void sweep(Fluid& fluid, real kept) {
  const VectorField push = fluid.particles.acceleration, way = fluid.particles.velocity;  // of no use before a run
  if (fluid.particles.dim == 2) {
    find_push<2>(fluid, push);
    add_push<2>(fluid, push, kept, way);
  } else {
    find_push<3>(fluid, push);
    add_push<3>(fluid, push, kept, way);
  }
  go_in_sight(fluid, way);
  settle(fluid);
}

}  // namespace

Unevenness unevenness_of(const Fluid& fluid) {
  if (fluid.particles.count == 0) return {};
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  const accum n0 = fluid.density.reference.n0;
  accum squares = 0;
  real most = 0;
  Kokkos::parallel_reduce(
      "greenwater::unevenness", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, accum& sum) { sum += (n(i) / n0 - 1) * (n(i) / n0 - 1); }, squares);
  Kokkos::parallel_reduce(
      "greenwater::largest_unevenness", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, real& largest) { largest = larger(largest, static_cast<real>(fabs(n(i) / n0 - 1))); },
      Kokkos::Max<real>(most));
  return {std::sqrt(squares / fluid.particles.count), most};
}

void go_in_sight(Fluid& fluid, const VectorField& way) {
  fluid.particles.dim == 2 ? go_in_sight_in<2>(fluid, way) : go_in_sight_in<3>(fluid, way);
}

Packing spread_evenly(Fluid& fluid, const PackingOptions& options) {
  constexpr double even = 1e-4;   // rms of n: nothing to be gained
  constexpr double worth = 0.99;  // of the lowest rms so far
  constexpr int look_every = 10;  // sweeps
  Kokkos::deep_copy(fluid.particles.velocity, real(0));
  settle(fluid);
  Packing done;
  done.before = done.after = unevenness_of(fluid);
  // A wave as long as 2 L: its frequency is sqrt(0.3 x 0.75) pi / L per sweep, and twice that damps it critically.
  const double lost = std::clamp(3 / options.longest, 0.02, 0.5);
  const int patience = static_cast<int>(std::ceil(std::max(30.0, 3 / lost)));  // sweeps
  Particles best;
  copy(fluid.particles, best);
  for (int at_best = 0; done.after.rms > even && done.sweeps < options.sweeps;) {
    sweep(fluid, static_cast<real>(1 - lost));
    if (++done.sweeps % look_every != 0) continue;
    const Unevenness now = unevenness_of(fluid);
    if (now.rms < worth * done.after.rms) {
      done.after = now;
      at_best = done.sweeps;
      copy(fluid.particles, best);
    } else if (done.sweeps - at_best >= patience) {
      break;
    }
  }
  copy(best, fluid.particles);
  settle(fluid);
  return done;
}

}  // namespace greenwater
