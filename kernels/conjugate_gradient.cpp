#include "kernels/conjugate_gradient.hpp"

#include <cmath>

#include "kernels/blas.hpp"
#include "kernels/pressure_vectors.hpp"

namespace greenwater {
namespace {

real largest(const ScalarField& diagonal, int count) {
  real most = 0;
  Kokkos::parallel_reduce(
      "greenwater::largest_diagonal", Range(0, count),
      KOKKOS_LAMBDA(const int i, real& m) { m = larger(m, diagonal(i)); }, Kokkos::Max<real>(most));
  return most;
}

// d = z + beta d
void advance_direction(real beta, const ScalarField& z, const ScalarField& d, int count) {
  Kokkos::parallel_for(
      "greenwater::cg_advance_direction", packs(count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const Pack onward = load_pack(z, i);
        store_lanes(&d(i), beta == 0 ? onward : onward + beta * load_pack(d, i));  // at first d may hold anything
      });
}

// p = p + alpha d, r = r - alpha q; returns r . r.
accum advance_solution(real alpha, const ScalarField& d, const ScalarField& q, const ScalarField& p,
                       const ScalarField& r, int count) {
  accum rr = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_advance_solution", packs(count),
      KOKKOS_LAMBDA(const int pack, accum& sum) {
        const int i = pack * pack_lanes;
        store_lanes(&p(i), load_pack(p, i) + alpha * load_pack(d, i));
        const Pack left = load_pack(r, i) - alpha * load_pack(q, i);
        store_lanes(&r(i), left);
        const Pack counted = first_lanes(count - i, left);
        sum += sum_lanes(counted * counted);
      },
      rr);
  return rr;
}

SolveReport stopped(int iterations, accum residual, std::string_view cause) {
  return {iterations, static_cast<real>(residual), false, cause};
}

}  // namespace

SolveReport ConjugateGradient::solve(const PressureSystem& system, const Preconditioner& precondition,
                                     const ScalarField& p) {
  const int count = system.count();
  if (r_.extent(0) < p.extent(0)) {
    r_ = uncleared<ScalarField>("greenwater::cg_residual", p.extent(0));
    z_ = uncleared<ScalarField>("greenwater::cg_preconditioned", p.extent(0));
    d_ = uncleared<ScalarField>("greenwater::cg_direction", p.extent(0));
    q_ = uncleared<ScalarField>("greenwater::cg_product", p.extent(0));
  }
  hold_surface(system.fixed(), p, count);
  const accum b_norm = std::sqrt(blas::dot(system.rhs(), system.rhs(), count));
  if (b_norm == 0) {
    clear_pressure(p, count);
    return {};
  }
  system.apply(p, r_);
  blas::axpby(1, system.rhs(), -1, r_, count);  // r = b - A p
  accum residual = std::sqrt(blas::dot(r_, r_, count)), rz_before = 0;
  const accum singular = 1e-12 * largest(system.diagonal(), count);  // no real flow comes near: (l0 / tank)^2 ~ 1e-7
  const accum enough = std::fmax(options_.tolerance * b_norm, static_cast<accum>(options_.absolute));
  for (int k = 0;; ++k) {
    if (!std::isfinite(residual)) return stopped(k, residual / b_norm, "not a number");
    if (residual <= enough) return {k, static_cast<real>(residual / b_norm), true, "converged"};
    if (k == options_.max_iterations) return stopped(k, residual / b_norm, "too many iterations");
    const accum rz = precondition.apply(r_, z_);  // z = M r
    if (!std::isfinite(rz)) return stopped(k, residual / b_norm, "not a number");
    if (rz <= 0) return stopped(k, residual / b_norm, "the preconditioner is not positive on this residual");
    advance_direction(k > 0 ? static_cast<real>(rz / rz_before) : real(0), z_, d_, count);
    const accum dq = system.apply(d_, q_);  // q = A d
    if (!std::isfinite(dq)) return stopped(k, residual / b_norm, "not a number");
    if (dq <= singular * blas::dot(d_, d_, count))
      return stopped(k, residual / b_norm,
                     "the matrix is not positive on this direction (a closed cluster without a free surface?)");
    residual = std::sqrt(advance_solution(static_cast<real>(rz / dq), d_, q_, p, r_, count));
    rz_before = rz;
  }
}

}  // namespace greenwater
