#pragma once
// The parts of read_scene(), one per chapter of the case file. Each reads its tables into the scene, and checks what it
// can check alone; check_scene() looks at how the parts fit together.

#include <filesystem>

#include "app/formula.hpp"
#include "app/scene.hpp"

namespace greenwater {

void read_geometry(Section root, Scene& scene);         // [geometry.NAME]
void read_fluid(Section root, Scene& scene);            // [[fluid]]
void read_mps(Section mps, Scene& scene);               // [mps], [mps.pressure]
void read_undo(Section undo, Scene& scene);             // [mps.undo], after all others
void read_effects(Section effects, Scene& scene);       // [effects.NAME]
void read_output(Section output, OutputCase& options);  // [output]
void read_probes(Section root, Scene& scene);           // [[probe]]
void read_structures(Section root, Scene& scene);       // [[structure]]

/// `wet` and `no_slip` of a structure in a fluid: what the fluid touches; all that is not held, unless the case says
/// otherwise.
void read_wet_surface(Section& section, int dimension, StructureCase& structure);
void read_coupling(Section section, Scene& scene);  // [coupling]

/// `[geometry.NAME]` with type = "stl": the file, scaled, turned, moved and checked. Throws CaseError that names the STL
/// file, the triangle or line in it, and the cure.
MeshCase read_mesh(const std::string& name, Section& section);

/// Base, height, thickness, angle of a plate; the width where it is asked for.
PlateCase read_plate(Section& section, int dimension, bool with_width);

/// The structure of this name, or nullptr.
const StructureCase* find_structure(const Scene& scene, const std::string& name);

/// Metres in a unit of length of a mesh file.
double metres_in(const std::string& unit);

/// The corners of a polyline [m], x and y in each row of a text file. Throws CaseError with the line in that file; a
/// point that repeats the one before it is refused.
std::vector<Point> read_point_file(const std::filesystem::path& path, const Place& place);

/// `[geometry.NAME.motion]`, where there is one. Its tables are read, its formulas compile, and it begins at rest.
std::optional<MotionCase> read_motion(Section& geometry, int dimension);

/// Throws CaseError when the motion of a geometry that has one says nothing.
void require_motion(const GeometryCase& geometry);

/// Plates in their box and apart, no walls that cut through each other. Throws CaseError.
void check_walls(const Scene& scene);

/// All of that: sizes against the spacing, walls against each other, fluid in the tank, motions against the step, all inside the
/// domain. Throws CaseError.
void check_scene(const Scene& scene);

/// Of a scene without fluid: geometries that no structure has to do with, motions that are none. Throws CaseError.
void check_scene_alone(const Scene& scene);

/// The end of a box: `min` and `max` [m], each component of max above that of min.
struct Corners {
  Point min{}, max{};
};
Corners read_corners(Section& section, int dimension, const Corners& shown);

/// Names become parts of file names: letters, digits, '_', '-' and '.', not first.
void require_safe_name(const std::string& name, const Place& place, const std::string& of_what);

/// A vector of formulas to be read: its key, unit, default or example, and what it may depend on.
struct FormulaWish {
  std::string key, unit;
  Preset<Formulas> preset;
  Variables variables;
};

/// A formula vector that compiles.
VectorFormula read_formulas(Section& section, const FormulaWish& wish, int dimension);

}  // namespace greenwater
