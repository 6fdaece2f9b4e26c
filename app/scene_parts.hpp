#pragma once
// The parts of read_scene(), one per chapter of the case file. Each reads its tables into the scene, and checks what it
// can check alone; check_scene() looks at how the parts fit together.

#include "app/scene.hpp"

namespace greenwater {

void read_geometry(Section root, Scene& scene);         // [geometry.NAME]
void read_fluid(Section root, Scene& scene);            // [[fluid]]
void read_mps(Section mps, MpsCase& options);           // [mps], [mps.pressure]
void read_effects(Section effects, Scene& scene);       // [effects.NAME]
void read_output(Section output, OutputCase& options);  // [output]
void read_probes(Section root, Scene& scene);           // [[probe]]

/// Sizes against the spacing, fluid in the tank, plates in the tank, all inside the domain. Throws CaseError.
void check_scene(const Scene& scene);

/// The end of a box: `min` and `max` [m], each component of max above that of min.
struct Corners {
  Point min{}, max{};
};
Corners read_corners(Section& section, int dimension, const Corners& shown);

/// Names become parts of file names: letters, digits, '_', '-' and '.', not first.
void require_safe_name(const std::string& name, const Place& place, const std::string& of_what);

/// A formula vector that compiles; presets are constants.
VectorFormula read_formulas(Section& section, const std::string& key, const std::string& unit, int dimension,
                            const Preset<Formulas>& preset);

}  // namespace greenwater
