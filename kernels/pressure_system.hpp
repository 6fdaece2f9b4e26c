#pragma once
// The pressure Poisson equation, never stored as a matrix: A p = b with A the MPS Laplacian (sign turned), from the rows.

#include "kernels/added_term.hpp"
#include "kernels/fluid.hpp"

namespace greenwater {

enum class PressureSource { density, divergence };

struct PressureOptions {
  real diagonal_factor = 1;  // C    multiplies the diagonal (Tanaka and Masunaga 2010; the paper's Table 2: 1.05)
  real source_factor = 1;    // gamma  multiplies the density source (the paper's Table 2: 1.0)
  real compressibility = 0;  // alpha_c [1/Pa]; adds rho alpha_c / dt^2 to the diagonal
  PressureSource source = PressureSource::density;
};

/// (A p)_i = K (C p_i sum_j w_ij - sum_j w_ij p_j) + (rho alpha_c / dt^2) p_i,  K = 2 d / (lambda n^0); j runs over
/// neighbours and images, and an image has the pressure of its particle: the wall's Neumann condition is in the source.
/// Where the surface is marked p = 0: those rows are left out, and A is symmetric positive definite on the others.
///   density     b_i = gamma (rho / dt^2) (n_i - n^0) / n^0
///   divergence  b_i = -(rho / dt) (d / n^0) sum_j (u_j - u_i) . r_ij w_ij / r_ij^2
class PressureSystem {
 public:
  explicit PressureSystem(const PressureOptions& options) : options_(options) {}

  /// Right side and diagonal from the particles' number density, surface marks, velocity and rows.
  /// `fluid` must outlive every apply() until the next assemble().
  void assemble(const Fluid& fluid, real dt);

  /// Takes right side, diagonal and rows to be left out (1) as somebody made them: fields like those of the particles.
  void assemble(const Fluid& fluid, const ScalarField& rhs, const ScalarField& diagonal, const FlagField& fixed);

  /// A is made of these from now on, until the next assemble(): weights over K in the places of the rows', and a diagonal. What
  /// preconditioners look at stays as it was. Then A is not symmetric.
  void replace_rows(const FloatField& weights, const ScalarField& diagonal);
  bool symmetric() const { return weights_.extent(0) == 0; }

  /// Nothing holds p anywhere: of all pressures that differ by a constant the one without a mean is meant, and of the
  /// equations what is left when their mean is taken off. Until the next assemble().
  void close();
  bool closed() const { return closed_; }
  /// Takes the mean off; of what is not held.
  void remove_mean(const ScalarField& p) const;

  /// Makes the diagonal larger by this part of itself: as if the fluid were more compressible.
  void raise_diagonal(real part);

  /// Adds a term to A, or with null takes it away; it must outlive every apply(). The diagonal stays as it is.
  void set_added(const AddedTerm* added) { added_ = added; }

  /// Ap = A p; 0 where the surface is. Returns p . A p.
  accum apply(const ScalarField& p, const ScalarField& Ap) const;

  int count() const { return fluid_ ? fluid_->particles.count : 0; }
  const ScalarField& rhs() const { return rhs_; }            // b [Pa/m^2]
  const ScalarField& diagonal() const { return diagonal_; }  // [1/m^2]; 1 where the surface is; of the symmetric rows
  const FlagField& fixed() const { return fixed_; }          // 1 where the row is left out, p = 0
  const Fluid& fluid() const { return *fluid_; }
  real factor() const;  // K [1/m^2]
  const AddedTerm* added() const { return added_; }

 private:
  PressureOptions options_;
  const Fluid* fluid_ = nullptr;
  const AddedTerm* added_ = nullptr;
  ScalarField rhs_, diagonal_;
  FloatField weights_;        // that replace those of the rows; empty: nothing does
  ScalarField row_diagonal_;  // with them
  bool closed_ = false;
  FlagField fixed_;
};

}  // namespace greenwater
