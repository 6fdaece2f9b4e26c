#include "app/structure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "app/build_structure.hpp"
#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/mesh_place.hpp"

namespace greenwater {
namespace {

constexpr const char* axis_names = "xyz";

bool is_loaded(const Scene& scene, const StructureCase& given) {
  return !given.loads.empty() || (given.weight && scene.gravity != Point{0, 0, 0});
}

double distance2(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t d = 0; d < 3; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

/// The nodes that are nearest to a place: all that are as near as the nearest.
std::vector<int> nearest_nodes(const SolidMesh& mesh, const Point& place) {
  constexpr double as_near = 1e-6;
  double least = 1e300;
  for (const Point& x : mesh.nodes) least = std::min(least, distance2(x, place));
  std::vector<int> nodes;
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    if (distance2(mesh.nodes[i], place) <= least * (1 + as_near) + 1e-24) nodes.push_back(i);
  return nodes;
}

double mean_at(const Solid& solid, const Eigen::VectorXd& values, const ProbeCase& probe) {
  const auto nodes = nearest_nodes(solid.mesh(), probe.point);
  const int axis = probe.component.front() - 'x';
  double sum = 0;
  for (const int node : nodes) sum += values[solid.dim() * node + axis];
  return sum / static_cast<double>(nodes.size());
}

double mises(const std::array<double, 6>& s) {
  const double a = s[0] - s[1], b = s[1] - s[2], c = s[2] - s[0];
  return std::sqrt((a * a + b * b + c * c) / 2 + 3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

/// How a mode moves, in words: along which axis most, and whether it only turns about its middle.
std::string motion_in(const Solid& solid, const Eigen::VectorXd& shape) {
  constexpr double none = 1e-3;
  int axis = 0;
  for (int d = 1; d < solid.dim(); ++d)
    if (share_along(solid, shape, d) > share_along(solid, shape, axis)) axis = d;
  double sum = 0, size = 0;
  for (Eigen::Index i = axis; i < shape.size(); i += solid.dim()) {
    sum += solid.mass()[i] * shape[i];
    size += solid.mass()[i] * std::abs(shape[i]);
  }
  return fmt::format("{:.0f} % along {}{}", 100 * share_along(solid, shape, axis), axis_names[axis],
                     std::abs(sum) < none * size ? ", to and fro (torsion)" : "");
}

std::vector<Point> rows_of(const Solid& solid, const Eigen::VectorXd& values) {
  std::vector<Point> rows(solid.mesh().nodes.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int d = 0; d < solid.dim(); ++d) rows[i][d] = values[solid.dim() * static_cast<int>(i) + d];
  return rows;
}

}  // namespace

Structure::Structure(const Scene& scene, const StructureCase& given, double step, int least_substeps)
    : given_(given),
      solid_(build_solid(given)),
      supports_(build_supports(scene, given)),
      loaded_(is_loaded(scene, given)) {
  choose_substeps(step, least_substeps);
  choose_damping();
  march_ = built_at(given_.place, [&] {
    return std::make_unique<March>(*solid_, supports_, build_loads(scene, *solid_, given_), march_options(),
                                   at_nodes(*solid_, given_.displacement), at_nodes(*solid_, given_.velocity),
                                   build_contact(scene, *solid_, given_));
  });
}

void Structure::choose_substeps(double step, int least) {
  constexpr double most_substeps = 1e9;
  critical_ = built_at(given_.material_place, [&] { return critical_step(*solid_, supports_); });
  if (given_.contact) critical_ = Contact::critical_step(critical_, given_.contact->stiffness);
  require_at(given_.time_step_place, given_.time_step < critical_, "time_step = ", given_.time_step,
             " s is not below the critical step of \"", given_.name, "\", ", critical_,
             " s (2/omega_max): the structure would explode; take less, or leave it out for ", given_.safety, " of it");
  const double longest = given_.time_step > 0 ? given_.time_step : given_.safety * critical_;
  const double substeps = std::isfinite(longest) ? std::ceil(step / longest * (1 - 1e-9)) : 1;
  require_at(given_.time_step_place, substeps <= most_substeps, "substeps of ", longest, " s make ", substeps,
             " in one step of ", step, " s; take a longer time_step, or a coarser mesh");
  substeps_ = std::max(least, static_cast<int>(substeps));
  substep_ = step / substeps_;
}

void Structure::choose_damping() {
  damping_ = given_.damping;
  if (!given_.damping_ratio) return;
  const double frequency = given_.damping_frequency > 0 ? given_.damping_frequency : modes(1).frequencies[0];
  damping_ = damping_of(*given_.damping_ratio, frequency);
}

Modes Structure::modes(int count) const {
  return built_at(given_.material_place, [&] { return lowest_modes(*solid_, supports_, count); });
}

double Structure::stress_at(const Point& place, const std::string& component) const {
  const MeshPlace at = place_in_mesh(solid_->mesh(), place);
  const std::array<double, 6> stress = solid_->stress(march_->displacement(), at.element, at.xi);
  if (component == "mises") return mises(stress);
  const std::array<std::string, 6> names{"xx", "yy", "zz", "xy", "yz", "xz"};
  return stress[std::find(names.begin(), names.end(), component) - names.begin()];
}

double Structure::sample(const ProbeCase& probe) const {
  if (probe.kind == "structure_displacement") return mean_at(*solid_, march_->displacement(), probe);
  if (probe.kind == "structure_velocity") return mean_at(*solid_, march_->velocity(), probe);
  if (probe.kind == "structure_stress") return stress_at(probe.point, probe.component);
  if (probe.kind == "structure_reaction") {
    std::vector<int> nodes(solid_->mesh().nodes.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    if (!probe.part.empty()) nodes = find_part(solid_->mesh(), probe.part)->nodes;
    double sum = 0;
    for (const int node : nodes) sum += march_->reaction()[solid_->dim() * node + probe.component.front() - 'x'];
    return sum;
  }
  expect(probe.kind == "structure_energy");
  const Energies energies = march_->energies();
  if (probe.component == "kinetic") return energies.kinetic;
  if (probe.component == "strain") return energies.strain;
  if (probe.component == "contact") return energies.contact;
  if (probe.component == "lost") return energies.lost;
  if (probe.component == "loads") return energies.loads;
  return probe.component == "supports" ? energies.supports : energies.balance();
}

SolidPicture Structure::picture() const {
  return {given_.name,
          &solid_->mesh(),
          {march_->time(),
           rows_of(*solid_, march_->displacement()),
           rows_of(*solid_, march_->velocity()),
           solid_->stress(march_->displacement()),
           {},
           {}}};
}

std::vector<std::string> Structure::plan() const {
  const SolidMesh& mesh = solid_->mesh();
  std::vector<std::string> lines;
  lines.push_back(fmt::format("structure {}: {} nodes, {} {} ({}, {}), mass {:.6g} kg", given_.name, mesh.nodes.size(),
                              mesh.elements.size(), mesh.dim == 3 ? "hexahedra" : "quadrilaterals", given_.element,
                              given_.kinematics, solid_->mass().sum() / solid_->dim()));
  lines.push_back(fmt::format("          {} substeps of {:.6g} s in a step, {:.2f} of the critical {:.4g} s", substeps_,
                              substep_, substep_ / critical_, critical_));
  if (supports_.held.empty() && loaded_ && !given_.contact)
    lines.push_back(fmt::format(
        "warning   {} is held nowhere and loaded: it will fly away -> clamp, [[structure.support]]", given_.name));
  for (const std::string& line : frequency_lines()) lines.push_back(line);
  return lines;
}

std::vector<std::string> Structure::frequency_lines() const {
  constexpr int shown = 3, most_unknowns = 20000;  // beyond, the search would hold up the run
  if (solid_->unknowns() > most_unknowns)
    return {fmt::format("          frequencies are not looked for with more than {} unknowns", most_unknowns)};
  std::vector<std::string> lines;
  const Modes modes = this->modes(shown);
  for (Eigen::Index i = 0; i < modes.frequencies.size(); ++i) {
    const double f = modes.frequencies[i], ratio = damping_ / (4 * std::numbers::pi * f);
    if (f > 0)
      lines.push_back(fmt::format("          f{} = {:.5g} Hz dry, {}, damped with {:.3g} of critical", i + 1, f,
                                  motion_in(*solid_, modes.shapes.col(i)), ratio));
  }
  return lines;
}

ProbeHead structure_probe_head(const ProbeCase& probe) {
  if (probe.kind == "structure_displacement") return {"displacement_" + probe.component, "m"};
  if (probe.kind == "structure_velocity") return {"velocity_" + probe.component, "m/s"};
  if (probe.kind == "structure_stress") return {"stress_" + probe.component, "Pa"};
  if (probe.kind == "structure_reaction") return {"reaction_" + probe.component, "N"};
  return {"energy_" + probe.component, "J"};
}

}  // namespace greenwater
