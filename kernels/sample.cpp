#include "kernels/sample.hpp"

#include <cmath>
#include <limits>

namespace greenwater {
namespace {

template <int Dim>
void sample_pressure_in(const Fluid& fluid, const CoordField& point, const ScalarField& value, int count) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto first = Read<IndexField>(fluid.grid.first());
  const auto grid = fluid.grid.shape();
  const auto walls = fluid.walls;
  const auto w = fluid.gradient.weight;
  Kokkos::parallel_for(
      "greenwater::sample_pressure", Range(0, count), KOKKOS_LAMBDA(const int i) {
        const auto q = load<Dim>(point, i);
        const auto sight = sight_from(walls, grid, q);
        accum sum_w = 0, sum_wp = 0;
        for_each_candidate<Dim>(grid, first, q, [&](const int j) {
          const auto xj = load<Dim>(x, j);
          const auto r = difference(xj, q);
          const real weight = w(static_cast<real>(sqrt(dot(r, r))));
          if (!(weight > 0) || !sight.sees(q, xj)) return;
          sum_w += weight;
          sum_wp += weight * p(j);
        });
        value(i) = sum_w > 0 ? static_cast<real>(sum_wp / sum_w) : real(0);
      });
}

template <int Dim>
coord wave_front_in(const Fluid& fluid) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto first = Read<OffsetField>(fluid.rows.near.first);
  coord front = std::numeric_limits<coord>::lowest();
  Kokkos::parallel_reduce(
      "greenwater::wave_front", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, coord& most) {
        if (first(i + 1) - first(i) > Dim) most = larger(most, x(i, 0));
      },
      Kokkos::Max<coord>(front));
  return front;
}

template <int Dim>
FluidSums fluid_sums_in(const Fluid& fluid, const std::array<coord, 3>& reference) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const auto n = Read<ScalarField>(fluid.particles.number_density);
  const auto surface = Read<FlagField>(fluid.particles.surface);
  const real n0 = fluid.density.reference.n0;
  const coord x0[3] = {reference[0], reference[1], reference[2]};
  const real g[3] = {fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]};
  accum kinetic = 0, potential = 0, error2 = 0;
  int inside = 0;
  real fastest2 = 0;
  Kokkos::parallel_reduce(
      "greenwater::fluid_sums", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, accum& ke, accum& pe, accum& e2, int& number) {
        const auto ui = load<Dim>(u, i);
        ke += dot(ui, ui) / 2;
        for (int d = 0; d < Dim; ++d) pe -= g[d] * (x(i, d) - x0[d]);
        if (surface(i)) return;
        const accum error = n(i) / n0 - 1;
        e2 += error * error;
        ++number;
      },
      kinetic, potential, error2, inside);
  Kokkos::parallel_reduce(
      "greenwater::max_speed", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, real& most) {
        const auto ui = load<Dim>(u, i);
        most = larger(most, dot(ui, ui));
      },
      Kokkos::Max<real>(fastest2));
  const double mass = fluid.rho * std::pow(fluid.spacing, Dim);
  FluidSums sums;
  sums.kinetic = mass * kinetic;
  sums.potential = mass * potential;
  sums.max_speed = std::isfinite(kinetic) ? std::sqrt(fastest2) : kinetic;  // a maximum may overlook what is no number
  sums.density_error = inside > 0 ? std::sqrt(error2 / inside) : 0;
  return sums;
}

}  // namespace

std::vector<double> PointSampler::pressure(const Fluid& fluid, const std::vector<std::array<coord, 3>>& points) {
  const int count = static_cast<int>(points.size()), dim = fluid.particles.dim;
  if (static_cast<int>(point_.extent(0)) < count) {
    point_ = CoordField("greenwater::sample_point", count, dim);
    value_ = ScalarField("greenwater::sample_value", count);
    point_host_ = Kokkos::create_mirror(point_);
    value_host_ = Kokkos::create_mirror(value_);
  }
  for (int i = 0; i < count; ++i)
    for (int d = 0; d < dim; ++d) point_host_(i, d) = points[i][d];
  Kokkos::deep_copy(point_, point_host_);
  dim == 2 ? sample_pressure_in<2>(fluid, point_, value_, count) : sample_pressure_in<3>(fluid, point_, value_, count);
  Kokkos::deep_copy(value_host_, value_);
  std::vector<double> values(count);
  for (int i = 0; i < count; ++i) values[i] = value_host_(i);
  return values;
}

std::vector<WallPatch> wall_patches(const WallFaces& walls, int body, coord length) {
  std::vector<WallPatch> patches;
  for (const WallFace& face : walls.faces) {
    if (face.body != body) continue;
    const coord tx = face.end[1][0] - face.end[0][0], ty = face.end[1][1] - face.end[0][1];
    const coord whole = std::hypot(tx, ty);
    const int pieces = static_cast<int>(std::ceil(whole / length - 1e-9));
    for (int k = 0; k < pieces; ++k) {
      const coord s = (k + 0.5) / pieces;
      patches.push_back(
          {{face.end[0][0] + s * tx, face.end[0][1] + s * ty, 0}, {-ty / whole, tx / whole, 0}, whole / pieces});
    }
  }
  return patches;
}

std::array<double, 3> wall_force(PointSampler& sampler, const Fluid& fluid, const std::vector<WallPatch>& patches) {
  const coord off = 1e-3 * fluid.spacing;
  std::vector<std::array<coord, 3>> points;
  for (const WallPatch& patch : patches)
    for (const coord side : {off, -off}) {
      points.push_back(patch.centre);
      for (int d = 0; d < 3; ++d) points.back()[d] += side * patch.normal[d];
    }
  const std::vector<double> p = sampler.pressure(fluid, points);
  std::array<double, 3> force{};
  for (std::size_t k = 0; k < patches.size(); ++k)
    for (int d = 0; d < 3; ++d) force[d] += (p[2 * k + 1] - p[2 * k]) * patches[k].normal[d] * patches[k].area;
  return force;
}

double wave_front(const Fluid& fluid) {
  return (fluid.particles.dim == 2 ? wave_front_in<2>(fluid) : wave_front_in<3>(fluid)) + fluid.spacing / 2;
}

double surface_height(const Fluid& fluid, coord at) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const int up = fluid.particles.dim - 1;
  const coord half = fluid.spacing / 2 * (1 + 1e-9);  // a lattice column beside x counts, whatever the round-off
  coord top = std::numeric_limits<coord>::lowest();
  Kokkos::parallel_reduce(
      "greenwater::surface_height", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, coord& most) {
        if (fabs(x(i, 0) - at) <= half) most = larger(most, x(i, up));
      },
      Kokkos::Max<coord>(top));
  return top + half;
}

std::int64_t particle_count(const Fluid& fluid, const std::array<coord, 3>& low, const std::array<coord, 3>& high) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const int dim = fluid.particles.dim;
  const coord from[3] = {low[0], low[1], low[2]}, to[3] = {high[0], high[1], high[2]};
  std::int64_t total = 0;
  Kokkos::parallel_reduce(
      "greenwater::particle_count", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, std::int64_t& sum) {
        bool inside = true;
        for (int d = 0; d < dim; ++d) inside = inside && x(i, d) >= from[d] && x(i, d) <= to[d];
        sum += inside;
      },
      total);
  return total;
}

FluidSums fluid_sums(const Fluid& fluid, const std::array<coord, 3>& reference) {
  return fluid.particles.dim == 2 ? fluid_sums_in<2>(fluid, reference) : fluid_sums_in<3>(fluid, reference);
}

}  // namespace greenwater
