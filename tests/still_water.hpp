#pragma once
// Water in an open tank, 1 m deep, on a lattice that is shaken; and what a survey of it says.

#include <cmath>

#include "kernels/survey.hpp"
#include "tests/shapes.hpp"
#include "tests/support.hpp"

namespace greenwater::test {

constexpr coord l0 = 0.1;
constexpr real dt = real(1e-3), g = real(9.81);

inline WallFaces tank_2d(coord width, coord height) {
  return walls_of({segment(0, 0, width, 0), segment(0, height, 0, 0), segment(width, 0, width, height)});
}

inline Positions shaken(int nx, int ny, int nz, coord jitter, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<coord> shake(-jitter * l0, jitter * l0);
  Positions x;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        x.push_back(
            {(i + 0.5) * l0 + shake(generator), (j + 0.5) * l0 + shake(generator), (k + 0.5) * l0 + shake(generator)});
  return x;
}

inline FluidOptions standard(int dim, coord radius) {
  FluidOptions options;
  options.dim = dim;
  options.spacing = l0;
  options.radius = radius;
  options.shift = 0;
  return options;
}

// Water 1 m deep, on a lattice that is shaken.
inline Fluid tank(int dim, coord radius, coord jitter) {
  if (dim == 2) {
    Fluid fluid = fluid_at(lattice(12, 10, l0, 0, 0, jitter), tank_2d(1.2, 2), standard(2, radius));
    fluid.gravity[1] = -g;
    return fluid;
  }
  Fluid fluid = fluid_at(shaken(8, 7, 10, jitter), open_box(0.8, 0.7, 2), standard(3, radius));
  fluid.gravity[2] = -g;
  return fluid;
}

inline Survey surveyed(const Fluid& fluid, SurveyOptions options = {}) {
  Survey found;
  const auto table = make_lattice_table(fluid.gradient.weight, fluid.particles.dim, fluid.spacing);
  survey(fluid, table, options, dt, found);
  return found;
}

template <class F>
void set_pressure(Fluid& fluid, F of_place) {
  const auto x = host(fluid.particles.position);
  const auto p = Kokkos::create_mirror(fluid.particles.pressure);
  for (int i = 0; i < fluid.particles.count; ++i)
    p(i) = static_cast<real>(of_place(std::array<coord, 3>{x(i, 0), x(i, 1), fluid.particles.dim == 3 ? x(i, 2) : 0}));
  Kokkos::deep_copy(fluid.particles.pressure, p);
}

template <class F>
void set_velocity(Fluid& fluid, F of_place) {
  const auto x = host(fluid.particles.position);
  const auto u = Kokkos::create_mirror(fluid.particles.velocity);
  for (int i = 0; i < fluid.particles.count; ++i) {
    const auto v = of_place(std::array<coord, 3>{x(i, 0), x(i, 1), fluid.particles.dim == 3 ? x(i, 2) : 0});
    for (int d = 0; d < fluid.particles.dim; ++d) u(i, d) = static_cast<real>(v[d]);
  }
  Kokkos::deep_copy(fluid.particles.velocity, u);
}

inline double depth_pressure(const Fluid& fluid, const std::array<coord, 3>& x) {
  return fluid.rho * g * (1 - x[fluid.particles.dim - 1]);
}

struct Kind {
  int dim;
  coord radius;  // x l0
  coord jitter;  // x l0; twelve neighbours bear less before one of them tells of a surface where there is none
};
inline const Kind kinds[] = {{2, 3.1, 0.1}, {2, 2.1, 0.05}, {3, 2.1, 0.1}, {3, 3.1, 0.1}};

}  // namespace greenwater::test
