#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

// What a particle inside the fluid has of sum w r^2, as a share of the lattice's: particles that lie as they fell have one or
// two per cent less of it, at any spacing. At the surface and where the share is far from 1 it is 1: there something is missing.
template <int Dim>
void measure_spread_in(const Fluid& fluid, const ScalarField& share) {
  constexpr real most_off = real(0.1);
  const auto near = around<Dim>(fluid);
  const auto surface = Read<FlagField>(fluid.particles.surface);
  const auto w = fluid.laplacian.weight;
  const real per_whole = 1 / (fluid.laplacian.reference.lambda * fluid.laplacian.reference.n0);
  Kokkos::parallel_for(
      "greenwater::viscosity_spread", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        Pack sum{};
        near.for_each(i, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack r2 = dot(r, r);
          sum += image.share * w.in_float(r2) * r2;
        });
        sum *= per_whole;
        const Pack one = all_lanes<Pack>(real(1)), at_surface = convert_lanes<Pack>(load_pack(surface, i));
        const auto good = (sum > 1 - most_off) & (sum < 1 + most_off) & (at_surface == 0);
        store_lanes(&share(i), select(good, sum, one));
      });
}

template <int Dim>
void viscosity_in(const Fluid& fluid, real nu, const Read<ScalarField>& share, const VectorField& a) {
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto w = fluid.laplacian.weight;
  const real factor = nu * 2 * Dim / (fluid.laplacian.reference.lambda * fluid.laplacian.reference.n0);
  const bool measured = share.extent(0) > 0;
  Kokkos::parallel_for(
      "greenwater::viscosity", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto ui = load_pack<Dim>(u, i);
        const Pack mine = measured ? load_pack(share, i) : all_lanes<Pack>(real(1));
        Vec<Dim, Pack> sum{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const auto uj = image.sticking_velocity(gather_pack<Dim>(u, j));
          Pack weight = image.share * w.in_float(dot(r, r));
          if (measured) weight = 2 * weight * inverse(mine + gather_pack(share, j));
          sum = along(sum, weight, difference(uj, ui));
        });
        store_pack(a, i, along(load_pack<Dim>(a, i), all_lanes<Pack>(factor), sum));
      });
}

// nu L u with Laplacians by least squares as far as each particle's share goes. Taken twice it makes
//
//   a = nu L (u + (dt nu / 2 - c) L u)
//
// of second order in time, as the first half of a step changes what the second half sees; and, L being Lap + c Lap Lap + ...
// on the lattice, of fourth order in space there.
template <int Dim>
void fitted_viscosity_in(const Fluid& fluid, real nu, const VectorField& velocity, const VectorField& a) {
  const auto near = around_unmoved<Dim>(fluid, fluid.laplacian.weight);
  const Fits<Dim> fits(fluid.fits);
  const auto u = Read<VectorField>(velocity);
  const auto w = fluid.laplacian.weight;
  const real factor = 2 * Dim / (fluid.laplacian.reference.lambda * fluid.laplacian.reference.n0);
  Kokkos::parallel_for(
      "greenwater::fitted_viscosity", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto ui = load_pack<Dim>(u, i);
        const auto fit = fits.of(i);
        Vec<Dim, Pack> sum{};
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const auto uj = image.sticking_velocity(gather_pack<Dim>(u, j));
          const Pack plain = factor * image.weight(w, dot(r, r));
          sum = along(sum, plain + fit.share * (fit.bend(r, image.share) - plain), difference(uj, ui));
        });
        store_pack(a, i, along(Vec<Dim, Pack>{}, all_lanes<Pack>(nu), sum));
      });
}

// to = from + dt a
template <int Dim>
void go_on_in(const Read<VectorField>& from, real dt, const Read<VectorField>& a, const VectorField& to, int count) {
  Kokkos::parallel_for(
      "greenwater::viscosity_half_step", Range(0, count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) to(i, d) = from(i, d) + dt * a(i, d);
      });
}

class Viscosity : public Effect {
 public:
  explicit Viscosity(const ViscosityOptions& options) : options_(options) {}
  std::string_view name() const override { return "viscosity"; }
  Stage stage() const override { return Stage::force; }
  void apply(Fluid& fluid, real dt) override {
    if (fluid.fits.empty())
      fluid.particles.dim == 2 ? apply_in<2>(fluid) : apply_in<3>(fluid);
    else
      fluid.particles.dim == 2 ? apply_fitted_in<2>(fluid, dt) : apply_fitted_in<3>(fluid, dt);
  }

 private:
  template <int Dim>
  void apply_in(Fluid& fluid) {
    if (options_.measured) {
      if (share_.extent(0) < fluid.particles.id.extent(0))
        share_ = uncleared<ScalarField>("greenwater::viscosity_share", fluid.particles.id.extent(0));
      measure_spread_in<Dim>(fluid, share_);
    }
    viscosity_in<Dim>(fluid, options_.kinematic, share_, fluid.particles.acceleration);
  }

  template <int Dim>
  void apply_fitted_in(Fluid& fluid, real dt) {
    const Particles& p = fluid.particles;
    if (middle_.extent(0) < p.id.extent(0)) {
      middle_ = uncleared<VectorField>("greenwater::viscosity_middle", p.id.extent(0), Dim);
      change_ = uncleared<VectorField>("greenwater::viscosity_change", p.id.extent(0), Dim);
    }
    fitted_viscosity_in<Dim>(fluid, options_.kinematic, p.velocity, change_);
    go_on_in<Dim>(p.velocity, dt / 2 - fluid.fits.quartic / options_.kinematic, change_, middle_, p.count);
    fitted_viscosity_in<Dim>(fluid, options_.kinematic, middle_, change_);
    go_on_in<Dim>(p.acceleration, 1, change_, p.acceleration, p.count);
  }

  ViscosityOptions options_;
  ScalarField share_;            // measured
  VectorField middle_, change_;  // with fits: u in the middle of the step, and what viscosity makes of it
};

}  // namespace

std::unique_ptr<Effect> make_viscosity(const ViscosityOptions& options) { return std::make_unique<Viscosity>(options); }

}  // namespace greenwater
