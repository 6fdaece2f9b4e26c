#include "kernels/moves.hpp"

#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace greenwater {
namespace {

void find_places(const Before& before) {
  const auto id = Read<IndexField>(before.particles.id);
  const auto place = before.place;
  Kokkos::parallel_for(
      "greenwater::undo_find_places", Range(0, before.particles.count),
      KOKKOS_LAMBDA(const int i) { place(id(i)) = i; });
}

template <int Dim>
real longest_way_in(const Fluid& fluid, const Before& before) {
  const auto id = Read<IndexField>(fluid.particles.id), place = Read<IndexField>(before.place);
  const auto x = Read<CoordField>(fluid.particles.position), x0 = Read<CoordField>(before.particles.position);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto neighbours = Read<IndexField>(fluid.rows.near.number);
  const GridShape grid = fluid.grid.shape();
  const coord infinite = std::numeric_limits<coord>::infinity();
  coord most2 = 0;
  Kokkos::parallel_reduce(
      "greenwater::undo_longest_way", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, coord& most) {
        const auto way = way_between(grid, load<Dim>(x0, place(id(i))), load<Dim>(x, i));
        const auto ui = load<Dim>(u, i);
        const coord way2 = dot(way, way), counts = neighbours(i) > Dim ? way2 : 0;
        most =
            larger(most, way2 + dot(ui, ui) < infinite ? counts : infinite);  // a maximum overlooks what is no number
      },
      Kokkos::Max<coord>(most2));
  if (most2 == infinite) return std::numeric_limits<real>::quiet_NaN();
  return static_cast<real>(std::sqrt(larger(most2, coord(0))));
}

template <int Dim>
int pairs_run_together_in(const Fluid& fluid, const Before& before, real distance) {
  const auto near = around<Dim>(fluid);
  const auto id = Read<IndexField>(fluid.particles.id), place = Read<IndexField>(before.place);
  const auto x0 = Read<CoordField>(before.particles.position);
  const int count = fluid.particles.count;
  int pairs = 0;
  Kokkos::parallel_reduce(
      "greenwater::undo_pairs_run_together", packs(count),
      KOKKOS_LAMBDA(const int pack, int& sum) {
        const int i = pack * pack_lanes;
        near.for_each_neighbour(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto&) {
          const Pack r2 = dot(r, r);
          const unsigned bits = lane_bits(r2 < distance * distance);
          if (bits == 0) return;
          for (int l = 0; l < pack_lanes; ++l) {
            if (!(bits >> l & 1) || i + l >= count || lane(j, l) > i + l) continue;  // each pair once
            const auto from = load<Dim>(x0, place(id(i + l))), to = load<Dim>(x0, place(id(lane(j, l))));
            const auto had = way_between(near.grid, from, to);
            if (lane(r2, l) < dot(had, had) / 4) ++sum;
          }
        });
      },
      pairs);
  return pairs;
}

}  // namespace

void keep(const Particles& particles, Before& before) {
  copy(particles, before.particles);
  if (before.place.extent(0) != particles.id.extent(0))
    before.place = uncleared<IndexField>("greenwater::undo_place", particles.id.extent(0));
  find_places(before);
}

void put_back(const Before& before, Particles& particles) {
  expect(particles.extras.size() == before.particles.extras.size());
  copy(before.particles, particles);
}

real longest_way(const Fluid& fluid, const Before& before) {
  return fluid.particles.dim == 2 ? longest_way_in<2>(fluid, before) : longest_way_in<3>(fluid, before);
}

int pairs_run_together(const Fluid& fluid, const Before& before, real distance) {
  return fluid.particles.dim == 2 ? pairs_run_together_in<2>(fluid, before, distance)
                                  : pairs_run_together_in<3>(fluid, before, distance);
}

}  // namespace greenwater
