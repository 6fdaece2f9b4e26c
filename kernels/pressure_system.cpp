#include "kernels/pressure_system.hpp"

namespace greenwater {
namespace {

real laplacian_factor(const Fluid& fluid) {
  const Reference& lattice = fluid.laplacian.reference;
  return 2 * fluid.particles.dim / (lattice.lambda * lattice.n0);  // K
}

// An image of i itself has the pressure of i and drops out.
template <int Dim>
void diagonal_in(const Fluid& fluid, const PressureOptions& options, real dt, const ScalarField& diagonal) {
  const auto near = around<Dim>(fluid);
  const auto w = fluid.laplacian.weight;
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const real C_K = options.diagonal_factor * laplacian_factor(fluid);
  const real shift = fluid.rho * options.compressibility / (dt * dt);
  Kokkos::parallel_for(
      "greenwater::pressure_diagonal", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        real sum = 0;
        near.for_each(i, [&](const int j, const Vec<Dim>& r, const Image<Dim>& image) {
          if (j != i) sum += image.share * w(sqrt(dot(r, r)));
        });
        diagonal(i) = fixed(i) ? real(1) : C_K * sum + shift;
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
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const auto w = fluid.gradient.weight;
  const real factor = -fluid.rho / dt * Dim / fluid.gradient.reference.n0;
  const real touching = static_cast<real>(1e-12 * fluid.spacing * fluid.spacing);
  Kokkos::parallel_for(
      "greenwater::divergence_source", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        const auto ui = load<Dim>(u, i);
        real div = 0;
        near.for_each(i, [&](const int j, const Vec<Dim>& r, const Image<Dim>& image) {
          const auto uj = image ? image.velocity(load<Dim>(u, j)) : load<Dim>(u, j);
          const real r2 = dot(r, r);
          if (r2 > touching) div += dot(difference(uj, ui), r) * image.share * w(sqrt(r2)) / r2;
        });
        b(i) = fixed(i) ? real(0) : factor * div;
      });
}

// One row of A p from the kept weights; p is 0 where the surface is, so no entry needs to be left out.
void apply_kept(const Fluid& fluid, real K, const ScalarField& diagonal, const ScalarField& p, const ScalarField& Ap) {
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  const auto near = fluid.rows.near;
  const auto images = fluid.rows.images;
  const bool walls = images.first.extent(0) > 0;
  Kokkos::parallel_for(
      "greenwater::apply_pressure", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        real sum = 0;
        if (!fixed(i)) {
          for (auto k = near.first(i); k < near.first(i + 1); ++k) sum += near.weight(k) * p(near.index(k));
          if (walls)
            for (auto k = images.first(i); k < images.first(i + 1); ++k) {
              const int j = images.index(k);
              if (j != i) sum += images.weight(k) * p(j);
            }
          sum = diagonal(i) * p(i) - K * sum;
        }
        Ap(i) = sum;
      });
}

template <int Dim>
void apply_recomputed_in(const Fluid& fluid, real K, const ScalarField& diagonal, const ScalarField& p,
                         const ScalarField& Ap) {
  const auto near = around<Dim>(fluid);
  const auto w = fluid.laplacian.weight;
  const auto fixed = Read<FlagField>(fluid.particles.surface);
  Kokkos::parallel_for(
      "greenwater::apply_pressure", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        real sum = 0;
        if (!fixed(i)) {
          near.for_each(i, [&](const int j, const Vec<Dim>& r, const Image<Dim>& image) {
            if (j != i) sum += image.share * w(sqrt(dot(r, r))) * p(j);
          });
          sum = diagonal(i) * p(i) - K * sum;
        }
        Ap(i) = sum;
      });
}

}  // namespace

void PressureSystem::assemble(const Fluid& fluid, real dt) {
  fluid_ = &fluid;
  if (rhs_.extent(0) < fluid.particles.id.extent(0)) {
    rhs_ = uncleared<ScalarField>("greenwater::pressure_rhs", fluid.particles.id.extent(0));
    diagonal_ = uncleared<ScalarField>("greenwater::pressure_diagonal", fluid.particles.id.extent(0));
  }
  const bool flat = fluid.particles.dim == 2;
  flat ? diagonal_in<2>(fluid, options_, dt, diagonal_) : diagonal_in<3>(fluid, options_, dt, diagonal_);
  if (options_.source == PressureSource::density)
    density_source(fluid, options_.source_factor, dt, rhs_);
  else
    flat ? divergence_source_in<2>(fluid, dt, rhs_) : divergence_source_in<3>(fluid, dt, rhs_);
}

void PressureSystem::apply(const ScalarField& p, const ScalarField& Ap) const {
  const real K = laplacian_factor(*fluid_);
  if (fluid_->keep_weights)
    apply_kept(*fluid_, K, diagonal_, p, Ap);
  else
    fluid_->particles.dim == 2 ? apply_recomputed_in<2>(*fluid_, K, diagonal_, p, Ap)
                               : apply_recomputed_in<3>(*fluid_, K, diagonal_, p, Ap);
}

}  // namespace greenwater
