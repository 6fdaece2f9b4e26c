#include "kernels/refined_cg.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "kernels/blas.hpp"

namespace greenwater {
namespace {

constexpr accum least_in_float = 1e-5;  // what a round in float can reduce the residual to
constexpr accum margin = 0.95;          // a round aims a little lower than the loop around it
constexpr accum stall = 0.5;            // a round that leaves more than this of the residual has met its rounding

struct Vectors {
  FloatField r, first, z, d, q, x;
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

// |b - A p|
accum residual_norm(const PressureSystem& system, const ScalarField& Ap) {
  const auto b = Read<ScalarField>(system.rhs());
  accum square = 0;
  Kokkos::parallel_reduce(
      "greenwater::residual_norm", Range(0, system.count()),
      KOKKOS_LAMBDA(const int i, accum& sum) {
        const accum r = b(i) - Ap(i);
        sum += r * r;
      },
      square);
  return std::sqrt(square);
}

// r = (b - A p) / norm, first = r / diagonal, x = d = q = 0. Beyond the last particle all are 0.
void begin_round(const PressureSystem& system, const FloatSystem& matrix, const ScalarField& Ap, accum norm,
                 const Vectors& v) {
  const auto b = Read<ScalarField>(system.rhs());
  const auto inverse = Read<FloatField>(matrix.inverse);
  const int count = system.count();
  const auto w = v;
  Kokkos::parallel_for(
      "greenwater::cg_begin_round", Range(0, padded(count)), KOKKOS_LAMBDA(const int i) {
        const float r = i < count ? static_cast<float>((b(i) - Ap(i)) / norm) : 0.0f;
        w.r(i) = r;
        w.first(i) = inverse(i) * r;
        w.x(i) = w.d(i) = w.q(i) = 0;
      });
}

// d = z + beta d, and with it q = A z + beta q = A d; returns d . q and d . d.
accum advance_direction(const FloatSystem& matrix, float beta, const Vectors& v) {
  const auto rows = matrix.rows;
  const auto diagonal = Read<FloatField>(matrix.diagonal);
  const auto w = v;
  accum dq = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_advance_direction", row_packs(matrix.count),
      KOKKOS_LAMBDA(const int pack, accum& sum) {
        const int i = pack * float_lanes;
        const FloatPack z = load_lanes<FloatPack>(&w.z(i)), own = load_lanes<FloatPack>(&diagonal(i));
        const FloatPack Az = zero_unless(own != 0.0f, own * z - row_product<FloatPack>(rows, w.z.data(), i));
        const FloatPack d = z + beta * load_lanes<FloatPack>(&w.d(i));
        const FloatPack q = Az + beta * load_lanes<FloatPack>(&w.q(i));
        store_lanes(&w.d(i), d);
        store_lanes(&w.q(i), q);
        sum += sum_lanes(d * q);
      },
      dq);
  return dq;
}

// x = x + alpha d, r = r - alpha q, first = r / diagonal; returns r . r.
accum advance_solution(const FloatSystem& matrix, float alpha, const Vectors& v) {
  const auto inverse = Read<FloatField>(matrix.inverse);
  const auto w = v;
  accum rr = 0;
  Kokkos::parallel_reduce(
      "greenwater::cg_advance_solution", row_packs(matrix.count),
      KOKKOS_LAMBDA(const int pack, accum& sum) {
        const int i = pack * float_lanes;
        store_lanes(&w.x(i), load_lanes<FloatPack>(&w.x(i)) + alpha * load_lanes<FloatPack>(&w.d(i)));
        const FloatPack r = load_lanes<FloatPack>(&w.r(i)) - alpha * load_lanes<FloatPack>(&w.q(i));
        store_lanes(&w.r(i), r);
        store_lanes(&w.first(i), load_lanes<FloatPack>(&inverse(i)) * r);
        sum += sum_lanes(r * r);
      },
      rr);
  return rr;
}

// p = p + scale x
void add_correction(const FloatField& x, accum scale, const ScalarField& p, int count) {
  const real s = static_cast<real>(scale);
  Kokkos::parallel_for(
      "greenwater::cg_add_correction", Range(0, count), KOKKOS_LAMBDA(const int i) { p(i) += s * x(i); });
}

struct Round {
  int iterations = 0;
  std::string_view cause;  // why it broke down; empty when it did not
};

// What a term that was added to the matrix has of q = A d, q knowing of the directions before; returns its d . q.
accum add_term(const PressureSystem& system, const FloatSystem& matrix, const Vectors& v) {
  return system.added() ? system.added()->add_product(matrix.inverse, 1 / system.factor(), v.z, v.d, v.q) : 0;
}

// A x = r in float, until |r| falls to `target` times what it was.
Round solve_in_float(const PressureSystem& system, Multigrid& multigrid, accum target, int most, const Vectors& v) {
  const FloatSystem& matrix = multigrid.system();
  accum rz_before = 0;
  for (int k = 0; k < most; ++k) {
    const accum rz = multigrid.finish(v.r, v.first, v.z);
    if (!std::isfinite(rz)) return {k, "not a number"};
    if (rz <= 0) return {k, "the preconditioner is not positive on this residual"};
    accum dq = advance_direction(matrix, k == 0 ? 0.0f : static_cast<float>(rz / rz_before), v);
    dq += add_term(system, matrix, v);
    if (!std::isfinite(dq)) return {k, "not a number"};
    if (dq <= 0) return {k, "the matrix is not positive on this direction (a closed cluster without a free surface?)"};
    const accum rr = advance_solution(matrix, static_cast<float>(rz / dq), v);
    if (!std::isfinite(rr)) return {k, "not a number"};
    if (std::sqrt(rr) <= target) return {k + 1, {}};
    rz_before = rz;
  }
  return {most, {}};
}

SolveReport stopped(int iterations, accum residual, std::string_view cause) {
  return {iterations, static_cast<real>(residual), false, cause};
}

}  // namespace

void RefinedCg::grow(int count) {
  const std::size_t room = padded(count) + float_lanes;
  if (r_.extent(0) >= room) return;
  const auto made = [&](const std::string& label) { return FloatField(label, room + room / 4); };
  Ap_ = ScalarField("greenwater::cg_product", room + room / 4);
  r_ = made("greenwater::cg_residual");
  first_ = made("greenwater::cg_first_sweep");
  z_ = made("greenwater::cg_preconditioned");
  d_ = made("greenwater::cg_direction");
  q_ = made("greenwater::cg_direction_product");
  x_ = made("greenwater::cg_correction");
}

SolveReport RefinedCg::solve(const PressureSystem& system, Multigrid& multigrid, const ScalarField& p) {
  const int count = system.count();
  grow(count);
  const Vectors v = {r_, first_, z_, d_, q_, x_};
  hold_surface(system.fixed(), p, count);
  const accum b_norm = std::sqrt(blas::dot(system.rhs(), system.rhs(), count));
  if (!std::isfinite(b_norm)) return stopped(0, b_norm, "not a number");
  if (b_norm == 0) {
    clear(p, count);
    return {};
  }
  const accum enough = std::fmax(options_.tolerance * b_norm, static_cast<accum>(options_.absolute));
  int iterations = 0;
  accum before = std::numeric_limits<accum>::infinity();
  for (;;) {
    system.apply(p, Ap_);
    const accum residual = residual_norm(system, Ap_);
    if (!std::isfinite(residual)) return stopped(iterations, residual / b_norm, "not a number");
    if (residual <= enough) return {iterations, static_cast<real>(residual / b_norm), true, "converged"};
    if (iterations >= options_.max_iterations) return stopped(iterations, residual / b_norm, "too many iterations");
    if (residual > stall * before) return stopped(iterations, residual / b_norm, "the residual no longer falls");
    before = residual;
    begin_round(system, multigrid.system(), Ap_, residual, v);
    const accum target = std::fmax(margin * enough / residual, least_in_float);
    const Round done = solve_in_float(system, multigrid, target, options_.max_iterations - iterations, v);
    iterations += done.iterations;
    if (!done.cause.empty()) return stopped(iterations, residual / b_norm, done.cause);
    add_correction(x_, residual / system.factor(), p, count);
  }
}

}  // namespace greenwater
