#include "app/build_coupling.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "app/build_structure.hpp"
#include "app/plate_frame.hpp"
#include "app/step_length.hpp"

namespace greenwater {
namespace {

CouplingOptions options_of(const Scene& scene) {
  const CouplingCase& given = scene.coupling;
  CouplingOptions options;
  options.walls_accelerate = scene.mps.scheme != "classic";
  options.way = given.scheme == "default"  ? CouplingWay::joint
                : given.scheme == "aitken" ? CouplingWay::aitken
                                           : CouplingWay::staggered;
  options.load = given.load == "transpose"       ? LoadReading::transpose
                 : given.load == "least_squares" ? LoadReading::least_squares
                                                 : LoadReading::kernel_average;
  options.tolerance = given.tolerance;
  options.most_passes = given.max_iterations;
  options.first_relaxation = given.relaxation;
  return options;
}

std::vector<Facet> wet_facets(const StructureCase& given) {
  std::vector<Facet> facets;
  for (const std::string& name : given.wet)
    for (const Facet facet : find_part(given.mesh, name)->facets) facets.push_back(facet);
  return facets;
}

}  // namespace

std::vector<Structure> build_structures(const Scene& scene) {
  constexpr int most_halvings = 4;  // that substeps are made for: a step that is undone is a whole number of them
  const double step = scene.has_fluid ? step_at_rest(scene) : scene.step;
  const auto build = [&](int least_substeps) {
    std::vector<Structure> structures;
    for (const StructureCase& given : scene.structures) structures.emplace_back(scene, given, step, least_substeps);
    return structures;
  };
  const int halvings = scene.mps.undo.halvings;
  const bool steps_differ = scene.has_fluid && (scene.mps.adaptive || halvings > 0);
  int least = steps_differ ? 1 << std::min(halvings, most_halvings) : 1;
  std::vector<Structure> structures = build(least);
  if (!steps_differ || structures.size() < 2) return structures;
  for (const Structure& structure : structures) least = std::max(least, structure.substeps());
  return build(least);
}

std::vector<WetSurface> add_wet_surfaces(const Scene& scene, const std::vector<Structure>& structures,
                                         WallFaces& walls) {
  std::vector<WetSurface> surfaces;
  for (const Structure& structure : structures) {
    const StructureCase& given = structure.given();
    WetSurface surface = built_at(
        given.wet_place, [&] { return WetSurface(given.mesh, wet_facets(given), scene.dimension, given.depth); });
    const int body = static_cast<int>(walls.bodies.size());
    walls.bodies.push_back({given.name, given.no_slip, true});
    const Eigen::VectorXd displaced = surface.at_corners(structure.march().displacement());
    const auto faces = surface.faces(body);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      walls.faces.push_back(faces[f]);
      for (int e = 0; e < walls.dim; ++e)
        for (int d = 0; d < walls.dim; ++d)
          walls.faces.back().corner[e].position[d] += displaced[walls.dim * surface.corner_of_face()[f][e] + d];
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

std::vector<std::string> coupling_lines(const Scene& scene) {
  constexpr double of_first_mode = 0.2386;  // potential flow, wet on one side up to the tip: m_a = 0.2386 rho L
  if (scene.structures.empty()) return {};
  std::vector<std::string> lines{fmt::format("coupling  {}, load {}", scene.coupling.scheme, scene.coupling.load)};
  for (const StructureCase& given : scene.structures) {
    if (!given.plate) continue;
    const double ratio =
        of_first_mode * scene.fluid.density * given.plate->height / (given.density * given.plate->thickness);
    lines.back() +=
        fmt::format("; added mass of {} about {:.2g} times its own, wet on one side up to its tip", given.name, ratio);
    if (scene.coupling.scheme == "staggered" && ratio > 1)
      lines.push_back(
          fmt::format("warning   a staggered march is unstable above an added mass of 1 in an incompressible "
                      "fluid; {} has {:.2g} -> coupling.scheme = \"default\" or \"aitken\"",
                      given.name, ratio));
  }
  return lines;
}

PlateBand band_of(const Scene& scene, const ProbeCase& probe) {
  const PlateCase& plate = *scene.structures[probe.structure].plate;
  const PlateFrame frame = frame_of(plate, scene.dimension);
  const double length = std::min(2 * scene.mps.spacing, plate.height);
  const double low = std::clamp(probe.height_fraction * plate.height - length / 2, 0.0, plate.height - length);
  return {frame.corner, frame.up, frame.right, low, low + length};
}

Coupler build_coupler(const Scene& scene, std::vector<Structure>& structures, std::vector<WetSurface> surfaces,
                      const WallFaces& walls) {
  std::vector<ElasticBody> bodies;
  std::size_t faces = 0;
  for (const WetSurface& surface : surfaces) faces += surface.corner_of_face().size();
  std::size_t first_face = walls.faces.size() - faces;  // they were added last
  for (std::size_t k = 0; k < structures.size(); ++k) {
    const std::size_t count = surfaces[k].corner_of_face().size();
    bodies.push_back({&structures[k].solid(), &structures[k].supports(), &structures[k].march(),
                      structures[k].march_options(), std::move(surfaces[k]), static_cast<int>(first_face)});
    first_face += count;
  }
  return Coupler(std::move(bodies), walls, options_of(scene));
}

}  // namespace greenwater
