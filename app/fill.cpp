#include "app/fill.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "app/plan.hpp"
#include "app/plate_frame.hpp"
#include "app/scene_shape.hpp"
#include "core/interior.hpp"
#include "fem/mesh_place.hpp"

namespace greenwater {
namespace {

// Cell centres of a lattice in the fluid's bounds, from `from` on.
std::vector<Point> lattice(const FluidCase& fluid, const Point& from, double spacing, int dimension) {
  const auto cells = lattice_cells(fluid, spacing, dimension);
  const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]), nz = static_cast<int>(cells[2]);
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(nx) * ny * nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        points.push_back({from[0] + (i + 0.5) * spacing, from[1] + (j + 0.5) * spacing,
                          dimension == 3 ? from[2] + (k + 0.5) * spacing : 0.0});
  return points;
}

std::vector<Point> lattice_in_the_middle(const FluidCase& fluid, double spacing, int dimension) {
  const auto cells = lattice_cells(fluid, spacing, dimension);
  Point from = fluid.min;
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d)
    from[d] += std::max(0.0, (fluid.max[d] - fluid.min[d] - cells[d] * spacing) / 2);
  return lattice(fluid, from, spacing, dimension);
}

// Cells about the centre, which is a corner of four of them, in 3-D of eight: those whose own centre is in the ball. Told
// in cells, where centres are exact, so that nothing but the centre's own digits spoils the symmetry.
std::vector<Point> lattice_in_ball(const BallCase& ball, double spacing, int dimension) {
  const double radius = ball.radius / spacing;
  const int n = static_cast<int>(std::ceil(radius - 0.5)), nz = dimension == 3 ? n : 0;
  const double middle_z = dimension == 3 ? 0.5 : 0;
  std::vector<Point> points;
  for (int k = -nz; k < std::max(nz, 1); ++k)
    for (int j = -n; j < n; ++j)
      for (int i = -n; i < n; ++i) {
        const Point cell{i + 0.5, j + 0.5, k + middle_z};
        if (cell[0] * cell[0] + cell[1] * cell[1] + cell[2] * cell[2] >= radius * radius) continue;
        points.push_back(ball.centre);
        for (std::size_t d = 0; d < 3; ++d) points.back()[d] += cell[d] * spacing;
      }
  return points;
}

Interior interior_of(const Scene& scene) {
  for (const PolylineCase& line : scene.polylines)
    if (line.name == scene.fluid.inside) return Interior(line.points);
  const auto found = std::find_if(scene.meshes.begin(), scene.meshes.end(),
                                  [&](const MeshCase& mesh) { return mesh.name == scene.fluid.inside; });
  return Interior(found->mesh);
}

// As many points inside as have room by volume: of a lattice just dense enough, without those closest to walls.
std::vector<Point> fill_inside(const Scene& scene) {
  const Interior interior = interior_of(scene);
  const double l0 = scene.mps.spacing;
  const auto wanted =
      static_cast<std::size_t>(std::llround(interior.measure_below(scene.fluid.level) / std::pow(l0, scene.dimension)));
  std::vector<Point> points;
  for (double spacing = l0; points.size() < wanted; spacing *= 0.99) {
    points = lattice_in_the_middle(scene.fluid, spacing, scene.dimension);
    points.erase(std::remove_if(points.begin(), points.end(), [&](const Point& x) { return !interior.holds(x); }),
                 points.end());
  }
  std::vector<double> room;
  for (const Point& x : points) room.push_back(interior.distance(x, l0));
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return room[a] > room[b]; });
  order.resize(wanted);
  std::sort(order.begin(), order.end());
  std::vector<Point> kept;
  for (const std::size_t k : order) kept.push_back(points[k]);
  return kept;
}

bool in_a_solid(const Scene& scene, const Point& x) {
  return std::any_of(scene.plates.begin(), scene.plates.end(),
                     [&](const PlateCase& plate) { return inside_plate(plate, x, scene.dimension); }) ||
         std::any_of(scene.structures.begin(), scene.structures.end(),
                     [&](const StructureCase& structure) { return is_inside(structure.mesh, x); });
}

// From -1 to 1, the same for a number on every machine (Steele, Lea and Flood's splitmix64).
double random_of(std::uint64_t number) {
  number = (number + 1) * 0x9e3779b97f4a7c15U;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9U;
  number = (number ^ (number >> 27)) * 0x94d049bb133111ebU;
  number ^= number >> 31;
  return static_cast<double>(number >> 11) * 0x1p-52 - 1;  // 53 bits: exact
}

// Each by its own number; who would end in a solid, or beside a ball, stays.
void shake(const Scene& scene, std::vector<Point>& points) {
  const double most = scene.fluid.jitter * scene.mps.spacing;
  if (most == 0) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point x = points[i];
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.dimension); ++d) x[d] += most * random_of(3 * i + d);
    const bool leaves = scene.fluid.ball && !inside_ball(*scene.fluid.ball, x);
    if (!leaves && !in_a_solid(scene, x)) points[i] = x;
  }
}

}  // namespace

bool needs_spreading(const Scene& scene) {
  return !scene.fluid.inside.empty() && std::none_of(scene.boxes.begin(), scene.boxes.end(),
                                                     [&](const auto& b) { return b.name == scene.fluid.inside; });
}

std::vector<Point> fill(const Scene& scene) {
  const FluidCase& fluid = scene.fluid;
  std::vector<Point> points = needs_spreading(scene) ? fill_inside(scene)
                              : fluid.ball           ? lattice_in_ball(*fluid.ball, scene.mps.spacing, scene.dimension)
                                                     : lattice(fluid, fluid.min, scene.mps.spacing, scene.dimension);
  points.erase(std::remove_if(points.begin(), points.end(), [&](const Point& x) { return in_a_solid(scene, x); }),
               points.end());
  require_at(scene.fluid.place, !points.empty(),
             "the fluid's region holds no particle: enlarge it or take a smaller mps.spacing");
  shake(scene, points);
  return points;
}

}  // namespace greenwater
