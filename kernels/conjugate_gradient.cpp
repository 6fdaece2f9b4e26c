#include "kernels/conjugate_gradient.hpp"

#include <cmath>

#include "kernels/blas.hpp"

namespace greenwater {
namespace {

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

real largest(const ScalarField& diagonal, int count) {
  real most = 0;
  Kokkos::parallel_reduce(
      "greenwater::largest_diagonal", Range(0, count),
      KOKKOS_LAMBDA(const int i, real& m) { m = larger(m, diagonal(i)); }, Kokkos::Max<real>(most));
  return most;
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
    clear(p, count);
    return {};
  }
  system.apply(p, r_);
  blas::axpby(1, system.rhs(), -1, r_, count);  // r = b - A p
  precondition.apply(r_, z_);                   // z = M r
  blas::axpby(1, z_, 0, d_, count);             // d = z
  accum rz = blas::dot(r_, z_, count);
  accum residual = std::sqrt(blas::dot(r_, r_, count));
  const accum singular = 1e-12 * largest(system.diagonal(), count);  // no real flow comes near: (l0 / tank)^2 ~ 1e-7
  const accum enough = std::fmax(options_.tolerance * b_norm, static_cast<accum>(options_.absolute));
  for (int k = 0;; ++k) {
    if (!std::isfinite(residual) || !std::isfinite(rz)) return stopped(k, residual / b_norm, "not a number");
    if (residual <= enough) return {k, static_cast<real>(residual / b_norm), true, "converged"};
    if (k == options_.max_iterations) return stopped(k, residual / b_norm, "too many iterations");
    if (rz <= 0) return stopped(k, residual / b_norm, "the preconditioner is not positive on this residual");
    system.apply(d_, q_);  // q = A d
    const accum dq = blas::dot(d_, q_, count);
    if (!std::isfinite(dq)) return stopped(k, residual / b_norm, "not a number");
    if (dq <= singular * blas::dot(d_, d_, count))
      return stopped(k, residual / b_norm,
                     "the matrix is not positive on this direction (a closed cluster without a free surface?)");
    const auto alpha = static_cast<real>(rz / dq);
    blas::axpby(alpha, d_, 1, p, count);    // p = p + alpha d
    blas::axpby(-alpha, q_, 1, r_, count);  // r = r - alpha A d
    precondition.apply(r_, z_);             // z = M r
    const accum rz_new = blas::dot(r_, z_, count);
    blas::axpby(1, z_, static_cast<real>(rz_new / rz), d_, count);  // d = z + beta d
    rz = rz_new;
    residual = std::sqrt(blas::dot(r_, r_, count));
  }
}

}  // namespace greenwater
