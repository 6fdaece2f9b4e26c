#pragma once
// Derivatives by least squares (LSMPS, Tamai and Koshizuka 2014): round each particle the quadratic polynomial that goes
// through its own value and is nearest to those of its neighbours and images, weighted with phi = (1 - r / r_e)^q,
// q = 2 r_e / l0 or so: the nearer ones tell more of curvature, whatever the radius. Exact for quadratic fields at any
// disorder, where sums with lattice constants are so on the lattice only. Every derivative is
//
//   sum_j phi_ij (a . P(r_ij)) (f_j - f_i),   P = (x, y, x^2/2, y^2/2, x y), in 3-D (x, y, z, x^2/2, y^2/2, z^2/2, x y, ...)
//
// with coefficients a of the particle: those of its moment matrix' inverse. They belong to the rows that they were made with.
// Where a fit cannot be trusted (too few neighbours, a moment matrix near to singular, the surface) its share is 0, and
// whoever takes derivatives takes the sums of the default scheme there.

#include "core/lanes.hpp"

namespace greenwater {

struct Fluid;
struct LatticeTable;
struct Survey;

/// What is known of the fits of all particles; empty in schemes that make none.
struct LeastSquares {
  VectorField coefficients;  // (i, m terms + k): of term k, for d/dx_m, and with m = Dim for the Laplacian
  ScalarField share;         // (i) 1: the fit; 0: what the default scheme has; between near the surface
  FloatField weight;         // (place) of the pressure's rows, over K, as Rows::weight
  ScalarField diagonal;      // (i) of the pressure's rows
  real radius = 0;           // r_e [m]
  int half_power = 0;        // q / 2
  real quartic = 0;          // c: the Laplacian on the lattice is Lap f + c Lap Lap f + ... [m^2]

  bool empty() const { return share.extent(0) == 0; }
};

/// Terms of the polynomial.
constexpr int fit_terms(int dim) { return dim == 2 ? 5 : 9; }

/// P(r), for a pack of particles.
template <int Dim>
struct FitBasis {
  Pack term[fit_terms(Dim)];

  KOKKOS_INLINE_FUNCTION explicit FitBasis(const Vec<Dim, Pack>& r) {
    int k = 0;
    for (int d = 0; d < Dim; ++d) term[k++] = r[d];
    for (int d = 0; d < Dim; ++d) term[k++] = real(0.5) * r[d] * r[d];
    for (int d = 0; d < Dim; ++d)
      for (int e = d + 1; e < Dim; ++e) term[k++] = r[d] * r[e];
  }
};

/// phi, from r^2 of a pack.
struct FitWeight {
  real per_radius;
  int half_power;

  template <class V>
  KOKKOS_INLINE_FUNCTION V operator()(const V& r2) const {
    const V rest = larger(1 - sqrt(r2) * per_radius, V{}), square = rest * rest;
    V power = square;
    for (int k = 1; k < half_power; ++k) power = power * square;
    return power;
  }
};

/// Device view of the fits of a pack of particles.
template <int Dim>
struct Fit {
  static constexpr int terms = fit_terms(Dim);
  Pack coefficient[(Dim + 1) * terms], share;
  FitWeight phi;

  /// What f_j - f_i of a neighbour or image at r counts in derivative m; `counts`: with which share it is seen at all.
  template <class Share>
  KOKKOS_INLINE_FUNCTION Pack factor(int m, const FitBasis<Dim>& P, const Pack& r2, Share counts) const {
    Pack sum{};
    for (int k = 0; k < terms; ++k) sum += coefficient[m * terms + k] * P.term[k];
    return counts * phi(r2) * sum;
  }
  /// The same of the gradient.
  template <class Share>
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> slope(const Vec<Dim, Pack>& r, Share counts) const {
    const FitBasis<Dim> P(r);
    const Pack scale = counts * phi(dot(r, r));
    Vec<Dim, Pack> q{};
    for (int d = 0; d < Dim; ++d) {
      for (int k = 0; k < terms; ++k) q[d] += coefficient[d * terms + k] * P.term[k];
      q[d] *= scale;
    }
    return q;
  }
  /// The same of the Laplacian.
  template <class Share>
  KOKKOS_INLINE_FUNCTION Pack bend(const Vec<Dim, Pack>& r, Share counts) const {
    return factor(Dim, FitBasis<Dim>(r), dot(r, r), counts);
  }
};

/// Views that kernels take by value; none of it is there in schemes without fits.
template <int Dim>
struct Fits {
  Read<VectorField> coefficients;
  Read<ScalarField> share;
  FitWeight phi;
  bool any;

  explicit Fits(const LeastSquares& fits)
      : coefficients(fits.coefficients), share(fits.share), phi{1 / fits.radius, fits.half_power}, any(!fits.empty()) {}
  KOKKOS_INLINE_FUNCTION Fit<Dim> of(int i) const {
    Fit<Dim> fit;
    for (int k = 0; k < (Dim + 1) * Fit<Dim>::terms; ++k) fit.coefficient[k] = load_lanes<Pack>(&coefficients(i, k));
    fit.share = load_pack(share, i);
    fit.phi = phi;
    return fit;
  }
};

/// Makes fluid.fits for the rows as they are, with the radius of the gradient.
void fit_neighbourhoods(Fluid& fluid, const LatticeTable& table);

/// The rows of the pressure with Laplacians by least squares, as far as each particle's share goes, and those of the survey
/// for the rest: into fluid.fits.weight and diagonal. The matrix is not symmetric.
void weigh_rows(Fluid& fluid, const Survey& survey);

}  // namespace greenwater
