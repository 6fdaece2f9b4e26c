// [geometry.NAME] and [[fluid]]: the shapes of a case.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "app/scene_parts.hpp"
#include "app/scene_shape.hpp"

namespace greenwater {
namespace {

void read_common(const std::string& name, Section& section, int dimension, GeometryCase& geometry) {
  geometry.name = name;
  geometry.place = section.place();
  geometry.motion = read_motion(section, dimension);
}

BoxCase read_box(Section& section, int dimension) {
  BoxCase box;
  const Point shown = dimension == 2 ? Point{0.8, 0.6, 0} : Point{0.8, 0.3, 0.6};
  const Corners corners = read_corners(section, dimension, {{0, 0, 0}, shown});
  box.min = corners.min;
  box.max = corners.max;
  const Words sides = box_sides(dimension);
  box.open = section.choices("open", sides, Words{});
  require_at(section.place("open"), std::set(box.open.begin(), box.open.end()).size() == box.open.size(),
             "open names a side twice");
  require_at(section.place("open"), box.open.size() < sides.size(),
             "all sides of the box are open: leave the table out");
  return box;
}

std::vector<Point> read_corner_points(Section& section) {
  const bool from_file = section.offers("points_file");
  require_at(section.place("points_file"), !from_file || !section.has("points"),
             "both points and points_file say where the polyline goes: keep one of them");
  if (!from_file) return section.points("points", "m", 2, example<std::vector<Point>>({{0, 0, 0}, {1, 0, 0}}));
  section.offers("points");
  const auto path = section.file("points_file", "points.csv");
  return read_point_file(path, section.place("points_file"));
}

PolylineCase read_polyline(Section& section) {
  PolylineCase line;
  line.points = read_corner_points(section);
  line.closed = section.flag("closed", false);
  const Place place = section.place(section.has("points") ? "points" : "points_file");
  require_at(place, line.points.size() >= 2, "a polyline needs at least 2 points, found ", line.points.size());
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    require_at(place, line.points[i] != line.points[i - 1], "points ", i, " and ", i + 1,
               " of the polyline are the same: ", toml_point(line.points[i], 2), "; delete one of them");
  }
  if (line.closed) {
    require_at(place, line.points.size() >= 3, "a closed polyline needs at least 3 points");
    require_at(place, line.points.front() != line.points.back(),
               "closed = true joins the last point to the first: do not repeat the first point at the end");
  }
  return line;
}

template <class Geometry>
void keep(Geometry geometry, const GeometryCase& common, std::vector<Geometry>& all) {
  static_cast<GeometryCase&>(geometry) = common;
  all.push_back(std::move(geometry));
}

void require_dimension(const Section& section, const std::string& type, int dimension) {
  const Place place = section.place("type");
  require_at(place, type != "polyline" || dimension == 2,
             "a polyline is for dimension = 2; in 3-D take a box, a plate, or the surface from an STL file: type = "
             "\"stl\"");
  require_at(place, type != "stl" || dimension == 3,
             "an STL file is for dimension = 3; in 2-D take type = \"polyline\" with points or a points_file");
}

}  // namespace

PlateCase read_plate(Section& section, int dimension, bool with_width) {
  constexpr double flat = std::numbers::pi / 2;
  PlateCase plate;
  plate.base = section.vector("base", "m", dimension, example(Point{0.6, 0, 0}));
  plate.base_side = section.choice("base_side", {"upstream", "centre", "downstream"}, std::string("centre"));
  plate.height = section.number("height", "m", positive, example(0.1));
  plate.thickness = section.number("thickness", "m", at_least(0), 0.0);
  plate.thickness_place = section.place("thickness");
  if (with_width) plate.width = section.number("width", "m", positive, example(0.2));
  plate.angle = section.number("angle", "rad", between(-flat, flat), 0.0);
  return plate;
}

void read_geometry(Section root, Scene& scene) {
  for (auto& [name, section] : root.named("geometry")) {
    require_safe_name(name, section.place(), "the geometry");
    require_at(section.place(), name != "all", "\"all\" stands for every geometry in no_slip: take another name");
    const std::string type = section.choice("type", {"box", "polyline", "plate", "stl"}, example<std::string>("box"));
    require_dimension(section, type, scene.dimension);
    GeometryCase common;
    read_common(name, section, scene.dimension, common);
    if (type == "box") keep(read_box(section, scene.dimension), common, scene.boxes);
    if (type == "polyline") keep(read_polyline(section), common, scene.polylines);
    if (type == "plate") keep(read_plate(section, scene.dimension, scene.dimension == 3), common, scene.plates);
    if (type == "stl") keep(read_mesh(name, section), common, scene.meshes);
  }
}

}  // namespace greenwater
