#include "kernels/survey.hpp"

#include "core/region.hpp"
#include "kernels/small_matrix.hpp"

namespace greenwater {
namespace {

constexpr real poor = real(0.15), fair = real(0.35);  // of a stencil: 1 when round, 0 when particles are in a line
constexpr real largest_error = real(0.1);             // of n / n^0 - 1 that the drift term answers to
constexpr real largest_bend = real(0.01);             // of a volume in one step, by what is of second order in the step
constexpr real crowd_margin = real(0.05);             // of 1 - n / n^0: who is crowded may lack that much less
constexpr real thin = real(0.15);                     // more of n missing than under a flat surface: a tip or a sheet

// How round a stencil is: (d^d det M) / (tr M)^d.
template <int Dim, class V>
KOKKOS_INLINE_FUNCTION V roundness(const V& det, const V& trace) {
  V scale = trace * (real(1) / Dim), power = scale;
  for (int d = 1; d < Dim; ++d) power = power * scale;
  return det * inverse(larger(power, all_lanes<V>(real(1e-30))));
}

// M^-1 where the stencil is good, d I where it is poor, and between them.
template <int Dim, class V>
KOKKOS_INLINE_FUNCTION Symmetric<Dim, V> correction_of(const Symmetric<Dim, V>& M) {
  auto C = adjugate(M);
  const V det = determinant(M, C), good = smooth_step(roundness<Dim>(det, M.trace()), poor, fair);
  const V scale = zero_unless(good > 0, good * inverse(select(good > 0, det, all_lanes<V>(real(1)))));
  for (V& c : C.c) c = c * scale;
  C.add_unit((1 - good) * Dim);
  return C;
}

// Depth under a flat surface that lacks as much of n [l0].
template <class V>
KOKKOS_INLINE_FUNCTION V depth_of(const LatticeTable& table, const V& m) {
  const real m0 = table.missing[0], m1 = table.missing[1], m2 = table.missing[2];
  const V upper = real(1.5) - (m - m1) * (1 / (m0 - m1)), lower = real(2.5) - (m - m2) * (1 / (m1 - m2));
  const V depth = select(m > m1, upper, lower);
  return smaller(larger(depth, all_lanes<V>(real(0.5))), all_lanes<V>(real(2.5)));
}

// What a flat surface lacks of n where |S| n^0 / (n l0) is as large: tells of a surface also where particles are crowded.
template <class V>
KOKKOS_INLINE_FUNCTION V missing_of(const LatticeTable& table, const V& tilt) {
  const real t0 = table.tilt[0], t1 = table.tilt[1], t2 = table.tilt[2];
  const real m0 = table.missing[0], m1 = table.missing[1], m2 = table.missing[2];
  const V upper = m1 + (tilt - t1) * ((m0 - m1) / (t0 - t1)), lower = m2 + (tilt - t2) * ((m1 - m2) / (t1 - t2));
  return smaller(select(tilt > t1, upper, lower), all_lanes<V>(m0));
}

template <int Dim>
struct Sums {
  Vec<Dim, Pack> S{}, crowd{};
  Symmetric<Dim, Pack> M{};
  Pack B[Dim][Dim]{};
  Pack g_offset{};  // (1 / n^0) sum over images of w g . (x_img - x_j)
  Pack fitted_gradient[Dim][Dim]{},
      fitted_offset{};  // grad u, and that sum with the Laplacian's factors, by least squares
};

// fitted: with least squares, as far as a particle's share goes.
template <int Dim, bool fitted>
struct Surveyor {
  Around<Dim> near;
  Fits<Dim> fits;
  Read<VectorField> u;
  Read<ScalarField> n;
  Read<AccumField> weight_sum;
  Read<IndexField> neighbours, images;
  FlagField marked;
  Weight w;
  ShiftFunction shift;
  LatticeTable table;
  Survey out;
  real n0, l0, touching, nearest2, K, per_dt, curving, most_turn, drift, step, longest, g[3];

  KOKKOS_INLINE_FUNCTION Sums<Dim> sums(int i) const {
    Sums<Dim> sum;
    const auto ui = load_pack<Dim>(u, i);
    const real per_n0 = 1 / n0;
    Fit<Dim> fit;
    if constexpr (fitted) fit = fits.of(i);
    const auto add = [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
      const auto du = difference(image.velocity(gather_pack<Dim>(u, j)), ui);
      const Pack r2 = dot(r, r);
      const Pack weight = zero_unless(r2 > touching, image.weight(w, r2)) * per_n0;
      const Pack per_r2 = weight * inverse(larger(r2, all_lanes<Pack>(nearest2)));
      sum.S = along(sum.S, weight, r);
      sum.M.add_square(per_r2, r);
      for (int d = 0; d < Dim; ++d)
        for (int e = 0; e < Dim; ++e) sum.B[d][e] += per_r2 * du[d] * r[e];
      const Pack slope =
          zero_unless(weight > 0, shift.slope(sqrt(larger(r2, all_lanes<Pack>(touching)))) * image.share);
      sum.crowd = along(sum.crowd, slope, r);
      if constexpr (fitted) {
        const auto q = fit.slope(r, image.share);
        for (int d = 0; d < Dim; ++d)
          for (int e = 0; e < Dim; ++e) sum.fitted_gradient[d][e] += du[d] * q[e];
      }
      return weight;
    };
    near.for_each_neighbour(i, add);
    near.for_each_image(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
      const Pack weight = add(j, r, image);
      const auto way = image.way_of_particle();
      Pack lift{};
      for (int d = 0; d < Dim; ++d) lift += g[d] * way[d];
      sum.g_offset += weight * lift;
      if constexpr (fitted) sum.fitted_offset += fit.bend(r, image.share) * lift;
    });
    return sum;
  }

  // Returns how many of the pack have a surface to hold their pressure.
  KOKKOS_INLINE_FUNCTION int operator()(int i, int count) const {
    const Sums<Dim> sum = sums(i);
    const Pack ni = load_pack(n, i), full = n0 * inverse(larger(ni, all_lanes<Pack>(real(1e-6) * n0)));
    const Pack seen = seen_by(neighbours, images, i);

    // How far it is to the surface, and where
    const Pack slope = sqrt(dot(sum.S, sum.S)), tilt = slope * full * (1 / l0);
    const Pack m = larger(1 - ni * (1 / n0), larger(missing_of(table, tilt) - crowd_margin, Pack{}));
    const Pack s = surface_share(table, tilt, seen);
    const Pack per_depth = inverse(depth_of(table, m) * l0);
    const Pack tip = smooth_step(m, table.missing[0], table.missing[0] + thin) * m * (1 + table.bulge * m);
    const Pack missing = s * larger(slope * per_depth, tip);
    auto normal = sum.S;  // out of the fluid
    for (int d = 0; d < Dim; ++d) normal[d] *= -inverse(larger(slope, all_lanes<Pack>(real(1e-6) * l0)));

    // grad u; what is missing counts as if it were round, which keeps the divergence of the few from being overrated
    Pack part{};
    if constexpr (fitted) part = load_pack(fits.share, i);
    auto M = sum.M;
    M.add_unit(s * m * (real(1) / Dim));
    const auto C = correction_of(M);
    Pack grad[Dim][Dim]{}, div{};
    for (int d = 0; d < Dim; ++d) {
      for (int e = 0; e < Dim; ++e) {
        for (int f = 0; f < Dim; ++f) grad[d][e] += sum.B[d][f] * C(f, e);
        if constexpr (fitted) grad[d][e] += part * (sum.fitted_gradient[d][e] - grad[d][e]);
        store_lanes(&out.velocity_gradient(i, d * Dim + e), grad[d][e]);
      }
      div += grad[d][d];
    }
    Pack turn{};  // tr (grad u)^2
    for (int d = 0; d < Dim; ++d)
      for (int e = 0; e < Dim; ++e) turn += grad[d][e] * grad[e][d];
    turn = smaller(larger(turn, all_lanes<Pack>(-most_turn)), all_lanes<Pack>(most_turn));

    if (out.divergence_correction.extent(0) > 0)
      for (int k = 0; k < Symmetric<Dim, Pack>::size; ++k) store_lanes(&out.divergence_correction(i, k), C.c[k]);

    // The row
    const auto held = seen < static_cast<real>(Dim + 1);
    const Pack excess =
        larger(smaller(ni * (1 / n0) - 1, all_lanes<Pack>(largest_error)), all_lanes<Pack>(-largest_error));
    const Pack error = s * larger(excess, Pack{}) + (1 - s) * excess;
    Pack gravity = -sum.g_offset;
    for (int d = 0; d < Dim; ++d) gravity += g[d] * (1 - s) * sum.S[d];
    const Pack b = -per_dt * div + curving * (1 - s) * turn + drift * error - (1 - part) * K * n0 * gravity +
                   part * sum.fitted_offset;
    const Pack diagonal = K * (convert_lanes<Pack>(load_pack(weight_sum, i)) + n0 * missing);
    store_lanes(&out.rhs(i), select(held, Pack{}, b));
    store_lanes(&out.diagonal(i), select(held, all_lanes<Pack>(real(1)), diagonal));
    store_lanes(&out.surface(i), s);
    for (int l = 0; l < pack_lanes; ++l) {
      out.fixed(i + l) = lane(seen, l) < Dim + 1;
      marked(i + l) = lane(s, l) > real(0.5);
    }

    // The pressure's gradient, with the surface as one more neighbour
    const Pack there = s * m;
    M = sum.M;
    M.add_square(there, normal);
    const auto C_p = correction_of(M);
    for (int k = 0; k < Symmetric<Dim, Pack>::size; ++k)
      store_lanes(&out.correction(i, k), select(held, Pack{}, C_p.c[k]));
    for (int d = 0; d < Dim; ++d) store_lanes(&out.surface_point(i, d), there * per_depth * normal[d]);

    int held_by_surface = 0;
    for (int l = 0; l < pack_lanes; ++l) held_by_surface += i + l < count && lane(missing, l) > 0;
    if (out.disorder.extent(0) == 0) return held_by_surface;
    auto shift = along(Vec<Dim, Pack>{}, all_lanes<Pack>(-step), sum.crowd);
    shift = along(shift, -s * dot(shift, normal), normal);  // along the surface, not through it
    const Pack length2 = dot(shift, shift), longest2 = all_lanes<Pack>(longest * longest);
    Pack shorter =
        select(length2 > longest2, longest * inverse(sqrt(larger(length2, longest2))), all_lanes<Pack>(real(1)));
    shorter = select(seen < static_cast<real>(table.few), Pack{}, shorter);
    for (int d = 0; d < Dim; ++d) store_lanes(&out.disorder(i, d), shorter * shift[d]);
    return held_by_surface;
  }
};

template <int Dim, bool fitted>
void survey_in(const Fluid& fluid, const LatticeTable& table, const SurveyOptions& options, real dt, Survey& out) {
  const Particles& p = fluid.particles;
  const Weight& w = fluid.gradient.weight;
  const Reference& lattice = fluid.gradient.reference;
  const real l0 = static_cast<real>(fluid.spacing), rho = fluid.rho;
  const ShiftFunction shift = shift_function(w, l0);
  Surveyor<Dim, fitted> surveyor{around_unmoved<Dim>(fluid, w),
                                 Fits<Dim>(fluid.fits),
                                 p.velocity,
                                 p.number_density,
                                 fluid.rows.near.weight_sum,
                                 fluid.rows.near.number,
                                 fluid.rows.images.number,
                                 p.surface,
                                 w,
                                 shift,
                                 table,
                                 out,
                                 lattice.n0,
                                 l0,
                                 real(1e-12) * l0 * l0,
                                 nearest_quotient * nearest_quotient * l0 * l0,
                                 2 * Dim / (lattice.lambda * lattice.n0),
                                 rho / dt,
                                 options.keeps_volume ? rho / 2 : real(0),
                                 2 * largest_bend / (dt * dt),
                                 rho * (options.drift_speed / l0) * (options.drift_speed / l0),
                                 options.shift_rate * table.shift,
                                 options.shift_limit * l0,
                                 {rho * fluid.gravity[0], rho * fluid.gravity[1], rho * fluid.gravity[2]}};
  const int count = p.count;
  int held_by_surface = 0;
  Kokkos::parallel_reduce(
      "greenwater::survey", packs(count),
      KOKKOS_LAMBDA(const int pack, int& sum) { sum += surveyor(pack * pack_lanes, count); }, held_by_surface);
  out.closed = held_by_surface == 0;
}

void make_room(const Particles& p, const SurveyOptions& options, Survey& out) {
  const std::size_t room = p.id.extent(0);
  if (options.loads && out.divergence_correction.extent(0) < room)
    out.divergence_correction =
        uncleared<VectorField>("greenwater::survey_divergence_correction", room, p.dim * (p.dim + 1) / 2);
  if (out.rhs.extent(0) >= room) return;
  out.rhs = uncleared<ScalarField>("greenwater::survey_rhs", room);
  out.diagonal = uncleared<ScalarField>("greenwater::survey_diagonal", room);
  out.fixed = uncleared<FlagField>("greenwater::survey_fixed", room);
  out.surface = uncleared<ScalarField>("greenwater::survey_surface", room);
  out.correction = uncleared<VectorField>("greenwater::survey_correction", room, p.dim * (p.dim + 1) / 2);
  out.surface_point = uncleared<VectorField>("greenwater::survey_surface_point", room, p.dim);
  out.velocity_gradient = uncleared<VectorField>("greenwater::survey_velocity_gradient", room, p.dim * p.dim);
  if (!options.shifts) return;
  out.disorder = uncleared<VectorField>("greenwater::survey_disorder", room, p.dim);
  out.shift = uncleared<VectorField>("greenwater::survey_shift", room, p.dim);
}

}  // namespace

void survey(const Fluid& fluid, const LatticeTable& table, const SurveyOptions& options, real dt, Survey& found) {
  Region region("survey");
  make_room(fluid.particles, options, found);
  const bool flat = fluid.particles.dim == 2;
  if (fluid.fits.empty())
    flat ? survey_in<2, false>(fluid, table, options, dt, found)
         : survey_in<3, false>(fluid, table, options, dt, found);
  else
    flat ? survey_in<2, true>(fluid, table, options, dt, found) : survey_in<3, true>(fluid, table, options, dt, found);
}

}  // namespace greenwater
