// [[fluid]]: what is filled with water.

#include <algorithm>

#include "app/scene_parts.hpp"
#include "app/scene_shape.hpp"
#include "core/interior.hpp"

namespace greenwater {
namespace {

/// An outline that meets itself has no inside that one could tell from its outside.
void require_simple(const PolylineCase& line, const Place& place) {
  const auto edges = crossing_edges(line.points);
  if (!edges) return;
  const auto shown = [&](std::size_t edge) {
    const Point &from = line.points[edge], &to = line.points[(edge + 1) % line.points.size()];
    return shown_point(from, 2) + " - " + shown_point(to, 2);
  };
  refuse(place, "the polyline \"", line.name, "\" cannot be filled, nor left out: its sides ", shown((*edges)[0]),
         " m and ", shown((*edges)[1]), " m meet; draw it round once, without crossing or touching itself");
}

/// The bounds of a geometry that has an inside.
Corners bounds_of_inside(const Scene& scene, const std::string& wall, const Place& place) {
  for (const PlateCase& plate : scene.plates) {
    require_at(place, plate.name != wall, "the plate \"", wall, "\" has no inside to be filled: name a box, a closed ",
               scene.dimension == 2 ? "polyline" : "mesh");
  }
  for (const PolylineCase& line : scene.polylines) {
    require_at(place, line.name != wall || line.closed, "the polyline \"", wall,
               "\" is open and has no inside to be filled: give it closed = true, or fill a box");
  }
  for (const PolylineCase& line : scene.polylines) {
    if (line.name == wall) require_simple(line, place);
  }
  for (const MeshCase& mesh : scene.meshes) {
    require_at(place, mesh.name != wall || mesh.closed, "the mesh \"", wall,
               "\" has no inside to be filled: give it closed = true, or fill a box");
  }
  for (const Shape& shape : shapes_of(scene)) {
    if (shape.geometry->name == wall) return shape.bounds;
  }
  refuse(place, "there is no geometry \"", wall, '"');
}

void read_inside(Section& region, const Scene& scene, FluidCase& fluid) {
  const Words walls = wall_names(scene);
  require_at(region.place(), !walls.empty(),
             "there is no [geometry.NAME] to be filled; add one, or write type = \"box\" with min and max");
  fluid.inside = region.choice("wall", walls, example(walls.front()));
  const Corners bounds = bounds_of_inside(scene, fluid.inside, region.place("wall"));
  const std::size_t up = static_cast<std::size_t>(scene.dimension) - 1;
  const char* axis = scene.dimension == 2 ? "y" : "z";
  fluid.level = region.number("level", "m", any_number, example(bounds.max[up]));
  require_at(region.place("level"), fluid.level > bounds.min[up] && fluid.level <= bounds.max[up],
             "level = ", fluid.level, " m is not inside \"", fluid.inside, "\", which reaches from ", axis, " = ",
             bounds.min[up], " m to ", bounds.max[up], " m; the level is an absolute height, not a depth");
  fluid.min = bounds.min;
  fluid.max = bounds.max;
  fluid.max[up] = fluid.level;
}

void read_box_region(Section& region, const Scene& scene, FluidCase& fluid) {
  const Point shown = scene.dimension == 2 ? Point{0.2, 0.4, 0} : Point{0.2, 0.3, 0.4};
  const Corners corners = read_corners(region, scene.dimension, {{0, 0, 0}, shown});
  fluid.min = corners.min;
  fluid.max = corners.max;
}

void read_ball(Section& region, const Scene& scene, FluidCase& fluid) {
  const Point shown = scene.dimension == 2 ? Point{0.2, 0.2, 0} : Point{0.2, 0.2, 0.2};
  BallCase ball;
  ball.centre = region.vector("centre", "m", scene.dimension, example(shown));
  ball.radius = region.number("radius", "m", positive, example(0.1));
  for (std::size_t d = 0; d < static_cast<std::size_t>(scene.dimension); ++d) {
    fluid.min[d] = ball.centre[d] - ball.radius;
    fluid.max[d] = ball.centre[d] + ball.radius;
  }
  fluid.ball = ball;
}

void read_jitter(Section& section, Scene& scene) {
  constexpr double half = 0.5;  // from the middle of a cell to its side
  FluidCase& fluid = scene.fluid;
  fluid.jitter = section.number("jitter", "x spacing", at_least(0), fluid.jitter);
  require_at(section.place("jitter"), fluid.jitter < half, "jitter = ", fluid.jitter,
             " x spacing must be below 0.5, or particles leave their region");
}

/// Closed geometries that the fluid flows round; the one that it fills is none.
void read_without(Section& region, const Scene& scene, FluidCase& fluid) {
  Words closed;
  for (const PolylineCase& line : scene.polylines)
    if (line.closed && line.name != fluid.inside) closed.push_back(line.name);
  for (const MeshCase& mesh : scene.meshes)
    if (mesh.closed && mesh.name != fluid.inside) closed.push_back(mesh.name);
  if (closed.empty()) return;
  fluid.without = region.choices("without", closed, Words{});
  for (const PolylineCase& line : scene.polylines)
    if (std::find(fluid.without.begin(), fluid.without.end(), line.name) != fluid.without.end())
      require_simple(line, region.place("without"));
}

void read_packing(Section& section, Scene& scene) {
  const bool is_fit = !fills_closed_shape(scene);
  scene.fluid.packing = section.choice("packing", {"lattice", "relaxed"}, std::string(is_fit ? "lattice" : "relaxed"));
  require_at(section.place("packing"), is_fit || scene.fluid.packing == "relaxed", "no lattice fits into \"",
             scene.fluid.inside, "\": take packing = \"relaxed\", or fill a box");
}

}  // namespace

void read_fluid(Section root, Scene& scene) {
  std::vector<Section> fluids = root.list("fluid");
  require_at(root.place(), !fluids.empty(),
             "missing table [[fluid]]; add for example:\n    [[fluid]]\n    region = { type = \"box\", min = ",
             scene.dimension == 2 ? "[0.0, 0.0], max = [0.2, 0.4] }" : "[0.0, 0.0, 0.0], max = [0.2, 0.3, 0.4] }");
  if (fluids.size() > 1) refuse(fluids[1].place(), "this version runs one [[fluid]], found ", fluids.size());
  Section& section = fluids.front();
  FluidCase& fluid = scene.fluid;
  fluid.name = section.text("name", std::string("water"));
  require_safe_name(fluid.name, section.place("name"), "the fluid");
  require_at(section.place("name"), fluid.name != "walls",
             "the fluid cannot be called \"walls\": the files of the walls have that name; choose another");
  fluid.density = section.number("density", "kg/m^3", positive, 1000.0);
  const Formulas at_rest{"0", "0", "0"};
  fluid.velocity = read_formulas(section, {"velocity", "m/s", at_rest, Variables::place_and_time}, scene.dimension);
  Section region = section.table("region");
  fluid.place = region.place();
  const std::string type = region.choice("type", {"box", "ball", "inside"}, std::string("box"));
  if (type == "box") read_box_region(region, scene, fluid);
  if (type == "ball") read_ball(region, scene, fluid);
  if (type == "inside") read_inside(region, scene, fluid);
  read_without(region, scene, fluid);
  read_packing(section, scene);
  read_jitter(section, scene);
}

}  // namespace greenwater
