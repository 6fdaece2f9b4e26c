#include "app/scene.hpp"

#include <algorithm>
#include <cctype>

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

void read_format(Section& root) {
  constexpr std::int64_t known_format = 1;
  const std::int64_t format = root.count("format", 1, example<std::int64_t>(known_format));
  require_at(root.place("format"), format == known_format, "format ", format,
             " is not known to this version, which reads format ", known_format);
}

void read_case(Section section, Scene& scene) {
  scene.name = section.text("name", example<std::string>("dam_break"));
  require_safe_name(scene.name, section.place("name"), "the case");
  scene.title = section.text("title", std::string());
  scene.reference = section.text("reference", std::string());
  const std::int64_t dimension = section.count("dimension", 1, std::int64_t{2});
  require_at(section.place("dimension"), dimension == 2 || dimension == 3, "dimension must be 2 or 3, not ", dimension);
  scene.dimension = static_cast<int>(dimension);
}

void read_time(Section section, Scene& scene) {
  scene.end = section.number("end", "s", positive, example(0.5));
  const Point down = scene.dimension == 2 ? Point{0, -9.81, 0} : Point{0, 0, -9.81};
  scene.gravity = section.vector("gravity", "m/s^2", scene.dimension, down);
}

void read_domain(Section& root, Scene& scene) {
  auto section = root.table_if_present("domain");
  if (!section) return;
  const Corners corners = read_corners(*section, scene.dimension, {{-1, -1, -1}, {2, 2, 2}});
  scene.has_domain = true;
  scene.domain_min = corners.min;
  scene.domain_max = corners.max;
  scene.domain_place = section->place();
  const Words axes = scene.dimension == 2 ? Words{"x", "y"} : Words{"x", "y", "z"};
  for (const std::string& axis : section->choices("periodic", axes, Words{})) scene.repeats[axis.front() - 'x'] = true;
  scene.repeats_place = section->place("periodic");
}

void read_water(Section& root, Scene& scene) {
  read_fluid(root, scene);
  read_mps(root.table("mps"), scene);
  if (auto effects = root.table_if_present("effects")) read_effects(*effects, scene);
}

/// fluid = [] is as much as no fluid; a case has one, or a structure.
void require_content(Section& root) {
  if (root.offers_some("fluid") || root.offers_some("structure")) return;
  for (const char* key : {"fluid", "structure"})
    require_at(root.place(key), !root.has(key), key,
               " = [] is empty, and there is nothing else to be computed; delete it "
               "and add [[fluid]] with its region, or [[structure]] with its shape and material");
}

/// Of a run without fluid: the step in which structures take their substeps.
void read_step_alone(Section& root, Scene& scene) {
  constexpr double usual_steps = 1000;
  for (const char* table : {"mps", "effects", "domain"})
    require_at(root.place(table), !root.offers(table), "[", table,
               "] is about fluid, and there is no [[fluid]]: delete it");
  Section time = root.table("time");
  scene.step = time.number("step", "s", positive, scene.end / usual_steps);
  require_at(time.place("step"), scene.step <= scene.end, "time.step = ", scene.step,
             " s is longer than the run, time.end = ", scene.end, " s; take a shorter step");
}

}  // namespace

Corners read_corners(Section& section, int dimension, const Corners& shown) {
  Corners corners;
  corners.min = section.vector("min", "m", dimension, example(shown.min));
  corners.max = section.vector("max", "m", dimension, example(shown.max));
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    require_at(section.place("max"), corners.max[d] > corners.min[d], section.header(), " is empty: max ",
               toml_point(corners.max, dimension), " must be above min ", toml_point(corners.min, dimension),
               " in every component");
  }
  return corners;
}

void require_safe_name(const std::string& name, const Place& place, const std::string& of_what) {
  constexpr std::size_t longest = 64;
  const bool safe = std::all_of(name.begin(), name.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
  });
  require_at(place, safe && !name.empty() && name.size() <= longest && name.front() != '.' && name.front() != '-',
             "the name \"", name, "\" of ", of_what,
             " becomes part of file names: use letters, digits, '_', '-' and '.', at most ", longest);
}

VectorFormula read_formulas(Section& section, const FormulaWish& wish, int dimension) {
  VectorFormula vector;
  vector.text = section.formulas(wish.key, wish.unit, dimension, wish.preset);
  vector.place = section.place(wish.key);
  compile(vector.text, vector.place, wish.variables);
  return vector;
}

bool is_of_structure(const ProbeCase& probe) { return probe.kind.rfind("structure_", 0) == 0; }

std::vector<std::string> box_sides(int dimension) {
  return dimension == 2 ? Words{"left", "right", "bottom", "top"}
                        : Words{"left", "right", "front", "back", "bottom", "top"};
}

std::vector<std::string> wall_names(const Scene& scene) {
  Words names;
  for (const BoxCase& box : scene.boxes) names.push_back(box.name);
  for (const PolylineCase& line : scene.polylines) names.push_back(line.name);
  for (const PlateCase& plate : scene.plates) names.push_back(plate.name);
  for (const MeshCase& mesh : scene.meshes) names.push_back(mesh.name);
  return names;
}

Scene read_scene(CaseFile& file) {
  Scene scene;
  Section root = file.root();
  read_format(root);
  read_case(root.table("case"), scene);
  read_time(root.table("time"), scene);
  read_domain(root, scene);
  read_geometry(root, scene);
  require_content(root);
  scene.has_fluid = root.offers_some("fluid") || !root.offers_some("structure");
  scene.has_fluid ? read_water(root, scene) : read_step_alone(root, scene);
  read_structures(root, scene);
  if (scene.has_fluid) read_undo(root.table("mps").table("undo"), scene);
  read_output(root.table("output"), scene.output);
  read_probes(root, scene);
  file.finish();
  scene.has_fluid ? check_scene(scene) : check_scene_alone(scene);
  return scene;
}

}  // namespace greenwater
