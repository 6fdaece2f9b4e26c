#include "app/build.hpp"

#include <algorithm>
#include <cmath>

#include "app/formula.hpp"
#include "app/plan.hpp"
#include "core/check.hpp"
#include "kernels/density.hpp"

namespace greenwater {
namespace {

void add_face(WallFaces& walls, int body, const Point& from, const Point& to) {
  WallFace face;
  face.end = {from, to};
  face.body = body;
  walls.faces.push_back(face);
}

int add_body(WallFaces& walls, const std::string& name) {
  walls.bodies.push_back(name);
  return static_cast<int>(walls.bodies.size()) - 1;
}

bool is_open(const BoxCase& box, const std::string& side) {
  return std::find(box.open.begin(), box.open.end(), side) != box.open.end();
}

void add_box(WallFaces& walls, const BoxCase& box) {
  const int body = add_body(walls, box.name);
  const Point a{box.min[0], box.min[1], 0}, b{box.max[0], box.min[1], 0};
  const Point c{box.max[0], box.max[1], 0}, d{box.min[0], box.max[1], 0};
  if (!is_open(box, "bottom")) add_face(walls, body, a, b);
  if (!is_open(box, "right")) add_face(walls, body, b, c);
  if (!is_open(box, "top")) add_face(walls, body, c, d);
  if (!is_open(box, "left")) add_face(walls, body, d, a);
}

void add_polyline(WallFaces& walls, const PolylineCase& line) {
  const int body = add_body(walls, line.name);
  for (std::size_t k = 0; k + 1 < line.points.size(); ++k) add_face(walls, body, line.points[k], line.points[k + 1]);
  if (line.closed) add_face(walls, body, line.points.back(), line.points.front());
}

// The plate's axes: along its height and, to the right of it, through its thickness; and its lower left corner.
struct PlateFrame {
  Point up, right, corner;
};

PlateFrame frame_of(const PlateCase& plate) {
  const double s = std::sin(plate.angle), c = std::cos(plate.angle);
  PlateFrame frame{{s, c, 0}, {c, -s, 0}, plate.base};
  const double back = plate.base_side == "upstream" ? 0
                      : plate.base_side == "centre" ? plate.thickness / 2
                                                    : plate.thickness;
  for (int d = 0; d < 2; ++d) frame.corner[d] -= back * frame.right[d];
  return frame;
}

Point moved(const Point& from, double s, const Point& along) {
  return {from[0] + s * along[0], from[1] + s * along[1], from[2] + s * along[2]};
}

// Its foot is no face: it stands on something.
void add_plate(WallFaces& walls, const PlateCase& plate) {
  const int body = add_body(walls, plate.name);
  const PlateFrame frame = frame_of(plate);
  const Point top = moved(frame.corner, plate.height, frame.up);
  add_face(walls, body, frame.corner, top);
  if (plate.thickness <= 0) return;
  add_face(walls, body, top, moved(top, plate.thickness, frame.right));
  add_face(walls, body, moved(top, plate.thickness, frame.right), moved(frame.corner, plate.thickness, frame.right));
}

bool inside_plate(const PlateCase& plate, const Point& x) {
  const PlateFrame frame = frame_of(plate);
  double up = 0, right = 0;
  for (int d = 0; d < 2; ++d) {
    up += (x[d] - frame.corner[d]) * frame.up[d];
    right += (x[d] - frame.corner[d]) * frame.right[d];
  }
  return up >= 0 && up <= plate.height && right >= 0 && right <= plate.thickness;
}

std::vector<Point> lattice(const Scene& scene) {
  const double l0 = scene.mps.spacing;
  const FluidCase& fluid = scene.fluid;
  const auto cells = lattice_cells(fluid, l0, scene.dimension);
  const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]);
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(nx) * ny);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const Point x{fluid.min[0] + (i + 0.5) * l0, fluid.min[1] + (j + 0.5) * l0, 0};
      if (std::none_of(scene.plates.begin(), scene.plates.end(),
                       [&](const auto& plate) { return inside_plate(plate, x); }))
        points.push_back(x);
    }
  return points;
}

Particles build_particles(const Scene& scene) {
  const std::vector<Point> points = lattice(scene);
  require_at(scene.fluid.place, !points.empty(),
             "the fluid's region holds no particle: enlarge it or take a smaller mps.spacing");
  const auto expected = scene.mps.expected_particles;
  require_at(scene.mps.expected_place, expected == 0 || expected == static_cast<std::int64_t>(points.size()),
             "the region holds ", points.size(), " particles, not the expected ", expected,
             "; mend the region, mps.spacing or mps.expected_particles");
  Particles particles = make_particles(scene.dimension, static_cast<int>(points.size()));
  const auto x = Kokkos::create_mirror(particles.position);
  const auto u = Kokkos::create_mirror(particles.velocity);
  const auto velocity = compile(scene.fluid.velocity.text, scene.fluid.velocity.place);
  for (int i = 0; i < particles.count; ++i) {
    const Point& at = points[i];
    for (int d = 0; d < scene.dimension; ++d) {
      x(i, d) = at[d];
      u(i, d) = static_cast<real>(velocity[d](at[0], at[1], at[2], 0));
    }
  }
  Kokkos::deep_copy(particles.position, x);
  Kokkos::deep_copy(particles.velocity, u);
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

bool closed_at(const Scene& scene, const std::string& side, int axis, bool high, double at) {
  return std::any_of(scene.boxes.begin(), scene.boxes.end(), [&](const BoxCase& box) {
    return !is_open(box, side) && std::fabs((high ? box.max : box.min)[axis] - at) < 1e-6 * scene.mps.spacing;
  });
}

// Where a wall closes the scene nothing is to be seen beyond it; elsewhere water may fly as far as the scene is long.
GridShape build_grid(const Scene& scene, const WallFaces& walls) {
  const MpsCase& mps = scene.mps;
  const double radius = mps.spacing * std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
  if (scene.has_domain) return make_grid(scene.dimension, scene.domain_min, scene.domain_max, radius);
  const auto [low, high] = scene_extent(scene, walls);
  const double flight = std::max(high[0] - low[0], high[1] - low[1]), brim = 2 * radius;
  const Point from{low[0] - (closed_at(scene, "left", 0, false, low[0]) ? brim : flight),
                   low[1] - (closed_at(scene, "bottom", 1, false, low[1]) ? brim : flight), 0};
  const Point to{high[0] + (closed_at(scene, "right", 0, true, high[0]) ? brim : flight),
                 high[1] + (closed_at(scene, "top", 1, true, high[1]) ? brim : flight), 0};
  return make_grid(scene.dimension, from, to, radius);
}

// How far a point is off a face, and where the face's normal points; the face is taken as it is long.
struct Off {
  double distance;
  Point normal;
};

Off off_face(const WallFace& face, const Point& x) {
  const double tx = face.end[1][0] - face.end[0][0], ty = face.end[1][1] - face.end[0][1];
  const double length = std::hypot(tx, ty);
  const double dx = x[0] - face.end[0][0], dy = x[1] - face.end[0][1];
  const double s = std::clamp((dx * tx + dy * ty) / (length * length), 0.0, 1.0);
  return {std::hypot(dx - s * tx, dy - s * ty), {-ty / length, tx / length, 0}};
}

Point way_in(const Scene& scene, const WallFaces& walls, const WallFace& face, const ProbeCase& probe) {
  if (probe.facing != Point{0, 0, 0}) return probe.facing;
  for (const BoxCase& box : scene.boxes)
    if (box.name == walls.bodies[face.body])
      return {(box.min[0] + box.max[0]) / 2 - probe.point[0], (box.min[1] + box.max[1]) / 2 - probe.point[1], 0};
  refuse(probe.place, "the point of probe \"", probe.name, "\" is on the wall \"", walls.bodies[face.body],
         "\", which may be wet on both sides; say which with facing, e.g. facing = [-1, 0]");
}

}  // namespace

Point pressure_point(const Scene& scene, const WallFaces& walls, const ProbeCase& probe) {
  const double l0 = scene.mps.spacing;
  Point at = probe.point;
  for (const WallFace& face : walls.faces) {
    const Off off = off_face(face, probe.point);
    if (off.distance > 1e-3 * l0) continue;
    const Point in = way_in(scene, walls, face, probe);
    const double along = in[0] * off.normal[0] + in[1] * off.normal[1];
    for (int d = 0; d < 2; ++d) at[d] += (along < 0 ? -1 : 1) * 0.01 * l0 * off.normal[d];
  }
  return at;
}

Extent scene_extent(const Scene& scene, const WallFaces& walls) {
  Extent extent{scene.fluid.min, scene.fluid.max};
  for (const WallFace& face : walls.faces)
    for (const auto& end : face.end)
      for (int d = 0; d < scene.dimension; ++d) {
        extent.low[d] = std::min(extent.low[d], end[d]);
        extent.high[d] = std::max(extent.high[d], end[d]);
      }
  return extent;
}

WallFaces build_walls(const Scene& scene) {
  WallFaces walls;
  for (const BoxCase& box : scene.boxes) add_box(walls, box);
  for (const PolylineCase& line : scene.polylines) add_polyline(walls, line);
  for (const PlateCase& plate : scene.plates) add_plate(walls, plate);
  merge_collinear(walls, 1e-6 * scene.mps.spacing);
  return walls;
}

Fluid build_fluid(const Scene& scene, const WallFaces& walls) {
  Fluid fluid;
  fluid.spacing = scene.mps.spacing;
  fluid.rho = static_cast<real>(scene.fluid.density);
  fluid.keep_weights = scene.mps.pressure.weights == "kept";
  for (int d = 0; d < 3; ++d) fluid.gravity[d] = static_cast<real>(scene.gravity[d]);
  fluid.density = build_kernel(scene, scene.mps.radius_density);
  fluid.gradient = build_kernel(scene, scene.mps.radius_gradient);
  fluid.laplacian = build_kernel(scene, scene.mps.radius_laplacian);
  fluid.grid = CellGrid(build_grid(scene, walls));
  fluid.walls = make_mirror_walls(walls, fluid.grid.shape(), fluid.spacing);
  fluid.particles = build_particles(scene);
  settle_rows(fluid);
  number_density(fluid);
  mark_surface(fluid, static_cast<real>(scene.mps.free_surface_ratio));
  return fluid;
}

Effects build_effects(const Scene& scene) {
  Effects effects;
  for (const ViscosityCase& c : scene.viscosity) effects.add(make_viscosity(static_cast<real>(c.kinematic)));
  for (const CollisionCase& c : scene.collision)
    effects.add(make_collision({static_cast<real>(c.distance), static_cast<real>(c.restitution), c.sweeps}));
  for (const BodyForceCase& c : scene.body_force) {
    const auto force = std::make_shared<std::array<Formula, 3>>(compile(c.acceleration.text, c.acceleration.place));
    effects.add(make_body_force([force](double x, double y, double z, double t, double* out) {
      for (int d = 0; d < 3; ++d) out[d] = (*force)[d](x, y, z, t);
    }));
  }
  return effects;
}

std::unique_ptr<Scheme> build_scheme(const Scene& scene) {
  const MpsCase& mps = scene.mps;
  ClassicOptions options;
  options.pressure.diagonal_factor = static_cast<real>(mps.multiplication_coefficient);
  options.pressure.source_factor = static_cast<real>(mps.relaxation_factor);
  options.pressure.compressibility = static_cast<real>(mps.compressibility);
  options.pressure.source = mps.pressure.source == "density" ? PressureSource::density : PressureSource::divergence;
  options.cg = {static_cast<real>(mps.pressure.tolerance), static_cast<real>(mps.pressure.absolute_tolerance),
                mps.pressure.max_iterations};
  options.jacobi = mps.pressure.preconditioner == "jacobi";
  options.surface_ratio = static_cast<real>(mps.free_surface_ratio);
  return make_classic(options);
}

}  // namespace greenwater
