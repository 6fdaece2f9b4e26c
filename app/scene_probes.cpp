// [[probe]]: what is sampled during the run, each into its own file.

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

/// Each kind asks for its own keys; those of another kind are unknown keys.
void read_kind(Section& section, const Scene& scene, ProbeCase& probe) {
  const Words walls = wall_names(scene);
  const std::string shown = walls.empty() ? "tank" : walls.front();
  const Words axes = scene.dimension == 2 ? Words{"x", "y"} : Words{"x", "y", "z"};
  if (probe.kind == "surface_height") {
    probe.x = section.number("x", "m", any_number, example(0.3));
    if (scene.dimension == 3 && section.offers("y")) probe.y = section.number("y", "m", any_number, example(0.1));
  }
  if (probe.kind == "wall_force") {
    probe.wall = section.choice("wall", walls, example(shown));
    probe.component = section.choice("component", axes, std::string("x"));
  }
  if (probe.kind == "wall_pressure") {
    probe.point = section.vector("point", "m", scene.dimension, example(Point{0.6, 0.01, 0.01}));
    probe.facing = section.vector("facing", "-", scene.dimension, Point{0, 0, 0});
  }
  if (probe.kind == "wall_pressure" || probe.kind == "wall_force") {
    const bool classic = scene.mps.scheme == "classic";
    Words readings{"neumann", "average"};
    if (probe.kind == "wall_force" && !classic) readings.emplace_back("reaction");
    probe.reading = section.choice("reading", readings, std::string(classic ? "average" : "neumann"));
  }
  const bool boxed = section.has("min") || section.has("max");
  if (probe.kind == "particle_count" && boxed) {
    const Corners corners = read_corners(section, scene.dimension, {{0, 0, 0}, {0.1, 0.1, 0.1}});
    probe.min = corners.min;
    probe.max = corners.max;
  }
}

}  // namespace

void read_probes(Section root, Scene& scene) {
  for (Section& section : root.list("probe")) {
    ProbeCase probe;
    probe.place = section.place();
    probe.name = section.text("name", example<std::string>("front"));
    require_safe_name(probe.name, section.place("name"), "the probe");
    for (const ProbeCase& other : scene.probes) {
      require_at(section.place("name"), other.name != probe.name, "two probes have the name \"", probe.name,
                 "\"; each writes its own file, so rename one");
    }
    probe.kind =
        section.choice("kind", {"wave_front", "surface_height", "wall_pressure", "wall_force", "particle_count"},
                       example<std::string>("wave_front"));
    probe.every_time = section.number("every_time", "s", at_least(0), 0.0);
    read_kind(section, scene, probe);
    scene.probes.push_back(probe);
  }
}

}  // namespace greenwater
