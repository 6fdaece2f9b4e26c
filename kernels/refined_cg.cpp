#include "kernels/refined_cg.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "kernels/blas.hpp"

namespace greenwater {
namespace {

constexpr accum stall = 0.5;  // a round that leaves more than this of the residual has met its rounding

struct Vectors {
  ScalarField r, d, q;         // residual, direction, A d
  FloatField rough, first, z;  // r in float, rough / diagonal, M rough
};

void hold_surface(const FlagField& fixed, const ScalarField& p, int count) {
  Kokkos::parallel_for(
      "greenwater::hold_surface", Range(0, count), KOKKOS_LAMBDA(const int i) {
        if (fixed(i)) p(i) = 0;
      });
}

void clear(const ScalarField& p, int count) {
  Kokkos::parallel_for(
      "greenwater::clear_pressure", Range(0, count), KOKKOS_LAMBDA(const int i) { p(i) = 0; });
}

// r = b - A p (A p in q), rough = r / scale, first = rough / diagonal, d = 0; returns r . r. Beyond the last particle all
// are 0.
accum begin(const PressureSystem& system, const FloatSystem& matrix, const Vectors& v) {
  const auto b = Read<ScalarField>(system.rhs());
  const int count = system.count();
  const auto w = v;
  accum rr = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_begin", Range(0, padded(count)),
      KOKKOS_LAMBDA(const int i, accum& sum) {
        const real r = i < count ? b(i) - w.q(i) : real(0);
        w.r(i) = r;
        w.d(i) = 0;
        sum += accum(r) * r;
      },
      rr);
  const auto inverse = Read<FloatField>(matrix.inverse);
  const real scale = rr > 0 ? static_cast<real>(1 / std::sqrt(rr)) : real(0);
  Kokkos::parallel_for(
      "greenwater::cg_round", Range(0, padded(count)), KOKKOS_LAMBDA(const int i) {
        w.rough(i) = static_cast<float>(scale * w.r(i));
        w.first(i) = inverse(i) * w.rough(i);
      });
  return rr;
}

// d = z + beta d
void advance_direction(real beta, int count, const Vectors& v) {
  const auto w = v;
  Kokkos::parallel_for(
      "greenwater::cg_advance_direction", packs(count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const Pack z = convert_lanes<Pack>(load_pack(w.z, i));
        store_lanes(&w.d(i), z + beta * load_pack(w.d, i));
      });
}

// d . q
accum direction_energy(int count, const Vectors& v) {
  const auto w = v;
  accum dq = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_direction_energy", Range(0, count),
      KOKKOS_LAMBDA(const int i, accum& sum) { sum += accum(w.d(i)) * w.q(i); }, dq);
  return dq;
}

// p = p + alpha d, r = r - alpha q, rough = scale r, first = rough / diagonal; returns r . r.
accum advance_solution(const FloatSystem& matrix, real alpha, real scale, const ScalarField& p, const Vectors& v) {
  const auto inverse = Read<FloatField>(matrix.inverse);
  const auto w = v;
  const int count = matrix.count;
  accum rr = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_advance_solution", Range(0, count),
      KOKKOS_LAMBDA(const int i, accum& sum) {
        p(i) += alpha * w.d(i);
        const real r = w.r(i) - alpha * w.q(i);
        w.r(i) = r;
        w.rough(i) = static_cast<float>(scale * r);
        w.first(i) = inverse(i) * w.rough(i);
        sum += accum(r) * r;
      },
      rr);
  return rr;
}

SolveReport stopped(int iterations, accum residual, std::string_view cause) {
  return {iterations, static_cast<real>(residual), false, cause};
}

}  // namespace

void RefinedCg::grow(int count) {
  const std::size_t room = padded(count) + float_lanes;
  if (r_.extent(0) >= room) return;
  const auto size = room + room / 4;
  r_ = ScalarField("greenwater::cg_residual", size);
  d_ = ScalarField("greenwater::cg_direction", size);
  q_ = ScalarField("greenwater::cg_product", size);
  rough_ = FloatField("greenwater::cg_rough_residual", size);
  first_ = FloatField("greenwater::cg_first_sweep", size);
  z_ = FloatField("greenwater::cg_preconditioned", size);
}

SolveReport RefinedCg::solve(const PressureSystem& system, Multigrid& multigrid, const ScalarField& p) {
  const int count = system.count();
  grow(count);
  const Vectors v = {r_, d_, q_, rough_, first_, z_};
  hold_surface(system.fixed(), p, count);
  const accum b_norm = std::sqrt(blas::dot(system.rhs(), system.rhs(), count));
  if (!std::isfinite(b_norm)) return stopped(0, b_norm, "not a number");
  if (b_norm == 0) {
    clear(p, count);
    return {};
  }
  const accum enough = std::fmax(options_.tolerance * b_norm, static_cast<accum>(options_.absolute));
  accum before = std::numeric_limits<accum>::infinity();
  for (int k = 0;;) {
    system.apply(p, q_);  // what the iterations say of r is checked at the end of each round
    const accum start = std::sqrt(begin(system, multigrid.system(), v));
    if (!std::isfinite(start)) return stopped(k, start / b_norm, "not a number");
    if (start <= enough) return {k, static_cast<real>(start / b_norm), true, "converged"};
    if (k >= options_.max_iterations) return stopped(k, start / b_norm, "too many iterations");
    if (start > stall * before) return stopped(k, start / b_norm, "the residual no longer falls");
    before = start;
    accum residual = start, rz_before = 0;
    while (residual > enough && k < options_.max_iterations) {
      const accum rz = start * multigrid.finish(rough_, first_, z_);  // z = M r, r . z
      if (!std::isfinite(rz)) return stopped(k, residual / b_norm, "not a number");
      if (rz <= 0) return stopped(k, residual / b_norm, "the preconditioner is not positive on this residual");
      advance_direction(rz_before > 0 ? static_cast<real>(rz / rz_before) : real(0), count, v);
      system.apply(d_, q_);
      const accum dq = direction_energy(count, v);
      if (!std::isfinite(dq)) return stopped(k, residual / b_norm, "not a number");
      if (dq <= 0)
        return stopped(k, residual / b_norm,
                       "the matrix is not positive on this direction (a closed cluster without a free surface?)");
      const accum rr =
          advance_solution(multigrid.system(), static_cast<real>(rz / dq), static_cast<real>(1 / start), p, v);
      ++k;
      if (!std::isfinite(rr)) return stopped(k, residual / b_norm, "not a number");
      residual = std::sqrt(rr);
      rz_before = rz;
    }
  }
}

}  // namespace greenwater
