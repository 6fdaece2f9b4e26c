#include "kernels/pressure_system.hpp"

namespace greenwater {
namespace {

real laplacian_factor(const Fluid& fluid) {
  const Reference& lattice = fluid.laplacian.reference;
  return 2 * fluid.particles.dim / (lattice.lambda * lattice.n0);  // K
}

void diagonal_of(const Fluid& fluid, const PressureOptions& options, real dt, const ScalarField& diagonal) {
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const auto sum = fluid.rows.near.weight_sum;
  const real C_K = options.diagonal_factor * laplacian_factor(fluid);
  const real shift = fluid.rho * options.compressibility / (dt * dt);
  Kokkos::parallel_for(
      "greenwater::pressure_diagonal", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i) { diagonal(i) = fixed(i) ? real(1) : static_cast<real>(C_K * sum(i) + shift); });
}

void raise(const ScalarField& diagonal, const FlagField& fixed, real part, int count) {
  Kokkos::parallel_for(
      "greenwater::raise_diagonal", Range(0, count), KOKKOS_LAMBDA(const int i) {
        if (!fixed(i)) diagonal(i) *= 1 + part;
      });
}

void density_source(const Fluid& fluid, real gamma, real dt, const ScalarField& b) {
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const real n0 = fluid.density.reference.n0;
  const real factor = gamma * fluid.rho / (dt * dt);
  Kokkos::parallel_for(
      "greenwater::density_source", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i) { b(i) = fixed(i) ? real(0) : factor * (n(i) - n0) / n0; });
}

template <int Dim>
void divergence_source_in(const Fluid& fluid, real dt, const ScalarField& b) {
  const auto near = around_unmoved<Dim>(fluid, fluid.gradient.weight);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const auto w = fluid.gradient.weight;
  const real factor = -fluid.rho / dt * Dim / fluid.gradient.reference.n0;
  const real touching = static_cast<real>(1e-12 * fluid.spacing * fluid.spacing);
  Kokkos::parallel_for(
      "greenwater::divergence_source", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto ui = load_pack<Dim>(u, i);
        Pack div{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const auto uj = image.velocity(gather_pack<Dim>(u, j));
          const Pack r2 = dot(r, r);
          const Pack weight = image.weight(w, r2) * inverse(larger(r2, all_lanes<Pack>(touching)));
          div += zero_unless(r2 > touching, dot(difference(uj, ui), r) * weight);
        });
        for (int l = 0; l < pack_lanes; ++l) b(i + l) = fixed(i + l) ? real(0) : factor * lane(div, l);
      });
}

// A p from sums over rows, which it also returns; p is 0 where the surface is, so that no entry needs to be left out.
KOKKOS_INLINE_FUNCTION Pack store_product(const Read<FlagField>& fixed, real K, const ScalarField& diagonal,
                                          const Pack& p, const Pack& sum, int i, int count, const ScalarField& Ap) {
  const Pack held = convert_lanes<Pack>(load_pack(fixed, i));
  const Pack product = first_lanes(count - i, zero_unless(held == 0, load_pack(diagonal, i) * p - K * sum));
  store_lanes(&Ap(i), product);
  return product;
}

accum apply_kept(const Fluid& fluid, const Rows& near, real K, const FlagField& held, const ScalarField& diagonal,
                 const ScalarField& p, const ScalarField& Ap) {
  const auto fixed = Read<FlagField>(held);
  const int count = fluid.particles.count;
  accum energy = 0;
  Kokkos::parallel_reduce(
      "greenwater::apply_pressure", row_packs(count),
      KOKKOS_LAMBDA(const int rows, accum& energy_of_all) {
        constexpr int parts = float_lanes / pack_lanes;  // all rows of a chunk at once, as they share cache lines
        Pack sum[parts] = {};
        add_row_products(near, p.data(), rows * float_lanes, sum);
        for (int part = 0; part < parts; ++part) {
          const int i = rows * float_lanes + part * pack_lanes;
          const Pack own = first_lanes(count - i, load_pack(p, i));
          energy_of_all += sum_lanes(own * store_product(fixed, K, diagonal, own, sum[part], i, count, Ap));
        }
      },
      energy);
  return energy;
}

// The weights are rounded as those that are kept, so that both ways give the same operator.
template <int Dim>
accum apply_recomputed_in(const Fluid& fluid, real K, const FlagField& held, const ScalarField& diagonal,
                          const ScalarField& p, const ScalarField& Ap) {
  const auto near = around<Dim>(fluid);
  const auto w = fluid.laplacian.weight;
  const auto fixed = Read<FlagField>(held);
  const int count = fluid.particles.count;
  accum energy = 0;
  Kokkos::parallel_reduce(
      "greenwater::apply_pressure", packs(count),
      KOKKOS_LAMBDA(const int pack, accum& total) {
        const int i = pack * pack_lanes;
        const Pack place = convert_lanes<Pack>(counted_lanes<IndexPack>() + i);
        Pack sum{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack exact = image.share * w(sqrt(dot(r, r)));
          const Pack weight = convert_lanes<Pack>(convert_lanes<Lanes<float, pack_lanes>>(exact));
          sum += zero_unless(convert_lanes<Pack>(j) != place, weight * gather_pack(p, j));
        });
        const Pack own = first_lanes(count - i, load_pack(p, i));
        total += sum_lanes(own * store_product(fixed, K, diagonal, own, sum, i, count, Ap));
      },
      energy);
  return energy;
}

}  // namespace

void PressureSystem::assemble(const Fluid& fluid, real dt) {
  fluid_ = &fluid;
  weights_ = {};
  closed_ = false;
  fixed_ = fluid.particles.surface;
  if (rhs_.extent(0) < fluid.particles.id.extent(0)) {
    rhs_ = uncleared<ScalarField>("greenwater::pressure_rhs", fluid.particles.id.extent(0));
    diagonal_ = uncleared<ScalarField>("greenwater::pressure_diagonal", fluid.particles.id.extent(0));
  }
  const bool flat = fluid.particles.dim == 2;
  diagonal_of(fluid, options_, dt, diagonal_);
  if (options_.source == PressureSource::density)
    density_source(fluid, options_.source_factor, dt, rhs_);
  else
    flat ? divergence_source_in<2>(fluid, dt, rhs_) : divergence_source_in<3>(fluid, dt, rhs_);
}

void PressureSystem::assemble(const Fluid& fluid, const ScalarField& rhs, const ScalarField& diagonal,
                              const FlagField& fixed) {
  fluid_ = &fluid;
  weights_ = {};
  closed_ = false;
  rhs_ = rhs;
  diagonal_ = diagonal;
  fixed_ = fixed;
}

void PressureSystem::replace_rows(const FloatField& weights, const ScalarField& diagonal) {
  weights_ = weights;
  row_diagonal_ = diagonal;
}

void PressureSystem::close() {
  closed_ = true;
  remove_mean(rhs_);
}

void PressureSystem::remove_mean(const ScalarField& p) const {
  const auto fixed = Read<FlagField>(fixed_);
  accum sum = 0, free = 0;
  Kokkos::parallel_reduce(
      "greenwater::pressure_mean", Range(0, count()),
      KOKKOS_LAMBDA(const int i, accum& total, accum& number) {
        if (fixed(i)) return;
        total += p(i);
        number += 1;
      },
      sum, free);
  if (free == 0) return;
  const real mean = static_cast<real>(sum / free);
  Kokkos::parallel_for(
      "greenwater::remove_mean", Range(0, count()), KOKKOS_LAMBDA(const int i) {
        if (!fixed(i)) p(i) -= mean;
      });
}

void PressureSystem::raise_diagonal(real part) {
  raise(diagonal_, fixed(), part, count());
  if (!symmetric()) raise(row_diagonal_, fixed(), part, count());
  closed_ = false;
}

real PressureSystem::factor() const { return laplacian_factor(*fluid_); }

accum PressureSystem::apply(const ScalarField& p, const ScalarField& Ap) const {
  const real K = laplacian_factor(*fluid_);
  const bool flat = fluid_->particles.dim == 2;
  if (!symmetric()) {
    Rows rows = fluid_->rows.near;
    rows.weight = weights_;
    accum energy = apply_kept(*fluid_, rows, K, fixed_, row_diagonal_, p, Ap);
    if (added_) energy += added_->add_product(fixed(), p, Ap);
    if (closed_) remove_mean(Ap);  // rows that are not symmetric do not do so by themselves
    return energy;
  }
  const accum energy = fluid_->keep_weights ? apply_kept(*fluid_, fluid_->rows.near, K, fixed_, diagonal_, p, Ap)
                       : flat               ? apply_recomputed_in<2>(*fluid_, K, fixed_, diagonal_, p, Ap)
                                            : apply_recomputed_in<3>(*fluid_, K, fixed_, diagonal_, p, Ap);
  return added_ ? energy + added_->add_product(fixed(), p, Ap) : energy;
}

}  // namespace greenwater
