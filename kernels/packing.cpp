#include "kernels/packing.hpp"

namespace greenwater {
namespace {

constexpr real rate = real(0.6), most = real(0.15);  // x spacing

template <int Dim>
void find_way_in(const Fluid& fluid, const VectorField& way) {
  const auto near = around<Dim>(fluid);
  const auto w = fluid.density.weight;
  const real l0 = static_cast<real>(fluid.spacing), factor = -rate * l0 / fluid.density.reference.n0, cap = most * l0;
  const real touching = static_cast<real>(1e-6) * l0;
  Kokkos::parallel_for(
      "greenwater::find_way", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        Vec<Dim, Pack> sum{};
        near.for_each(i, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack distance = sqrt(dot(r, r));
          sum = along(sum, zero_unless(distance > touching, image.share * w(distance) / distance), r);
        });
        const Pack length = fabs(factor) * sqrt(dot(sum, sum));
        const Pack scale = select(length > cap, factor * cap / length, all_lanes<Pack>(factor));
        store_pack(way, i, along(Vec<Dim, Pack>{}, scale, sum));
      });
}

template <int Dim>
void go_way_in(const Fluid& fluid, const VectorField& way) {
  const auto x = fluid.particles.position;
  const auto walls = fluid.walls;
  const auto grid = fluid.grid.shape();
  Kokkos::parallel_for(
      "greenwater::go_way", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        const auto from = load<Dim>(x, i);
        Vec<Dim, coord> to;
        for (int d = 0; d < Dim; ++d) to[d] = from[d] + way(i, d);
        if (sight_from(walls, grid, from).sees(from, to)) store(x, i, to);
      });
}

}  // namespace

void spread_evenly(Fluid& fluid, int sweeps) {
  const bool flat = fluid.particles.dim == 2;
  for (int sweep = 0; sweep <= sweeps; ++sweep) {
    fluid.grid.sort(fluid.particles);
    fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
    if (sweep == sweeps) break;
    const VectorField way = fluid.particles.acceleration;  // it means nothing before the first step
    flat ? find_way_in<2>(fluid, way) : find_way_in<3>(fluid, way);
    flat ? go_way_in<2>(fluid, way) : go_way_in<3>(fluid, way);
  }
}

}  // namespace greenwater
