#include "app/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "app/plate_frame.hpp"
#include "app/random.hpp"
#include "app/scene_shape.hpp"
#include "core/whole.hpp"
#include "fem/mesh_place.hpp"

namespace greenwater {
namespace {

constexpr int most_cells = 1 << 29;  // along an axis

/// Of a box, from a place in its frame, along the axis where it is farthest out: positive outside. Never more than the
/// distance to the box, and inside just that to its sides.
double depth_out_of_box(const Point& x, const Point& low, const Point& high, int axes) {
  double out = -std::numeric_limits<double>::infinity();
  for (int d = 0; d < axes; ++d) out = std::max({out, low[d] - x[d], x[d] - high[d]});
  return out;
}

}  // namespace

std::optional<Interior> interior_named(const Scene& scene, const std::string& name) {
  for (const PolylineCase& line : scene.polylines)
    if (line.name == name && line.closed) return Interior(line.points);
  for (const MeshCase& mesh : scene.meshes)
    if (mesh.name == name && mesh.closed) return Interior(mesh.mesh);
  return {};
}

Room::Room(const Scene& scene)
    : dimension_(scene.dimension),
      spacing_(scene.mps.spacing),
      fluid_(scene.fluid),
      inside_(interior_named(scene, scene.fluid.inside)) {
  for (const std::string& name : fluid_.without) {
    const auto shape = std::make_shared<Interior>(*interior_named(scene, name));
    const double on_it = 1e-4 * spacing_;  // what is on it could be taken for either side
    solids_.push_back({[shape, on_it](const Point& x) { return shape->holds(x) || shape->distance(x, on_it) < on_it; },
                       [shape](const Point& x, double distance) { return shape->distance(x, distance) < distance; }});
  }
  for (const PlateCase& plate : scene.plates) add_plate(plate);
  for (const StructureCase& structure : scene.structures) add_structure(structure);
}

void Room::add_plate(const PlateCase& plate) {
  const PlateFrame frame = frame_of(plate, dimension_);
  const Point size{plate.thickness, plate.height, plate.width};
  const auto out_of_it = [frame, size, dimension = dimension_](const Point& x) {
    Point at{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double r = x[d] - frame.corner[d];
      at[0] += r * frame.right[d];
      at[1] += r * frame.up[d];
      at[2] += r * frame.over[d];
    }
    return depth_out_of_box(at, {0, 0, 0}, size, dimension);
  };
  solids_.push_back({[out_of_it](const Point& x) { return out_of_it(x) <= 0; },
                     [out_of_it](const Point& x, double distance) { return std::fabs(out_of_it(x)) < distance; },
                     plate.thickness > 0});
}

void Room::add_structure(const StructureCase& structure) {
  if (structure.plate) return add_plate(*structure.plate);
  const auto mesh = std::make_shared<SolidMesh>(structure.mesh);
  Point low = mesh->nodes.front(), high = low;
  for (const Point& node : mesh->nodes)
    for (std::size_t d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], node[d]);
      high[d] = std::max(high[d], node[d]);
    }
  solids_.push_back({[mesh](const Point& x) { return is_inside(*mesh, x); },
                     [low, high, dimension = dimension_](const Point& x, double distance) {
                       return depth_out_of_box(x, low, high, dimension) < distance;
                     }});
}

bool Room::in_solid(const Point& x) const {
  return std::any_of(solids_.begin(), solids_.end(), [&](const Solid& solid) { return solid.holds(x); });
}

bool Room::in_region(const Point& x) const {
  if (depth_out_of_box(x, fluid_.min, fluid_.max, dimension_) > 0) return false;
  return (!fluid_.ball || inside_ball(*fluid_.ball, x)) && (!inside_ || inside_->holds(x));
}

bool Room::edge_within(const Point& x, double distance) const {
  if (fluid_.ball) {
    const Point& c = fluid_.ball->centre;
    if (std::fabs(std::hypot(x[0] - c[0], x[1] - c[1], x[2] - c[2]) - fluid_.ball->radius) < distance) return true;
  }
  if (inside_ && inside_->distance(x, distance) < distance) return true;
  return std::any_of(solids_.begin(), solids_.end(),
                     [&](const Solid& solid) { return solid.edge_within(x, distance); });
}

double Room::region_measure() const {
  if (inside_) return inside_->measure_below(fluid_.level);
  if (fluid_.ball) {
    const double r = fluid_.ball->radius;
    return std::numbers::pi * (dimension_ == 2 ? r * r : 4.0 / 3 * r * r * r);
  }
  double product = 1;
  for (int d = 0; d < dimension_; ++d) product *= fluid_.max[d] - fluid_.min[d];
  return product;
}

double Room::part_of(const Cell& cell, int halvings, std::uint64_t& number) const {
  const auto& [c, half] = cell;
  double volume = 1;
  for (int d = 0; d < dimension_; ++d) volume *= 2 * half[d];
  if (!edge_within(c, std::hypot(half[0], half[1], half[2]))) return holds(c) ? volume : 0;
  if (halvings == 0) {
    Point x = c;
    for (int d = 0; d < dimension_; ++d) x[d] += half[d] * random_of(number++);
    return holds(x) ? volume : 0;
  }
  double sum = 0;
  for (int corner = 0; corner < 1 << dimension_; ++corner) {
    Cell part{c, {half[0] / 2, half[1] / 2, half[2] / 2}};
    for (int d = 0; d < dimension_; ++d) part.centre[d] += (corner >> d & 1 ? 0.5 : -0.5) * half[d];
    sum += part_of(part, halvings - 1, number);
  }
  return sum;
}

double Room::measure() const {
  if (std::none_of(solids_.begin(), solids_.end(), [](const Solid& solid) { return solid.has_volume; }))
    return region_measure();
  std::array<int, 3> cells{1, 1, 1};
  Cell cell{};
  for (int d = 0; d < dimension_; ++d) {
    const double width = fluid_.max[d] - fluid_.min[d];
    cells[d] = whole_within(std::round(width / spacing_), 1, most_cells);
    cell.half[d] = width / cells[d] / 2;
  }
  double sum = 0;
  std::uint64_t number = 0;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i) {
        const std::array at{i, j, k};
        for (int d = 0; d < dimension_; ++d) cell.centre[d] = fluid_.min[d] + (2 * at[d] + 1) * cell.half[d];
        sum += part_of(cell, dimension_ == 2 ? 6 : 4, number);
      }
  return sum;
}

}  // namespace greenwater
