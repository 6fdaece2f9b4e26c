#include "kernels/acceleration.hpp"

#include "core/region.hpp"
#include "kernels/small_matrix.hpp"

namespace greenwater {
namespace {

// Rates of smoothing [1/s].
struct Rates {
  real inside, at_surface;
};

Rates rates_of(const SmoothingOptions& options, real l0, real dt) {
  const real scale = options.speed / l0, most = options.most / dt;
  return {smaller(options.inside * scale, most), smaller(options.at_surface * scale, most)};
}

// What pairs add to the smoothing of a pack of particles.
template <int Dim>
struct Smoother {
  Read<VectorField> u, gradient;
  Read<ScalarField> surface;
  Rates rates;
  Vec<Dim, Pack> ui, sum{};
  Pack gradient_i[Dim * Dim], rate_i;

  KOKKOS_INLINE_FUNCTION void start(int i) {
    ui = load_pack<Dim>(u, i);
    for (int k = 0; k < Dim * Dim; ++k) gradient_i[k] = load_lanes<Pack>(&gradient(i, k));
    rate_i = rates.inside + rates.at_surface / 2 * load_pack(surface, i);
  }

  KOKKOS_INLINE_FUNCTION void add(const IndexPack& j, const Vec<Dim, Pack>& r, const Pack& weight) {
    const Pack scale = weight * (rate_i + rates.at_surface / 2 * gather_pack(surface, j));
    const auto uj = gather_pack<Dim>(u, j);
    for (int d = 0; d < Dim; ++d) {
      Pack slope{};
      for (int e = 0; e < Dim; ++e)
        slope += (gradient_i[d * Dim + e] + gather_lanes<Pack>(&gradient(0, d * Dim + e), j)) * r[e];
      sum[d] += scale * (uj[d] - ui[d] - real(0.5) * slope);
    }
  }
};

// The disorder of a pack of particles less its mean over the neighbours, so that shifting does not see long waves: a
// lattice that the flow bends would be bent back like an elastic body, and that feeds waves.
template <int Dim>
struct Straightener {
  Read<VectorField> disorder;
  Vec<Dim, Pack> mean{};

  KOKKOS_INLINE_FUNCTION void add(const IndexPack& j, const Pack& weight) {
    mean = along(mean, weight, gather_pack<Dim>(disorder, j));
  }
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> shift(int i) const { return difference(load_pack<Dim>(disorder, i), mean); }
};

// fitted: with least squares, as far as a particle's share goes.
template <int Dim, bool fitted>
void accelerate_in(const Fluid& fluid, Survey& survey, const Rates& rates, const VectorField& a) {
  const auto w = fluid.gradient.weight;
  const auto near = around_unmoved<Dim>(fluid, w);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto drive = drive_of<Dim>(fluid);
  const real rho = fluid.rho, per_n0 = 1 / fluid.gradient.reference.n0;
  const real l0 = static_cast<real>(fluid.spacing), touching = real(1e-12) * l0 * l0;
  const real nearest2 = nearest_quotient * nearest_quotient * l0 * l0;
  const auto correction = Read<VectorField>(survey.correction), surface_point = Read<VectorField>(survey.surface_point);
  const bool smooths = rates.inside > 0 || rates.at_surface > 0;
  const bool shifts = survey.shift.extent(0) > 0;
  const Fits<Dim> fits(fluid.fits);
  const auto shift = survey.shift;
  const Straightener<Dim> crooked{survey.disorder, {}};
  const Smoother<Dim> idle{fluid.particles.velocity, survey.velocity_gradient, survey.surface, rates, {}, {}, {}, {}};
  Kokkos::parallel_for(
      "greenwater::accelerate", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const Pack pi = load_pack(p, i);
        auto smoother = idle;
        if (smooths) smoother.start(i);
        auto straightener = crooked;
        Vec<Dim, Pack> sum{}, fitted_sum{};
        [[maybe_unused]] const Fits<Dim>& all =
            fits;  // named here, as nvcc takes no first capture from what is only compiled if fitted
        Fit<Dim> fit;
        if constexpr (fitted) fit = all.of(i);
        near.for_each_neighbour(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack r2 = dot(r, r);
          const Pack weight = zero_unless(r2 >= touching, image.weight(w, r2)) * per_n0;
          const Pack dp = gather_pack(p, j) - pi;
          sum = along(sum, dp * weight * inverse(larger(r2, all_lanes<Pack>(nearest2))), r);
          if constexpr (fitted) fitted_sum = along(fitted_sum, dp, fit.slope(r, image.share));
          if (smooths) smoother.add(j, r, weight);
          if (shifts) straightener.add(j, weight);
        });
        near.for_each_image(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack r2 = dot(r, r);
          const Pack weight = zero_unless(r2 >= touching, image.weight(w, r2)) * per_n0;
          const Pack dp = gather_pack(p, j) + rho * image.pressure_offset(drive, j) - pi;
          sum = along(sum, dp * weight * inverse(larger(r2, all_lanes<Pack>(nearest2))), r);
          if constexpr (fitted) fitted_sum = along(fitted_sum, dp, fit.slope(r, image.share));
        });
        sum = along(sum, -pi, load_pack<Dim>(surface_point, i));
        Symmetric<Dim, Pack> C;
        for (int k = 0; k < Symmetric<Dim, Pack>::size; ++k) C.c[k] = load_lanes<Pack>(&correction(i, k));
        if (shifts) store_pack(shift, i, straightener.shift(i));
        auto grad = product(C, sum);
        if constexpr (fitted) grad = along(grad, fit.share, difference(fitted_sum, grad));
        store_pack(a, i, along(smoother.sum, all_lanes<Pack>(-1 / rho), grad));
      });
}

}  // namespace

void accelerate(Fluid& fluid, Survey& survey, const SmoothingOptions& smoothing, real dt) {
  Region region("gradient");
  const Rates rates = rates_of(smoothing, static_cast<real>(fluid.spacing), dt);
  const VectorField a = fluid.particles.acceleration;
  const bool flat = fluid.particles.dim == 2;
  if (fluid.fits.empty())
    flat ? accelerate_in<2, false>(fluid, survey, rates, a) : accelerate_in<3, false>(fluid, survey, rates, a);
  else
    flat ? accelerate_in<2, true>(fluid, survey, rates, a) : accelerate_in<3, true>(fluid, survey, rates, a);
}

}  // namespace greenwater
