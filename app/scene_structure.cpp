// [[structure]]: elastic bodies, how they are held and loaded.

#include <algorithm>
#include <cmath>

#include "app/scene_parts.hpp"
#include "app/structure_mesh.hpp"
#include "io/gmsh.hpp"

namespace greenwater {
namespace {

constexpr double most_elements = 1e8;  // for slips in the divisions

Divisions read_divisions(Section& fem, int dimension) {
  const Preset<std::vector<std::int64_t>> shown = example(dimension == 2 ? Divisions{1, 100} : Divisions{1, 100, 1});
  const Divisions divisions = fem.counts("divisions", 1, shown);
  const Place place = fem.place("divisions");
  require_at(place, divisions.size() == 3 || (divisions.size() == 2 && dimension == 2), "divisions has ",
             divisions.size(), " numbers; give three for hexahedra",
             dimension == 2 ? ", or two for quadrilaterals in the plane" : "");
  double elements = 1;
  for (const std::int64_t n : divisions) elements *= static_cast<double>(n);
  require_at(place, elements <= most_elements, "divisions make ", elements, " elements; at most ", most_elements);
  return divisions;
}

void read_plate_shape(Section& section, Section& fem, int dimension, StructureCase& structure) {
  const Divisions divisions = read_divisions(fem, dimension);
  PlateCase plate = read_plate(section, dimension, divisions.size() == 3);
  require_at(section.place("thickness"), plate.thickness > 0,
             "a structure needs a thickness; add thickness = \"3 mm\"");
  plate.name = structure.name;
  structure.mesh = mesh_of(plate, dimension, divisions);
  structure.plate = plate;
}

void read_box_shape(Section& section, Section& fem, int dimension, StructureCase& structure) {
  const Divisions divisions = read_divisions(fem, dimension);
  const Corners corners = read_corners(section, dimension, {{0, 0, 0}, {1, 0.1, 0.1}});
  const bool wide = dimension == 2 && divisions.size() == 3;
  const double width = wide ? section.number("width", "m", positive, example(0.1)) : 0;
  structure.mesh = mesh_of_box(corners.min, corners.max, width, dimension, divisions);
}

void read_mesh_shape(Section& section, int dimension, StructureCase& structure) {
  const auto path = section.file("file", "plate.msh");
  const std::string unit = section.choice("unit", {"m", "mm", "cm", "in"}, std::string("m"));
  const Point by = section.vector("move", "m", 3, Point{0, 0, 0});
  structure.mesh = read_gmsh(path, section.place("file"));
  require_at(section.place("file"), structure.mesh.dim == 3 || dimension == 2,
             "the mesh has quadrilaterals only, which are for dimension = 2; in 3-D mesh the solid with hexahedra");
  scale(structure.mesh, metres_in(unit));
  for (Point& x : structure.mesh.nodes)
    for (std::size_t d = 0; d < 3; ++d) x[d] += by[d];
}

void read_shape(Section& section, Section& fem, int dimension, StructureCase& structure) {
  const std::string shape = section.choice("shape", {"plate", "box", "mesh"}, std::string("plate"));
  if (shape == "plate") read_plate_shape(section, fem, dimension, structure);
  if (shape == "box") read_box_shape(section, fem, dimension, structure);
  if (shape == "mesh") read_mesh_shape(section, dimension, structure);
  for (const auto& [key, count] : {std::pair{"expected_nodes", structure.mesh.nodes.size()},
                                   std::pair{"expected_elements", structure.mesh.elements.size()}}) {
    const std::int64_t expected = fem.count(key, 0, std::int64_t{0});
    require_at(fem.place(key), expected == 0 || expected == static_cast<std::int64_t>(count), "the mesh of \"",
               structure.name, "\" has ", count, ", not ", key, " = ", expected);
  }
}

void read_material(Section& section, StructureCase& structure) {
  constexpr double incompressible = 0.5;
  structure.material = section.text("material", std::string());
  structure.young = section.number("young", "Pa", positive, example(3.43e9));
  structure.material_place = section.place("young");
  structure.density = section.number("density", "kg/m^3", positive, example(1200.0));
  structure.poisson = section.number("poisson", "-", any_number, example(0.37));
  require_at(section.place("poisson"), structure.poisson > -1 && structure.poisson < incompressible,
             "poisson = ", structure.poisson,
             " must lie between -1 and 0.5; for rubber take 0.49 or 0.499 and element = ", "\"mean_dilatation\"");
  structure.law = section.choice("law", {"linear", "neo_hookean"}, structure.law);
}

void read_elements(Section& fem, StructureCase& structure) {
  structure.element = fem.choice("element", {"incompatible", "full", "mean_dilatation"}, structure.element);
  structure.kinematics = fem.choice("kinematics", {"corotational", "small", "total_lagrangian"}, structure.kinematics);
  require_at(fem.place("kinematics"), structure.law == "linear" || structure.kinematics == "total_lagrangian",
             "law = \"neo_hookean\" needs kinematics = \"total_lagrangian\"; the others are linear in the strain");
  if (structure.mesh.dim == 3) return;
  structure.plane = fem.choice("plane", {"strain", "stress"}, structure.plane);
  structure.depth = fem.number("depth", "m", positive, structure.depth);
}

void read_time_integration(Section& fem, StructureCase& structure) {
  structure.time_step = fem.number("time_step", "s", at_least(0), structure.time_step);
  structure.time_step_place = fem.place("time_step");
  structure.safety = fem.number("safety", "-", {0, 1, false}, structure.safety);
  const bool by_ratio = fem.offers("damping_ratio");
  require_at(fem.place("damping_ratio"), !by_ratio || !fem.has("damping_alpha"),
             "both damping_alpha and damping_ratio say how it is damped: keep one of them");
  if (by_ratio) {
    fem.offers("damping_alpha");
    structure.damping_ratio = fem.number("damping_ratio", "-", at_least(0), 0.0);
    structure.damping_frequency = fem.number("damping_frequency", "Hz", at_least(0), 0.0);
  } else {
    structure.damping = fem.number("damping_alpha", "1/s", at_least(0), 0.0);
  }
}

Words part_names_of(const SolidMesh& mesh) {
  Words names;
  for (const MeshPart& part : mesh.parts) names.push_back(part.name);
  return names;
}

std::vector<int> read_axes(Section& section, int mesh_dim) {
  const Words all = mesh_dim == 2 ? Words{"x", "y"} : Words{"x", "y", "z"};
  std::vector<int> axes;
  for (const std::string& axis : section.choices("axes", all, all)) axes.push_back(axis.front() - 'x');
  require_at(section.place("axes"), !axes.empty(), "axes is empty: a support holds at least one of ", all.size());
  return axes;
}

NumberFormula read_formula(Section& section, const std::string& key, const std::string& unit,
                           const Preset<std::string>& preset, Variables variables) {
  NumberFormula formula;
  formula.text = section.formula(key, unit, preset);
  formula.place = section.place(key);
  const Formula compiled(formula.text, formula.place, variables);
  return formula;
}

void read_support_motion(Section& one, const Scene& scene, const SolidMesh& mesh, SupportCase& support) {
  if (!one.offers("with")) {
    support.axes = read_axes(one, mesh.dim);
    if (one.offers("displacement"))
      support.displacement = read_formula(one, "displacement", "m", std::string("0"), Variables::time);
    return;
  }
  for (const char* key : {"axes", "displacement"})
    require_at(one.place(key), !one.offers(key), "a support that moves with a geometry does so along all axes: delete ",
               key, ", or with");
  const Words geometries = wall_names(scene);
  require_at(one.place("with"), !geometries.empty(), "there is no geometry to move with: add [geometry.NAME]");
  support.with = one.choice("with", geometries, example(geometries.front()));
}

void read_supports(Section& section, const Scene& scene, StructureCase& structure) {
  const Preset<Words> usual = structure.plate ? Words{"bottom"} : Words{};
  const Words parts = part_names_of(structure.mesh);
  const std::vector<int> all_axes = structure.mesh.dim == 2 ? std::vector{0, 1} : std::vector{0, 1, 2};
  for (const std::string& part : section.choices("clamp", parts, usual)) {
    structure.supports.push_back({section.place("clamp"), part, {}, {}, all_axes, {}, {}});
  }
  for (Section& one : section.list("support")) {
    SupportCase support;
    support.place = one.place();
    if (one.offers("part")) {
      support.part = one.choice("part", parts, example(parts.empty() ? std::string("foot") : parts.front()));
    } else {
      const Corners box = read_corners(one, scene.dimension, {{0, 0, 0}, {0.01, 0.01, 0.01}});
      support.min = box.min;
      support.max = box.max;
    }
    read_support_motion(one, scene, structure.mesh, support);
    structure.supports.push_back(support);
  }
}

void read_loaded_part(Section& section, const StructureCase& structure, StructureLoadCase& load) {
  const Words parts = part_names_of(structure.mesh);
  require_at(section.place(), !parts.empty(), "the mesh has no part to be loaded: give it physical groups");
  load.part = section.choice("part", parts, example(parts.front()));
  const MeshPart& part = *find_part(structure.mesh, load.part);
  require_at(section.place("part"), load.kind == "force" || !part.facets.empty(), "\"", load.part,
             "\" has nodes but no surface: a ", load.kind, " acts on surfaces; take kind = \"force\"");
}

StructureLoadCase read_load(Section& section, int dimension, const StructureCase& structure) {
  StructureLoadCase load;
  load.place = section.place();
  load.kind =
      section.choice("kind", {"pressure", "traction", "force", "acceleration"}, example<std::string>("pressure"));
  if (load.kind != "acceleration") read_loaded_part(section, structure, load);
  const Variables place = Variables::place_and_time;
  if (load.kind == "pressure") {
    load.pressure = read_formula(section, "pressure", "Pa", example<std::string>("1000"), place);
    load.follows = section.flag("follows", false);
    require_at(section.place("follows"), !load.follows || Formula(load.pressure.text, load.pressure.place).constant(),
               "a pressure that follows is one number; let it vary in time by factor");
  } else {
    const std::string unit = load.kind == "force" ? "N" : load.kind == "traction" ? "Pa" : "m/s^2";
    load.vector = read_formulas(section, {load.kind, unit, example(Formulas{"1", "0", "0"}), place}, dimension);
  }
  load.factor = read_formula(section, "factor", "-", std::string("1"), Variables::time);
  return load;
}

std::optional<ContactCase> read_contact(Section& section, const Scene& scene) {
  auto table = section.table_if_present("contact");
  if (!table) return {};
  const Words geometries = wall_names(scene);
  require_at(table->place(), !geometries.empty(), "there is no geometry to touch: add [geometry.NAME]");
  ContactCase contact;
  contact.place = table->place();
  contact.walls = table->choices("walls", geometries, example(geometries));
  require_at(table->place("walls"), !contact.walls.empty(),
             "walls = [] names nothing to touch; name a geometry, or delete the table ", table->header());
  contact.stiffness = table->number("stiffness", "-", {0, 1, false}, contact.stiffness);
  return contact;
}

StructureCase read_structure(Section& section, const Scene& scene) {
  StructureCase structure;
  structure.place = section.place();
  structure.name = section.text("name", std::string("plate"));
  require_safe_name(structure.name, section.place("name"), "the structure");
  require_at(section.place("name"), structure.name != "walls" && find_structure(scene, structure.name) == nullptr,
             "the name \"", structure.name, "\" is taken; each structure writes its own files, so choose another");
  Section fem = section.table("fem");
  read_shape(section, fem, scene.dimension, structure);
  read_material(section, structure);
  read_elements(fem, structure);
  read_time_integration(fem, structure);
  structure.weight = section.flag("weight", structure.weight);
  const Preset<Formulas> none = Formulas{"0", "0", "0"};
  structure.displacement = read_formulas(section, {"displacement", "m", none, {}}, scene.dimension);
  structure.velocity = read_formulas(section, {"velocity", "m/s", none, {}}, scene.dimension);
  read_supports(section, scene, structure);
  for (Section& load : section.list("load")) structure.loads.push_back(read_load(load, scene.dimension, structure));
  structure.contact = read_contact(section, scene);
  if (scene.has_fluid) read_wet_surface(section, scene.dimension, structure);
  return structure;
}

}  // namespace

const StructureCase* find_structure(const Scene& scene, const std::string& name) {
  for (const StructureCase& structure : scene.structures)
    if (structure.name == name) return &structure;
  return nullptr;
}

void read_structures(Section root, Scene& scene) {
  for (Section& section : root.list("structure")) scene.structures.push_back(read_structure(section, scene));
  if (scene.has_fluid && !scene.structures.empty()) read_coupling(root.table("coupling"), scene);
}

}  // namespace greenwater
