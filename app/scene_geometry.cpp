// [geometry.NAME] and [[fluid]]: the shapes of a case.

#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

BoxCase read_box(const std::string& name, Section& section, int dimension) {
  BoxCase box;
  box.name = name;
  box.place = section.place();
  const Corners corners = read_corners(section, dimension, {{0, 0, 0}, {0.8, 0.6, 0}});
  box.min = corners.min;
  box.max = corners.max;
  box.open = section.choices("open", {"left", "right", "bottom", "top"}, Words{});
  require_at(section.place("open"), std::set(box.open.begin(), box.open.end()).size() == box.open.size(),
             "open names a side twice");
  require_at(section.place("open"), box.open.size() < 4, "all sides of the box are open: leave the table out");
  return box;
}

PolylineCase read_polyline(const std::string& name, Section& section, int dimension) {
  PolylineCase line;
  line.name = name;
  line.place = section.place();
  line.points = section.points("points", "m", dimension, example<std::vector<Point>>({{0, 0, 0}, {1, 0, 0}}));
  line.closed = section.flag("closed", false);
  const Place place = section.place("points");
  require_at(place, line.points.size() >= 2, "a polyline needs at least 2 points, found ", line.points.size());
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    require_at(place, line.points[i] != line.points[i - 1], "points ", i, " and ", i + 1,
               " of the polyline are the same: ", toml_point(line.points[i], dimension));
  }
  if (line.closed) {
    require_at(place, line.points.size() >= 3, "a closed polyline needs at least 3 points");
    require_at(place, line.points.front() != line.points.back(),
               "closed = true joins the last point to the first: do not repeat the first point at the end");
  }
  return line;
}

PlateCase read_plate(const std::string& name, Section& section, int dimension) {
  constexpr double flat = std::numbers::pi / 2;
  PlateCase plate;
  plate.name = name;
  plate.place = section.place();
  plate.base = section.vector("base", "m", dimension, example(Point{0.6, 0, 0}));
  plate.base_side = section.choice("base_side", {"upstream", "centre", "downstream"}, std::string("centre"));
  plate.height = section.number("height", "m", positive, example(0.1));
  plate.thickness = section.number("thickness", "m", at_least(0), 0.0);
  plate.angle = section.number("angle", "rad", between(-flat, flat), 0.0);
  return plate;
}

}  // namespace

void read_geometry(Section root, Scene& scene) {
  for (auto& [name, section] : root.named("geometry")) {
    require_safe_name(name, section.place(), "the geometry");
    const std::string type = section.choice("type", {"box", "polyline", "plate"}, example<std::string>("box"));
    if (type == "box") scene.boxes.push_back(read_box(name, section, scene.dimension));
    if (type == "polyline") scene.polylines.push_back(read_polyline(name, section, scene.dimension));
    if (type == "plate") scene.plates.push_back(read_plate(name, section, scene.dimension));
  }
}

void read_fluid(Section root, Scene& scene) {
  std::vector<Section> fluids = root.list("fluid");
  require_at(root.place(), !fluids.empty(),
             "missing table [[fluid]]; add for example:\n    [[fluid]]\n"
             "    region = { type = \"box\", min = [0.0, 0.0], max = [0.2, 0.4] }");
  if (fluids.size() > 1) refuse(fluids[1].place(), "this version runs one [[fluid]], found ", fluids.size());
  Section& section = fluids.front();
  FluidCase& fluid = scene.fluid;
  fluid.name = section.text("name", std::string("water"));
  require_safe_name(fluid.name, section.place("name"), "the fluid");
  fluid.density = section.number("density", "kg/m^3", positive, 1000.0);
  fluid.velocity = read_formulas(section, "velocity", "m/s", scene.dimension, Formulas{"0", "0", "0"});
  Section region = section.table("region");
  region.choice("type", {"box"}, std::string("box"));
  const Corners corners = read_corners(region, scene.dimension, {{0, 0, 0}, {0.2, 0.4, 0}});
  fluid.min = corners.min;
  fluid.max = corners.max;
  fluid.place = region.place();
}

}  // namespace greenwater
