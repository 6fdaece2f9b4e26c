#include "app/scene_shape.hpp"

#include <algorithm>
#include <cmath>

#include "app/plate_frame.hpp"

namespace greenwater {
namespace {

template <class Points>
Corners bounds_of_points(const Points& points) {
  Corners bounds{points.front(), points.front()};
  for (const auto& x : points)
    for (std::size_t d = 0; d < 3; ++d) {
      bounds.min[d] = std::min(bounds.min[d], x[d]);
      bounds.max[d] = std::max(bounds.max[d], x[d]);
    }
  return bounds;
}

Corners bounds_of_plate(const PlateCase& plate, int dimension) {
  std::vector<Point> corners;
  for (const auto& [x, up] : plate_section(plate, dimension)) {
    if (dimension == 2) {
      corners.push_back({x, up, 0});
    } else {
      corners.push_back({x, plate.base[1] - plate.width / 2, up});
      corners.push_back({x, plate.base[1] + plate.width / 2, up});
    }
  }
  return bounds_of_points(corners);
}

}  // namespace

std::string shown_point(const Point& x, int dimension) {
  return dimension == 2 ? text_of('[', x[0], ", ", x[1], ']') : text_of('[', x[0], ", ", x[1], ", ", x[2], ']');
}

std::vector<std::array<double, 2>> plate_section(const PlateCase& plate, int dimension) {
  const PlateFrame frame = frame_of(plate, dimension);
  const std::size_t last = static_cast<std::size_t>(dimension) - 1;
  const auto at = [&](double up, double right) {
    return std::array{frame.corner[0] + up * frame.up[0] + right * frame.right[0],
                      frame.corner[last] + up * frame.up[last] + right * frame.right[last]};
  };
  if (plate.thickness <= 0) return {at(0, 0), at(plate.height, 0)};
  return {at(0, 0), at(plate.height, 0), at(plate.height, plate.thickness), at(0, plate.thickness)};
}

std::vector<Shape> shapes_of(const Scene& scene) {
  std::vector<Shape> shapes;
  for (const BoxCase& box : scene.boxes) shapes.push_back({&box, "box", {box.min, box.max}});
  for (const PolylineCase& line : scene.polylines) shapes.push_back({&line, "polyline", bounds_of_points(line.points)});
  for (const PlateCase& plate : scene.plates)
    shapes.push_back({&plate, "plate", bounds_of_plate(plate, scene.dimension)});
  for (const MeshCase& mesh : scene.meshes) shapes.push_back({&mesh, "mesh", bounds_of_points(mesh.mesh.vertices)});
  return shapes;
}

bool inside_polyline(const PolylineCase& line, const Point& x) {
  bool inside = false;  // each edge that a ray to +x meets changes it
  for (std::size_t k = 0, last = line.points.size() - 1; k < line.points.size(); last = k++) {
    const Point &a = line.points[last], &b = line.points[k];
    if ((a[1] > x[1]) == (b[1] > x[1])) continue;
    if (x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
  }
  return inside;
}

bool inside_ball(const BallCase& ball, const Point& x) {
  return std::hypot(x[0] - ball.centre[0], x[1] - ball.centre[1], x[2] - ball.centre[2]) < ball.radius;
}

bool fills_closed_shape(const Scene& scene) {
  return !scene.fluid.inside.empty() && std::none_of(scene.boxes.begin(), scene.boxes.end(), [&](const BoxCase& box) {
    return box.name == scene.fluid.inside;
  });
}

double reach_of(const Shape& shape) {
  if (!shape.geometry->motion) return 0;
  const Point &about = shape.geometry->motion->about, &k = shape.geometry->motion->axis;
  const double length = std::hypot(k[0], k[1], k[2]);
  double reach = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Point r{};
    for (std::size_t d = 0; d < 3; ++d)
      r[d] = ((corner >> d & 1U) != 0 ? shape.bounds.max : shape.bounds.min)[d] - about[d];
    const double across =
        std::hypot(k[1] * r[2] - k[2] * r[1], k[2] * r[0] - k[0] * r[2], k[0] * r[1] - k[1] * r[0]) / length;
    reach = std::max(reach, across);
  }
  return reach;
}

const GeometryCase& geometry_named(const Scene& scene, const std::string& name) {
  const auto shapes = shapes_of(scene);
  const auto found =
      std::find_if(shapes.begin(), shapes.end(), [&](const Shape& s) { return s.geometry->name == name; });
  expect(found != shapes.end());
  return *found->geometry;
}

}  // namespace greenwater
