#include "kernels/least_squares.hpp"

#include <cmath>

#include "core/region.hpp"
#include "kernels/survey.hpp"

namespace greenwater {
namespace {

constexpr real least_pivot = real(0.02);  // of a moment matrix, over its diagonal
constexpr real enough = real(1.5);        // neighbours for each term

// A symmetric matrix of packs, factorised in place as L D L^T.
template <int N>
struct Factors {
  Pack c[N * (N + 1) / 2] = {};  // row by row up to the diagonal: L below it, 1 / D on it

  KOKKOS_INLINE_FUNCTION static constexpr int place(int a, int b) { return a * (a + 1) / 2 + b; }

  /// Returns the smallest pivot over its diagonal; lanes where it is not positive mean nothing then.
  KOKKOS_INLINE_FUNCTION Pack factorise() {
    Pack least = all_lanes<Pack>(real(1));
    for (int k = 0; k < N; ++k) {
      const Pack whole = c[place(k, k)];
      Pack scaled[N];  // L_km D_m
      Pack pivot = whole;
      for (int m = 0; m < k; ++m) {
        scaled[m] = c[place(k, m)];
        c[place(k, m)] = scaled[m] * c[place(m, m)];
        pivot -= scaled[m] * c[place(k, m)];
      }
      const Pack safe = larger(pivot, real(1e-6) * whole + real(1e-30));
      least = smaller(least, pivot * inverse(larger(whole, all_lanes<Pack>(real(1e-30)))));
      c[place(k, k)] = inverse(safe);
      for (int a = k + 1; a < N; ++a)
        for (int m = 0; m < k; ++m) c[place(a, k)] -= scaled[m] * c[place(m, m)] * c[place(a, m)];
    }
    return least;
  }

  KOKKOS_INLINE_FUNCTION void solve(Pack (&x)[N]) const {
    for (int a = 0; a < N; ++a)
      for (int b = 0; b < a; ++b) x[a] -= c[place(a, b)] * x[b];
    for (int a = 0; a < N; ++a) x[a] *= c[place(a, a)];
    for (int a = N - 1; a >= 0; --a)
      for (int b = a + 1; b < N; ++b) x[a] -= c[place(b, a)] * x[b];
  }
};

template <int Dim>
struct Fitter {
  static constexpr int terms = fit_terms(Dim);
  Around<Dim> near;
  Read<ScalarField> n;
  Read<IndexField> neighbours, images;
  Weight w;
  LatticeTable table;
  VectorField coefficients;
  ScalarField share;
  FitWeight phi_of;
  real n0, l0;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    Factors<terms> M;
    Vec<Dim, Pack> S{};
    const real per_l0 = 1 / l0, touching = real(1e-12) * l0 * l0;
    near.for_each(i, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto& image) {
      const Pack r2 = dot(r, r);
      S = along(S, zero_unless(r2 > touching, image.weight(w, r2)), r);
      Vec<Dim, Pack> scaled;
      for (int d = 0; d < Dim; ++d) scaled[d] = r[d] * per_l0;
      const FitBasis<Dim> P(scaled);
      const Pack phi = image.share * phi_of(r2);
      for (int a = 0; a < terms; ++a) {
        const Pack part = phi * P.term[a];
        for (int b = 0; b <= a; ++b) M.c[M.place(a, b)] += part * P.term[b];
      }
    });
    const Pack least = M.factorise();
    const Pack tilt = sqrt(dot(S, S)) * inverse(larger(load_pack(n, i), all_lanes<Pack>(real(1e-6) * n0))) * per_l0;
    const Pack seen = seen_by(neighbours, images, i);
    const auto good = (least > least_pivot) & (seen >= enough * terms);
    store_lanes(&share(i), zero_unless(good, 1 - surface_share(table, tilt, seen)));
    for (int m = 0; m <= Dim; ++m) {
      Pack a[terms] = {};
      for (int k = 0; k < terms; ++k)
        if (m < Dim ? k == m : k >= Dim && k < 2 * Dim) a[k] = all_lanes<Pack>(real(1));
      M.solve(a);
      const real scale = m < Dim ? per_l0 : per_l0 * per_l0;
      for (int k = 0; k < terms; ++k)
        store_lanes(&coefficients(i, m * terms + k),
                    zero_unless(good, a[k] * (scale * (k < Dim ? per_l0 : per_l0 * per_l0))));
    }
  }
};

template <int Dim>
void fit_in(const Fluid& fluid, const LatticeTable& table, const LeastSquares& fits) {
  const auto& w = fluid.gradient.weight;
  const Fitter<Dim> fitter{around_unmoved<Dim>(fluid, w),
                           fluid.particles.number_density,
                           fluid.rows.near.number,
                           fluid.rows.images.number,
                           w,
                           table,
                           fits.coefficients,
                           fits.share,
                           {1 / fits.radius, fits.half_power},
                           fluid.gradient.reference.n0,
                           static_cast<real>(fluid.spacing)};
  Kokkos::parallel_for(
      "greenwater::fit_neighbourhoods", packs(fluid.particles.count),
      KOKKOS_LAMBDA(const int pack) { fitter(pack * pack_lanes); });
}

// Rows begin with neighbours, go on with the images of others in their order, and end with fillers.
template <int Dim>
void weigh_rows_in(const Fluid& fluid, const Survey& survey, real K) {
  const auto near = around_unmoved<Dim>(fluid, fluid.gradient.weight);
  const Fits<Dim> fits(fluid.fits);
  const auto rows = fluid.rows.near;
  const auto weight = fluid.fits.weight;
  const auto diagonal = fluid.fits.diagonal;
  const auto plain = Read<ScalarField>(survey.diagonal);
  const auto fixed = Read<FlagField>(survey.fixed);
  const real per_K = 1 / K;
  using Floats = Lanes<float, pack_lanes>;
  Kokkos::parallel_for(
      "greenwater::weigh_rows", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto fit = fits.of(i);
        const Pack held = convert_lanes<Pack>(load_pack(fixed, i));
        const Pack share = zero_unless(held == 0, fit.share);
        const auto begin = rows.place(i, 0);
        for (int k = 0; k < rows.length(i / row_lanes); ++k) {
          const auto place = begin + static_cast<std::int64_t>(k) * row_lanes;
          const auto old = convert_lanes<Pack>(load_lanes<Floats>(&rows.weight(place)));
          store_lanes(&weight(place), convert_lanes<Floats>((1 - share) * old));
        }
        const auto number = load_pack(rows.number, i);
        int entry[pack_lanes];  // of each lane's next image
        for (int l = 0; l < pack_lanes; ++l) entry[l] = lane(number, l);
        Pack sum{};
        int k = 0;
        const auto put = [&](const Pack& c, int l, int e) {
          const auto place = begin + static_cast<std::int64_t>(e) * row_lanes + l;
          const float more = static_cast<float>(lane(c, l));
          weight(place) += more;
          set_lane(sum, l, lane(sum, l) + static_cast<real>(more));
        };
        near.for_each_neighbour(i, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack c = share * per_K * fit.bend(r, image.share);
          for (int l = 0; l < pack_lanes; ++l)
            if (k < lane(number, l)) put(c, l, k);
          ++k;
        });
        near.for_each_image(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack c = share * per_K * fit.bend(r, image.share);
          for (int l = 0; l < pack_lanes; ++l)
            if (image.there(l) && lane(j, l) != i + l) put(c, l, entry[l]++);
        });
        store_lanes(&diagonal(i), (1 - share) * load_pack(plain, i) + K * sum);
      });
}

// On the lattice, where by symmetry the squares of the axes alone tell the Laplacian: what the fit makes of r^4, which has no
// Laplacian at its centre, over Lap Lap r^4.
real quartic_of_lattice(const FitWeight& phi, int dim, double l0) {
  const double radius = 1 / static_cast<double>(phi.per_radius) / l0;
  const int reach = static_cast<int>(std::ceil(radius)), across = dim == 3 ? reach : 0;
  double xx_xx = 0, xx_yy = 0, xx_f = 0;  // sums of phi times x^2/2 with itself, with y^2/2, and with r^4
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -across; z <= across; ++z) {
        const double r2 = x * x + y * y + z * z, w = r2 > 0 ? phi(static_cast<real>(r2 * l0 * l0)) : 0;
        xx_xx += w * std::pow(x, 4) / 4;
        xx_yy += w * x * x * y * y / 4;
        xx_f += w * x * x / 2 * r2 * r2;
      }
  const double laplacian = dim * xx_f / (xx_xx + (dim - 1) * xx_yy);
  return static_cast<real>(laplacian / (dim == 2 ? 64 : 120) * l0 * l0);
}

}  // namespace

void fit_neighbourhoods(Fluid& fluid, const LatticeTable& table) {
  Region region("fit");
  LeastSquares& fits = fluid.fits;
  const std::size_t room = fluid.particles.id.extent(0);
  const int dim = fluid.particles.dim;
  if (fits.half_power == 0) {
    fits.radius = fluid.gradient.weight.radius;
    fits.half_power = static_cast<int>(std::lround(fits.radius / fluid.spacing));
    fits.quartic = quartic_of_lattice({1 / fits.radius, fits.half_power}, dim, fluid.spacing);
  }
  if (fits.share.extent(0) < room) {
    fits.coefficients = uncleared<VectorField>("greenwater::fit_coefficients", room, (dim + 1) * fit_terms(dim));
    fits.share = uncleared<ScalarField>("greenwater::fit_share", room);
    fits.diagonal = uncleared<ScalarField>("greenwater::fit_diagonal", room);
  }
  dim == 2 ? fit_in<2>(fluid, table, fits) : fit_in<3>(fluid, table, fits);
}

void weigh_rows(Fluid& fluid, const Survey& survey) {
  Region region("fit");
  if (fluid.fits.weight.extent(0) < fluid.rows.near.weight.extent(0))
    fluid.fits.weight = uncleared<FloatField>("greenwater::fit_weight", fluid.rows.near.weight.extent(0));
  const Reference& lattice = fluid.laplacian.reference;
  const int dim = fluid.particles.dim;
  const real K = 2 * dim / (lattice.lambda * lattice.n0);
  dim == 2 ? weigh_rows_in<2>(fluid, survey, K) : weigh_rows_in<3>(fluid, survey, K);
}

}  // namespace greenwater
