#pragma once
// What kernels and effects are given: the particles, their walls and their neighbours.

#include "core/particles.hpp"
#include "kernels/least_squares.hpp"
#include "kernels/mirror_wall.hpp"
#include "kernels/neighbor_rows.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// A weight function with its lattice sums.
struct Kernel {
  Weight weight;
  Reference reference;
};

struct Fluid {
  Particles particles;
  WallFaces faces;              // walls as they stand now, on the host ...
  MirrorWalls walls;            // ... and made of them, on the device
  CellGrid grid;                // the particles are in its order since the last sort
  NeighborRows rows;            // with the weight of the Laplacian beside each entry
  LeastSquares fits;            // of the scheme "high"; else empty
  Kernel density;               // of n
  Kernel gradient;              // of grad p and div u
  Kernel laplacian;             // of the pressure operator and of viscosity
  bool keep_weights = true;     // beside the rows; false: computed from the positions each time
  coord spacing = 0;            // l0 [m]
  real rho = 1000;              // [kg/m^3]
  real gravity[3] = {0, 0, 0};  // g [m/s^2]
  accum time = 0;               // t at the start of the step [s]
  int body_force = -1;          // place in particles.extras of a force per mass beside gravity [m/s^2], or -1
};

/// Device view of who is around whom, at the places of now.
template <int Dim>
Around<Dim> around(const Fluid& fluid) {
  return fluid.rows.around<Dim>(fluid.particles, fluid.walls);
}

/// As around(), before anything has moved since the rows were built; for sums with the given weight.
template <int Dim>
Around<Dim> around_unmoved(const Fluid& fluid, const Weight& weight) {
  return fluid.rows.around_unmoved<Dim>(fluid.particles, fluid.walls, weight);
}

/// What the rows of a fluid are made with.
inline RowOptions row_options(const Fluid& fluid) {
  const real widest =
      larger(larger(fluid.density.weight.radius, fluid.gradient.weight.radius), fluid.laplacian.weight.radius);
  return {fluid.density.weight, fluid.laplacian.weight, widest, fluid.keep_weights};
}

/// Device view of all that drives a particle beside pressure: g, and a body force where a scene names one.
template <int Dim>
struct Drive {
  real gravity[3];
  Read<VectorField> extra;
  bool has_extra;

  /// The part along a direction, of particle j.
  KOKKOS_INLINE_FUNCTION coord along(const Vec<Dim, coord>& direction, int j) const {
    coord sum = 0;
    for (int d = 0; d < Dim; ++d) sum += direction[d] * (gravity[d] + (has_extra ? extra(j, d) : real(0)));
    return sum;
  }

  /// Of particles j.
  KOKKOS_INLINE_FUNCTION Vec<Dim, Pack> at(const IndexPack& j) const {
    Vec<Dim, Pack> g;
    for (int d = 0; d < Dim; ++d) g[d] = all_lanes<Pack>(gravity[d]);
    if (has_extra) g = greenwater::along(g, all_lanes<Pack>(real(1)), gather_pack<Dim>(extra, j));
    return g;
  }
};

template <int Dim>
Drive<Dim> drive_of(const Fluid& fluid) {
  const bool extra = fluid.body_force >= 0;
  return {{fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]},
          extra ? Read<VectorField>(fluid.particles.extras[fluid.body_force].values) : Read<VectorField>(),
          extra};
}

}  // namespace greenwater
