#include "app/build.hpp"

#include <algorithm>
#include <cmath>

#include "app/fill.hpp"
#include "app/formula.hpp"
#include "app/random.hpp"
#include "app/rim.hpp"
#include "app/scene_shape.hpp"
#include "core/check.hpp"
#include "kernels/density.hpp"
#include "kernels/speed.hpp"

namespace greenwater {
namespace {

void set_velocity(const Scene& scene, Particles& particles) {
  const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), particles.position);
  const auto u = Kokkos::create_mirror(particles.velocity);
  const auto velocity = compile(scene.fluid.velocity.text, scene.fluid.velocity.place);
  for (int i = 0; i < particles.count; ++i)
    for (int d = 0; d < scene.dimension; ++d)
      u(i, d) = static_cast<real>(velocity[d](x(i, 0), x(i, 1), scene.dimension == 3 ? x(i, 2) : 0, 0));
  Kokkos::deep_copy(particles.velocity, u);
}

Particles build_particles(const Scene& scene) {
  const std::vector<Point> points = fill(scene);
  const auto expected = scene.mps.expected_particles;
  require_at(scene.mps.expected_place, expected == 0 || expected == static_cast<std::int64_t>(points.size()),
             "the region holds ", points.size(), " particles, not the expected ", expected,
             "; mend the region, mps.spacing or mps.expected_particles");
  Particles particles = make_particles(scene.dimension, static_cast<int>(points.size()));
  const auto x = Kokkos::create_mirror(particles.position);
  for (int i = 0; i < particles.count; ++i)
    for (int d = 0; d < scene.dimension; ++d) x(i, d) = points[i][d];
  Kokkos::deep_copy(particles.position, x);
  set_velocity(scene, particles);
  return particles;
}

Kernel build_kernel(const Scene& scene, double radius) {
  const double l0 = scene.mps.spacing;
  const double shift = scene.mps.kernel == "standard" ? 0 : scene.mps.kernel_shift;
  Kernel kernel;
  kernel.weight = {static_cast<real>(radius * l0), static_cast<real>(shift)};
  kernel.reference = lattice_reference(kernel.weight, scene.dimension, l0);
  return kernel;
}

// As a lattice is shaken; nobody goes through a wall or the rim.
void shake(const Scene& scene, Fluid& fluid) {
  const double most = scene.fluid.jitter * scene.mps.spacing;
  if (most == 0) return;
  const VectorField way = fluid.particles.velocity;
  const auto id = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fluid.particles.id);
  const auto ways = Kokkos::create_mirror(way);
  for (int i = 0; i < fluid.particles.count; ++i)
    for (int d = 0; d < scene.dimension; ++d)
      ways(i, d) = static_cast<real>(most * random_of(3 * static_cast<std::uint64_t>(id(i)) + d));
  Kokkos::deep_copy(way, ways);
  go_in_sight(fluid, way);
}

// No lattice fits: particles move until they fill the room evenly. Velocities are by place, so they are given anew.
Packing relax(const Scene& scene, const WallFaces& walls, Fluid& fluid) {
  PackingOptions options;
  for (int d = 0; d < scene.dimension; ++d)
    options.longest = std::max(options.longest, (scene.fluid.max[d] - scene.fluid.min[d]) / scene.mps.spacing);
  make_mirror_walls(fluid.walls, with_rim(scene, walls), fluid.grid.shape(), fluid.spacing);
  const Packing done = spread_evenly(fluid, options);
  shake(scene, fluid);
  fluid.walls = {};
  set_velocity(scene, fluid.particles);
  return done;
}

// Where a wall closes the scene nothing is to be seen beyond it; elsewhere water may fly as far as the scene is long.
GridShape build_grid(const Scene& scene, const WallFaces& walls) {
  const MpsCase& mps = scene.mps;
  const double radius = mps.spacing * std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
  if (scene.has_domain) return make_grid(scene.dimension, scene.domain_min, scene.domain_max, radius, scene.repeats);
  const auto [low, high] = scene_extent(scene, walls);
  double flight = 0;
  for (int d = 0; d < scene.dimension; ++d) flight = std::max(flight, high[d] - low[d]);
  const double brim = 2 * radius;
  const bool sealed = fills_closed_shape(scene);  // water inside a closed shape
  Point from{}, to{};
  for (int d = 0; d < scene.dimension; ++d) {
    from[d] = low[d] - (sealed || closed_at(scene, d, 0, low[d]) ? brim : flight);
    to[d] = high[d] + (sealed || closed_at(scene, d, 1, high[d]) ? brim : flight);
  }
  return make_grid(scene.dimension, from, to, radius);
}

bool is_on(const WallFace& face, const Point& x, const Scene& scene) {
  return distance_to_face(corners_of(face), scene.dimension, x) <= 1e-3 * scene.mps.spacing;
}

Point way_in(const Scene& scene, const WallFaces& walls, const WallFace& face, const ProbeCase& probe) {
  if (probe.facing != Point{0, 0, 0}) return probe.facing;
  const std::string& name = walls.bodies[face.body].name;
  for (const BoxCase& box : scene.boxes) {
    if (box.name != name) continue;
    Point in{};
    for (int d = 0; d < scene.dimension; ++d) in[d] = (box.min[d] + box.max[d]) / 2 - probe.point[d];
    return in;
  }
  refuse(probe.place, "the point of probe \"", probe.name, "\" is on the wall \"", name,
         "\", which may be wet on both sides; say which with facing, e.g. facing = ",
         scene.dimension == 2 ? "[-1, 0]" : "[-1, 0, 0]");
}

}  // namespace

Point pressure_point(const Scene& scene, const WallFaces& walls, const ProbeCase& probe) {
  const double l0 = scene.mps.spacing;
  Point at = probe.point;
  std::vector<Point> offs;
  for (const WallFace& face : walls.faces) {
    if (!is_on(face, probe.point, scene)) continue;
    const Point in = way_in(scene, walls, face, probe), normal = face_normal(corners_of(face), walls.dim);
    const double along = in[0] * normal[0] + in[1] * normal[1] + in[2] * normal[2];
    Point off;
    for (int d = 0; d < 3; ++d) off[d] = probe.point[d] + (along < 0 ? -1 : 1) * 0.01 * l0 * normal[d];
    if (std::find(offs.begin(), offs.end(), off) != offs.end()) continue;  // two triangles of one wall
    offs.push_back(off);
    for (int d = 0; d < 3; ++d) at[d] += off[d] - probe.point[d];
  }
  return at;
}

std::unique_ptr<Motion> motion_of(const Scene& scene, const WallFaces& walls, const ProbeCase& probe) {
  for (const WallFace& face : walls.faces) {
    if (walls.bodies[face.body].bends) continue;
    const auto& motion = geometry_named(scene, walls.bodies[face.body].name).motion;
    if (motion && is_on(face, probe.point, scene)) return std::make_unique<Motion>(*motion);
  }
  return nullptr;
}

Fluid build_fluid(const Scene& scene, const WallFaces& walls, Packing* packing) {
  Fluid fluid;
  fluid.spacing = scene.mps.spacing;
  fluid.rho = static_cast<real>(scene.fluid.density);
  fluid.keep_weights = scene.mps.pressure.weights == "kept";
  for (int d = 0; d < 3; ++d) fluid.gravity[d] = static_cast<real>(scene.gravity[d]);
  fluid.density = build_kernel(scene, scene.mps.radius_density);
  fluid.gradient = build_kernel(scene, scene.mps.radius_gradient);
  fluid.laplacian = build_kernel(scene, scene.mps.radius_laplacian);
  fluid.grid = CellGrid(build_grid(scene, walls));
  fluid.particles = build_particles(scene);
  if (scene.fluid.packing == "relaxed") {
    const Packing done = relax(scene, walls, fluid);
    if (packing) *packing = done;
  }
  fluid.faces = walls;
  make_mirror_walls(fluid.walls, walls, fluid.grid.shape(), fluid.spacing);
  settle_rows(fluid);
  mark_surface(fluid, static_cast<real>(scene.mps.free_surface_ratio));
  return fluid;
}

Effects build_effects(const Scene& scene, Fluid& fluid) {
  Effects effects;
  for (const ViscosityCase& c : scene.viscosity)
    effects.add(make_viscosity({static_cast<real>(c.kinematic), scene.mps.scheme != "classic"}));
  for (const CollisionCase& c : scene.collision)
    effects.add(make_collision({static_cast<real>(c.distance), static_cast<real>(c.restitution), c.sweeps}));
  if (auto motion = build_motion(scene)) {
    if (scene.mps.scheme != "classic") effects.add(make_wall_speeds(motion));
    effects.add(make_moving_walls(std::move(motion)));
  }
  for (const BodyForceCase& c : scene.body_force) {
    const auto force = std::make_shared<std::array<Formula, 3>>(
        compile(c.acceleration.text, c.acceleration.place, Variables::place_time_velocity));
    effects.add(make_body_force([force](const Point& x, const Point& u, double t) {
      Point f;
      for (int d = 0; d < 3; ++d) f[d] = (*force)[d](x[0], x[1], x[2], t, u);
      return f;
    }));
  }
  effects.prepare(fluid);
  return effects;
}

namespace {

SolverOptions solver_options(const MpsCase& mps) {
  SolverOptions options;
  options.cg = {static_cast<real>(mps.pressure.tolerance), static_cast<real>(mps.pressure.absolute_tolerance),
                mps.pressure.max_iterations};
  const std::string& way = mps.pressure.preconditioner;
  options.preconditioning = way == "multigrid" ? Preconditioning::multigrid
                            : way == "jacobi"  ? Preconditioning::jacobi
                                               : Preconditioning::none;
  return options;
}

// The speed that gravity gives, or that the fluid has at the start, whichever is higher.
double reference_speed(const Scene& scene, const Fluid& fluid) {
  double g2 = 0;
  for (const double g : scene.gravity) g2 += g * g;
  const double g = std::sqrt(g2);
  const auto x = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), fluid.particles.position);
  double low = 0, high = 0;
  for (int i = 0; i < fluid.particles.count && g > 0; ++i) {
    double depth = 0;
    for (int d = 0; d < scene.dimension; ++d) depth += scene.gravity[d] / g * x(i, d);
    low = i == 0 ? depth : std::min(low, depth);
    high = i == 0 ? depth : std::max(high, depth);
  }
  return std::max(std::sqrt(g * (high - low + fluid.spacing)), static_cast<double>(max_speed(fluid)));
}

std::unique_ptr<Scheme> build_default(const Scene& scene, const Fluid& fluid) {
  const DefaultSchemeCase& parts = scene.mps.parts;
  DefaultOptions options;
  options.fits = scene.mps.scheme == "high";
  options.solver = solver_options(scene.mps);
  options.reference_speed =
      static_cast<real>(parts.reference_speed > 0 ? parts.reference_speed : reference_speed(scene, fluid));
  options.drift = static_cast<real>(parts.drift);
  options.shifting = static_cast<real>(parts.shifting);
  options.smoothing.inside = static_cast<real>(parts.smoothing);
  options.smoothing.at_surface = static_cast<real>(parts.surface_smoothing);
  options.separation = static_cast<real>(parts.separation);
  options.diagonal_factor = static_cast<real>(parts.diagonal_factor);
  return make_default(options);
}

}  // namespace

std::unique_ptr<Scheme> build_scheme(const Scene& scene, const Fluid& fluid) {
  const MpsCase& mps = scene.mps;
  if (mps.scheme != "classic") return build_default(scene, fluid);
  ClassicOptions options;
  options.solver = solver_options(mps);
  options.pressure.diagonal_factor = static_cast<real>(mps.multiplication_coefficient);
  options.pressure.source_factor = static_cast<real>(mps.relaxation_factor);
  options.pressure.compressibility = static_cast<real>(mps.compressibility);
  options.pressure.source = mps.pressure.source == "density" ? PressureSource::density : PressureSource::divergence;
  options.surface_ratio = static_cast<real>(mps.free_surface_ratio);
  return make_classic(options);
}

}  // namespace greenwater
