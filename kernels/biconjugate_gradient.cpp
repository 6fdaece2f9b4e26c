#include "kernels/biconjugate_gradient.hpp"

#include <cmath>

#include "kernels/blas.hpp"
#include "kernels/pressure_vectors.hpp"

namespace greenwater {
namespace {

// d = r + beta (d - omega v)
void advance_direction(real beta, real omega, const ScalarField& r, const ScalarField& v, const ScalarField& d,
                       int count) {
  Kokkos::parallel_for(
      "greenwater::bicg_advance_direction", packs(count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const Pack onward = load_pack(r, i);
        store_lanes(&d(i), beta == 0 ? onward : onward + beta * (load_pack(d, i) - omega * load_pack(v, i)));
      });
}

// t . r and t . t in one pass.
struct Products {
  accum tr = 0, tt = 0;
};
Products products(const ScalarField& t, const ScalarField& r, int count) {
  Products sum;
  Kokkos::parallel_reduce(
      "greenwater::bicg_products", Range(0, count),
      KOKKOS_LAMBDA(const int i, accum& tr, accum& tt) {
        tr += accum(t(i)) * r(i);
        tt += accum(t(i)) * t(i);
      },
      sum.tr, sum.tt);
  return sum;
}

SolveReport stopped(int iterations, accum residual, std::string_view cause) {
  return {iterations, static_cast<real>(residual), false, cause};
}

}  // namespace

SolveReport BiconjugateGradient::solve(const PressureSystem& system, const Preconditioner& precondition,
                                       const ScalarField& p) {
  const int count = system.count();
  for (ScalarField* field : {&r_, &shadow_, &d_, &v_, &t_, &z_})
    if (field->extent(0) < p.extent(0)) *field = uncleared<ScalarField>("greenwater::bicg", p.extent(0));
  hold_surface(system.fixed(), p, count);
  const accum b_norm = std::sqrt(blas::dot(system.rhs(), system.rhs(), count));
  if (b_norm == 0) {
    clear_pressure(p, count);
    return {};
  }
  system.apply(p, r_);
  blas::axpby(1, system.rhs(), -1, r_, count);  // r = b - A p
  blas::axpby(1, r_, 0, shadow_, count);
  accum residual = std::sqrt(blas::dot(r_, r_, count)), rho_before = 1, alpha = 1, omega = 1;
  const accum enough = std::fmax(options_.tolerance * b_norm, static_cast<accum>(options_.absolute));
  bool fresh = true;  // the direction begins anew
  for (int k = 0;; ++k) {
    if (!std::isfinite(residual)) return stopped(k, residual / b_norm, "not a number");
    if (residual <= enough) return {k, static_cast<real>(residual / b_norm), true, "converged"};
    if (k == options_.max_iterations) return stopped(k, residual / b_norm, "too many iterations");
    accum rho = blas::dot(shadow_, r_, count);
    if (!fresh && std::fabs(rho) < 1e-8 * residual * std::sqrt(blas::dot(shadow_, shadow_, count))) {
      blas::axpby(1, r_, 0, shadow_, count);
      rho = residual * residual;
      fresh = true;
    }
    const accum beta = fresh ? 0 : rho / rho_before * (alpha / omega);
    advance_direction(static_cast<real>(beta), static_cast<real>(omega), r_, v_, d_, count);
    fresh = false;
    precondition.apply(d_, z_);
    system.apply(z_, v_);
    const accum along_shadow = blas::dot(shadow_, v_, count);
    if (along_shadow == 0 || !std::isfinite(along_shadow))
      return stopped(k, residual / b_norm, "the matrix is singular on this direction");
    alpha = rho / along_shadow;
    blas::axpby(static_cast<real>(alpha), z_, 1, p, count);
    blas::axpby(static_cast<real>(-alpha), v_, 1, r_, count);
    rho_before = rho;
    precondition.apply(r_, z_);
    system.apply(z_, t_);
    const Products with_t = products(t_, r_, count);
    if (!(with_t.tt > 0)) {
      residual = std::sqrt(blas::dot(r_, r_, count));
      omega = 1;
      fresh = true;
      if (residual > enough) return stopped(k, residual / b_norm, "the matrix is singular on this direction");
      continue;
    }
    omega = with_t.tr / with_t.tt;
    blas::axpby(static_cast<real>(omega), z_, 1, p, count);
    blas::axpby(static_cast<real>(-omega), t_, 1, r_, count);
    residual = std::sqrt(blas::dot(r_, r_, count));
    if (omega == 0) fresh = true;
  }
}

}  // namespace greenwater
