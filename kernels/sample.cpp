#include "kernels/sample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/check.hpp"
#include "core/whole.hpp"
#include "kernels/speed.hpp"

namespace greenwater {
namespace {

template <int Dim>
coord wave_front_in(const Fluid& fluid) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto neighbours = Read<IndexField>(fluid.rows.near.number);
  coord front = std::numeric_limits<coord>::lowest();
  Kokkos::parallel_reduce(
      "greenwater::wave_front", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, coord& most) {
        if (neighbours(i) > Dim) most = larger(most, x(i, 0));
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
  const double mass = fluid.rho * std::pow(fluid.spacing, Dim);
  FluidSums sums;
  sums.kinetic = mass * kinetic;
  sums.potential = mass * potential;
  sums.max_speed = max_speed(fluid);
  sums.density_error = inside > 0 ? std::sqrt(error2 / inside) : 0;
  return sums;
}

}  // namespace

namespace {

using Place = std::array<coord, 3>;

constexpr int most_patches = 10'000'000;  // of a wall: memory

Place between(const Place& a, const Place& b, coord s) {
  Place x;
  for (int d = 0; d < 3; ++d) x[d] = a[d] + s * (b[d] - a[d]);
  return x;
}

coord distance(const Place& a, const Place& b) { return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]); }

// Never many more than are allowed.
int pieces_of(coord whole, coord length) { return whole_within(std::ceil(whole / length - 1e-9), 1, most_patches + 1); }

void cut_segment(const Place& a, const Place& b, const Place& normal, coord length, std::vector<WallPatch>& patches) {
  const coord whole = distance(a, b);
  const int pieces = pieces_of(whole, length);
  for (int k = 0; k < pieces; ++k) patches.push_back({between(a, b, (k + 0.5) / pieces), normal, whole / pieces});
}

// Of the longest side.
int pieces_of(const FaceCorners& c, coord length) {
  return pieces_of(std::max({distance(c[0], c[1]), distance(c[1], c[2]), distance(c[2], c[0])}), length);
}

// How many patches a face is cut into.
double places_on(const FaceCorners& c, int dim, coord length) {
  return dim == 2 ? pieces_of(distance(c[0], c[1]), length) : std::pow(pieces_of(c, length), 2);
}

// Into n^2 triangles of one shape.
void cut_triangle(const FaceCorners& corner, const Place& normal, coord length, std::vector<WallPatch>& patches) {
  const auto& [a, b, c] = corner;
  coord twice_area = 0;
  for (int d = 0; d < 3; ++d) {
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    twice_area += normal[d] * ((b[e] - a[e]) * (c[f] - a[f]) - (b[f] - a[f]) * (c[e] - a[e]));
  }
  const int n = pieces_of(corner, length);
  const auto at = [&](coord s, coord t) {
    Place x;
    for (int d = 0; d < 3; ++d) x[d] = a[d] + s / n * (b[d] - a[d]) + t / n * (c[d] - a[d]);
    return x;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      patches.push_back({at(i + 1 / 3.0, j + 1 / 3.0), normal, twice_area / 2 / n / n});
      if (i + j + 1 < n) patches.push_back({at(i + 2 / 3.0, j + 2 / 3.0), normal, twice_area / 2 / n / n});
    }
}

}  // namespace

std::vector<WallPatch> wall_patches(const WallFaces& walls, int body, coord length) {
  std::vector<WallPatch> patches;
  for (const WallFace& face : walls.faces) {
    if (face.body != body || face.repeated) continue;
    const FaceCorners corner = corners_of(face);
    const Place normal = face_normal(corner, walls.dim);
    if (normal == Place{}) continue;  // nothing pushes on a face without area
    require<ResourceError>(places_on(corner, walls.dim, length) + patches.size() <= most_patches, "the wall \"",
                           walls.bodies[body].name, "\" would be read at more than ", most_patches,
                           " places; take a larger mps.spacing or a smaller wall");
    if (walls.dim == 2)
      cut_segment(corner[0], corner[1], normal, length, patches);
    else
      cut_triangle(corner, normal, length, patches);
  }
  return patches;
}

std::array<double, 3> wall_force(PointSampler& sampler, const Fluid& fluid, const std::vector<WallPatch>& patches,
                                 Reading reading) {
  const coord off = 1e-3 * fluid.spacing;
  std::vector<std::array<coord, 3>> points;
  for (const WallPatch& patch : patches)
    for (const coord side : {off, -off}) {
      points.push_back(patch.centre);
      for (int d = 0; d < 3; ++d) points.back()[d] += side * patch.normal[d];
    }
  const std::vector<double> p = sampler.pressure(fluid, points, reading);
  std::array<double, 3> force{};
  for (std::size_t k = 0; k < patches.size(); ++k)
    for (int d = 0; d < 3; ++d) force[d] += (p[2 * k + 1] - p[2 * k]) * patches[k].normal[d] * patches[k].area;
  return force;
}

double wave_front(const Fluid& fluid) {
  return (fluid.particles.dim == 2 ? wave_front_in<2>(fluid) : wave_front_in<3>(fluid)) + fluid.spacing / 2;
}

double surface_height(const Fluid& fluid, coord at, std::optional<coord> across) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const int up = fluid.particles.dim - 1;
  const coord half = fluid.spacing / 2 * (1 + 1e-9);  // a lattice column beside x counts, whatever the round-off
  const bool all = !across;
  const coord y = across.value_or(0);
  coord top = std::numeric_limits<coord>::lowest();
  Kokkos::parallel_reduce(
      "greenwater::surface_height", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, coord& most) {
        if (fabs(x(i, 0) - at) <= half && (all || fabs(x(i, 1) - y) <= half)) most = larger(most, x(i, up));
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
