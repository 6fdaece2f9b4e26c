// [[probe]]: what is sampled during the run, each into its own file.

#include <algorithm>

#include "app/plate_frame.hpp"
#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

const Words fluid_kinds{"wave_front", "surface_height", "wall_pressure", "wall_force", "particle_count"};
const Words structure_kinds{"structure_displacement", "structure_velocity", "structure_stress", "structure_reaction",
                            "structure_energy"};

const Words load_kinds{"structure_pressure", "structure_force"};  // of the fluid on it

Words kinds_of(const Scene& scene) {
  Words kinds = scene.has_fluid ? fluid_kinds : Words{};
  if (!scene.structures.empty()) kinds.insert(kinds.end(), structure_kinds.begin(), structure_kinds.end());
  if (!scene.structures.empty() && scene.has_fluid) kinds.insert(kinds.end(), load_kinds.begin(), load_kinds.end());
  return kinds;
}

/// A point, or of a plate how high on it and on which side, in the middle of its width. Left is -x of a plate upright.
Point read_place_on(Section& section, const Scene& scene, const StructureCase& structure) {
  if (!structure.plate || section.offers("point")) {
    const Point shown = structure.mesh.nodes.empty() ? Point{} : structure.mesh.nodes.back();
    return section.vector("point", "m", structure.mesh.dim, example(shown));
  }
  const PlateCase& plate = *structure.plate;
  const double part = section.number("height_fraction", "-", between(0, 1), example(1.0));
  const std::string side = section.choice("side", {"middle", "left", "right"}, std::string("middle"));
  const double right = side == "left" ? 0 : side == "right" ? plate.thickness : plate.thickness / 2;
  const PlateFrame frame = frame_of(plate, scene.dimension);
  Point point = frame.corner;
  for (std::size_t d = 0; d < 3; ++d)
    point[d] += part * plate.height * frame.up[d] + right * frame.right[d] + plate.width / 2 * frame.over[d];
  return point;
}

void read_structure_kind(Section& section, const Scene& scene, ProbeCase& probe) {
  Words names;
  for (const StructureCase& structure : scene.structures) names.push_back(structure.name);
  const std::string name = section.choice("structure", names, names.front());
  const StructureCase& structure = *find_structure(scene, name);
  probe.structure = static_cast<std::size_t>(&structure - scene.structures.data());
  const Words axes = structure.mesh.dim == 2 ? Words{"x", "y"} : Words{"x", "y", "z"};
  if (probe.kind == "structure_energy") {
    const Words energies{"kinetic", "strain", "contact", "lost", "loads", "supports", "balance"};
    probe.component = section.choice("component", energies, std::string("strain"));
  } else if (probe.kind == "structure_stress") {
    probe.point = read_place_on(section, scene, structure);
    probe.component = section.choice("component", {"xx", "yy", "zz", "xy", "yz", "xz", "mises"}, std::string("mises"));
  } else if (probe.kind == "structure_reaction") {
    Words parts;
    for (const MeshPart& part : structure.mesh.parts) parts.push_back(part.name);
    if (section.offers("part")) probe.part = section.choice("part", parts, example(std::string("bottom")));
    probe.component = section.choice("component", axes, std::string("x"));
  } else if (probe.kind == "structure_pressure") {
    require_at(section.place("kind"), structure.plate.has_value(),
               "a structure_pressure is the difference over a plate, and \"", name,
               "\" is none; take structure_force, or shape = \"plate\"");
    probe.height_fraction = section.number("height_fraction", "-", between(0, 1), example(0.5));
  } else if (probe.kind == "structure_force") {
    probe.component =
        section.choice("component", scene.dimension == 2 ? Words{"x", "y"} : Words{"x", "y", "z"}, std::string("x"));
  } else {
    probe.point = read_place_on(section, scene, structure);
    probe.component = section.choice("component", axes, std::string("x"));
  }
}

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
  const Words kinds = kinds_of(scene);
  for (Section& section : root.list("probe")) {
    ProbeCase probe;
    probe.place = section.place();
    probe.name = section.text("name", example<std::string>("front"));
    require_safe_name(probe.name, section.place("name"), "the probe");
    for (const ProbeCase& other : scene.probes) {
      require_at(section.place("name"), other.name != probe.name, "two probes have the name \"", probe.name,
                 "\"; each writes its own file, so rename one");
    }
    probe.kind = section.choice("kind", kinds, example(kinds.front()));
    probe.every_time = section.number("every_time", "s", at_least(0), 0.0);
    is_of_structure(probe) ? read_structure_kind(section, scene, probe) : read_kind(section, scene, probe);
    scene.probes.push_back(probe);
  }
}

}  // namespace greenwater
