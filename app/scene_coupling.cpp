// How structures meet the fluid: wet surfaces, [coupling].

#include <algorithm>

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

/// Parts that may be wet: those with facets, in a 2-D fluid without the ends of the width.
Words parts_to_be_wet(const StructureCase& structure, int dimension) {
  Words names;
  for (const MeshPart& part : structure.mesh.parts) {
    const bool of_width = dimension == 2 && structure.mesh.dim == 3 && (part.name == "front" || part.name == "back");
    if (!part.facets.empty() && !of_width) names.push_back(part.name);
  }
  return names;
}

}  // namespace

void read_wet_surface(Section& section, int dimension, StructureCase& structure) {
  const Words parts = parts_to_be_wet(structure, dimension);
  Words usual;
  for (const std::string& part : parts)
    if (std::none_of(structure.supports.begin(), structure.supports.end(),
                     [&](const SupportCase& support) { return support.part == part; }))
      usual.push_back(part);
  structure.wet = section.choices("wet", parts, usual);
  structure.wet_place = section.place("wet");
  require_at(structure.wet_place, !structure.wet.empty(), "wet is empty: the fluid touches nothing of \"",
             structure.name, "\"; name parts of its mesh that are surfaces");
  structure.no_slip = section.flag("no_slip", false);
}

void read_coupling(Section section, Scene& scene) {
  CouplingCase& coupling = scene.coupling;
  const bool classic = scene.mps.scheme == "classic";
  const Words schemes = classic ? Words{"staggered", "aitken"} : Words{"default", "aitken", "staggered"};
  coupling.scheme = section.choice("scheme", schemes, schemes.front());
  Words loads{"least_squares", "kernel_average"};
  if (!classic) loads.insert(loads.begin(), "transpose");
  const bool one_load = coupling.scheme == "default";
  if (one_load) loads = {"transpose"};
  coupling.load = section.choice("load", loads, classic ? loads.back() : loads.front());
  coupling.tolerance = section.number("tolerance", "-", {0, 1, false}, coupling.tolerance);
  constexpr std::int64_t most_iterations = 1'000'000;
  const std::int64_t iterations = section.count("max_iterations", 1, std::int64_t{coupling.max_iterations});
  require_at(section.place("max_iterations"), iterations <= most_iterations, "max_iterations = ", iterations,
             " must be at most ", most_iterations);
  coupling.max_iterations = static_cast<int>(iterations);
  if (coupling.scheme == "aitken")
    coupling.relaxation = section.number("relaxation", "-", {0, 1, true}, coupling.relaxation);
}

}  // namespace greenwater
