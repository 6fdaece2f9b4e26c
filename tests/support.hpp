#pragma once
// What tests share: clouds of particles, fluids without a case file, dense matrices, and ears for Kokkos.

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "kernels/density.hpp"
#include "kernels/preconditioner.hpp"
#include "tests/catch.hpp"

namespace greenwater::test {

using Positions = std::vector<std::array<coord, 3>>;

/// A random cloud in the unit box.
inline Positions random_cloud(int count, int dim, unsigned seed, coord size = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<coord> anywhere(0, size);
  Positions x(count, {0, 0, 0});
  for (auto& point : x)
    for (int d = 0; d < dim; ++d) point[d] = anywhere(generator);
  return x;
}

/// A lattice of cell centres in a box, each moved by up to jitter x spacing along every axis.
inline Positions lattice(int nx, int ny, coord l0, coord x0 = 0, coord y0 = 0, coord jitter = 0, unsigned seed = 1) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<coord> shake(-jitter * l0, jitter * l0);
  Positions x;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      x.push_back({x0 + (i + 0.5) * l0 + shake(generator), y0 + (j + 0.5) * l0 + shake(generator), 0});
  return x;
}

inline Particles particles_at(const Positions& at, int dim) {
  Particles p = make_particles(dim, static_cast<int>(at.size()));
  const auto x = Kokkos::create_mirror(p.position);
  for (int i = 0; i < p.count; ++i)
    for (int d = 0; d < dim; ++d) x(i, d) = at[i][d];
  Kokkos::deep_copy(p.position, x);
  return p;
}

inline WallFace segment(coord x0, coord y0, coord x1, coord y1, int body = 0) {
  WallFace face;
  face.corner[0].position = {x0, y0, 0};
  face.corner[1].position = {x1, y1, 0};
  face.body = body;
  return face;
}

inline WallFaces walls_of(std::vector<WallFace> faces) {
  WallFaces walls;
  walls.bodies = {{"a"}, {"b"}, {"c"}};
  walls.faces = std::move(faces);
  return walls;
}

struct FluidOptions {
  int dim = 2;
  coord spacing = 0.1;
  coord radius = 3.1;  // x spacing
  real shift = real(0.05);
  coord margin = 1;               // grid beyond the particles and walls [m]
  std::array<coord, 3> period{};  // from 0 on, along axes where it is not 0 [m]
};

/// A fluid of particles at the given places between the given walls, sorted, with rows and number density.
inline Fluid fluid_at(const Positions& at, const WallFaces& walls = {}, const FluidOptions& options = {}) {
  Fluid fluid;
  fluid.spacing = options.spacing;
  const Weight weight{static_cast<real>(options.radius * options.spacing), options.shift};
  fluid.density = {weight, lattice_reference(weight, options.dim, options.spacing)};
  fluid.gradient = fluid.laplacian = fluid.density;
  std::array<coord, 3> low{0, 0, 0}, high{0, 0, 0};
  const auto widen = [&](const std::array<coord, 3>& x) {
    for (int d = 0; d < options.dim; ++d) {
      low[d] = std::min(low[d], x[d]);
      high[d] = std::max(high[d], x[d]);
    }
  };
  for (const auto& x : at) widen(x);
  for (const auto& face : walls.faces)
    for (int e = 0; e < options.dim; ++e) widen(face.corner[e].position);
  for (int d = 0; d < options.dim; ++d) {
    low[d] -= options.margin;
    high[d] += options.margin;
  }
  std::array<bool, 3> repeats{};
  for (int d = 0; d < options.dim; ++d) {
    repeats[d] = options.period[d] > 0;
    if (!repeats[d]) continue;
    low[d] = 0;
    high[d] = options.period[d];
  }
  fluid.grid = CellGrid(make_grid(options.dim, low, high, weight.radius, repeats));
  fluid.faces = walls;
  fluid.faces.dim = options.dim;
  make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), options.spacing);
  fluid.particles = particles_at(at, options.dim);
  fluid.grid.sort(fluid.particles);
  fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
  return fluid;
}

/// The first `count` values of a field, on the host.
template <class Field>
auto host(const Field& field) {
  auto mirror = Kokkos::create_mirror_view(field);
  Kokkos::deep_copy(mirror, field);
  return mirror;
}

/// Value of each particle by its id: the order in which it was given.
template <class Field>
std::vector<double> by_id(const Fluid& fluid, const Field& field) {
  const auto id = host(fluid.particles.id);
  const auto value = host(field);
  std::vector<double> values(fluid.particles.count);
  for (int i = 0; i < fluid.particles.count; ++i) values[id(i)] = value(i);
  return values;
}

/// What particle i sees: entry by entry, neighbours first.
struct Entry {
  int j;
  int mirror;  // -1: j itself
  double share, weight;
};

/// The rows as they are stored, on the host. Entries of images of i itself, which have no weight in the operator, have
/// weight 0; so has everything when weights are not kept.
inline std::vector<std::vector<Entry>> entries_of(const Fluid& fluid) {
  const Rows& near = fluid.rows.near;
  const ImageRows& images = fluid.rows.images;
  const auto first = host(near.first), image_first = host(images.first);
  const auto number = host(near.number), index = host(near.index), image_number = host(images.number),
             image_index = host(images.index), mirror = host(images.mirror);
  const auto weight = host(near.weight);
  const auto share = host(images.share);
  std::vector<std::vector<Entry>> rows(fluid.particles.count);
  for (int i = 0; i < fluid.particles.count; ++i) {
    const auto at = [&](const auto& begin, int k) {
      return begin(i / row_lanes) + static_cast<std::int64_t>(k) * row_lanes + i % row_lanes;
    };
    const auto weight_at = [&](int k) { return weight.extent(0) > 0 ? weight(at(first, k)) : 0.0; };
    int k = 0;
    for (; k < number(i); ++k) rows[i].push_back({index(at(first, k)), -1, 1, weight_at(k)});
    if (image_number.extent(0) == 0) continue;
    for (int m = 0; m < image_number(i); ++m) {
      const auto place = at(image_first, m);
      const int j = image_index(place);
      rows[i].push_back({j, mirror(place), share(place), j == i ? 0 : weight_at(k++)});
    }
  }
  return rows;
}

/// The operator as a dense matrix, one unit vector at a time.
inline Eigen::MatrixXd dense(const PressureSystem& system) {
  const int n = system.count();
  Eigen::MatrixXd matrix(n, n);
  ScalarField p("greenwater::test_unit", padded(n)), Ap("greenwater::test_product", padded(n));
  for (int j = 0; j < n; ++j) {
    const auto unit = Kokkos::create_mirror(p);
    unit(j) = host(system.fixed())(j) ? 0 : 1;  // the operator takes p = 0 at the surface for granted
    Kokkos::deep_copy(p, unit);
    system.apply(p, Ap);
    const auto column = host(Ap);
    for (int i = 0; i < n; ++i) matrix(i, j) = column(i);
  }
  return matrix;
}

/// Particles whose pressure is unknown.
inline std::vector<int> free_particles(const Fluid& fluid) {
  const auto surface = host(fluid.particles.surface);
  std::vector<int> found;
  for (int i = 0; i < fluid.particles.count; ++i)
    if (!surface(i)) found.push_back(i);
  return found;
}

/// The preconditioner as a dense matrix, one unit vector at a time; 0 at the surface.
inline Eigen::MatrixXd dense(const Preconditioner& preconditioner, const Fluid& fluid) {
  const int n = fluid.particles.count;
  const ScalarField r("greenwater::test_unit", padded(n)), z("greenwater::test_product", padded(n));
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n, n);
  for (const int j : free_particles(fluid)) {
    const auto unit = Kokkos::create_mirror(r);
    unit(j) = 1;
    Kokkos::deep_copy(r, unit);
    preconditioner.apply(r, z);
    const auto column = host(z);
    for (int i = 0; i < n; ++i) M(i, j) = column(i);
  }
  return M;
}

/// Anything at the particles whose pressure is unknown, and 0 elsewhere.
inline ScalarField random_residual(const Fluid& fluid, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> any;
  const ScalarField r("greenwater::test_residual", padded(fluid.particles.count));
  const auto values = Kokkos::create_mirror(r);
  for (const int i : free_particles(fluid)) values(i) = static_cast<real>(any(generator));
  Kokkos::deep_copy(r, values);
  return r;
}

/// a . M b is b . M a, and what apply() returns.
inline void check_symmetric(const Preconditioner& preconditioner, const Fluid& fluid) {
  const ScalarField a = random_residual(fluid, 5), b = random_residual(fluid, 6), z("greenwater::test_z", a.extent(0));
  const auto product = [&](const ScalarField& left, const ScalarField& right) {
    preconditioner.apply(right, z);
    const auto l = host(left), r = host(z);
    double sum = 0;
    for (int i = 0; i < fluid.particles.count; ++i) sum += static_cast<double>(l(i)) * r(i);
    return sum;
  };
  const double aa = product(a, a), scale = std::sqrt(aa * product(b, b));
  CHECK(std::abs(product(a, b) - product(b, a)) <= 1e-6 * scale);
  CHECK(std::abs(preconditioner.apply(a, z) - aa) <= 1e-6 * aa);
}

/// What has seen other fluids does to the last bit what a preconditioner does that has not.
template <class P>
void check_forgets(P& kept, const PressureSystem& system, const Fluid& fluid) {
  kept.update(system);
  P fresh;
  fresh.update(system);
  const ScalarField r = random_residual(fluid, 7), z("greenwater::test_kept", r.extent(0)),
                    y("greenwater::test_fresh", r.extent(0));
  kept.apply(r, z);
  fresh.apply(r, y);
  const auto of_kept = host(z), of_fresh = host(y);
  for (int i = 0; i < fluid.particles.count; ++i) REQUIRE(of_kept(i) == of_fresh(i));
}

/// Listens to Kokkos: the labels of all launches and of all allocations while it lives. One at a time.
class Ears {
 public:
  Ears();
  ~Ears();
  std::vector<std::string> launches, allocations;

  bool launched(const std::string& part) const { return any(launches, part); }
  bool allocated(const std::string& part) const { return any(allocations, part); }

 private:
  static bool any(const std::vector<std::string>& labels, const std::string& part) {
    return std::any_of(labels.begin(), labels.end(), [&](const auto& l) { return l.find(part) != std::string::npos; });
  }
};

}  // namespace greenwater::test
