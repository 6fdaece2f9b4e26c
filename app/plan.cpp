#include "app/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/motion.hpp"
#include "app/scene_shape.hpp"
#include "app/step_length.hpp"

namespace greenwater {
namespace {

// Bytes per particle, counted from the fields: state and scratch of the sort (150), the solver's vectors (50), grid and
// row ends (50), host copies for a frame (100); rounded up. A third axis adds eight bytes to each of eight vectors.
constexpr double bytes_per_particle = 400, bytes_of_third_axis = 64;
constexpr double bytes_per_neighbor = 4, bytes_per_weight = 4;
// The multigrid: vectors of the particles (65), windows (80), cells and levels (75); with a third axis larger stencils.
constexpr double bytes_of_multigrid = 220, bytes_of_multigrid_third_axis = 130;
// What a step that can be undone starts from: all fields once more, and where each particle is.
constexpr double bytes_of_undo = 75, bytes_of_undo_third_axis = 24;
// Fits of the scheme "high": coefficients, vectors of its solver, and another weight for each neighbour.
constexpr double bytes_of_fits = 200, bytes_of_fits_third_axis = 170;
constexpr double row_growth = 1.5;                           // rows grow ahead of need
constexpr double frame_bytes_h5 = 33, frame_bytes_vtp = 49;  // per particle, float32
constexpr double frame_bytes_third_axis = 8;                 // of position and velocity; VTP has three always

double largest_radius(const MpsCase& mps) {
  return std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
}

double memory_of(const Scene& scene, double particles) {
  const double radius = largest_radius(scene.mps);
  const double neighbors =
      scene.dimension == 2 ? std::numbers::pi * radius * radius : 4.0 / 3 * std::numbers::pi * radius * radius * radius;
  const bool high = scene.mps.scheme == "high";
  const double weights = (scene.mps.pressure.weights == "kept" ? 1 : 0) + (high ? 1 : 0);
  const double entry = bytes_per_neighbor + weights * bytes_per_weight;
  double fields = bytes_per_particle + (scene.dimension == 3 ? bytes_of_third_axis : 0);
  if (scene.mps.pressure.preconditioner == "multigrid")
    fields += bytes_of_multigrid + (scene.dimension == 3 ? bytes_of_multigrid_third_axis : 0);
  if (scene.mps.undo.halvings > 0) fields += bytes_of_undo + (scene.dimension == 3 ? bytes_of_undo_third_axis : 0);
  if (high) fields += bytes_of_fits + (scene.dimension == 3 ? bytes_of_fits_third_axis : 0);
  return particles * (fields + row_growth * neighbors * entry);
}

double disk_of(const Scene& scene, double particles, double frames) {
  const double real_scale = scene.output.precision == "float64" ? 2 : 1;
  const double vtp = scene.output.paraview.empty() ? 0 : frame_bytes_vtp;
  const double h5 = frame_bytes_h5 + (scene.dimension == 3 ? frame_bytes_third_axis : 0);
  return frames * particles * (h5 * real_scale + vtp);
}

/// By the lattice; in a ball, and of particles that are spread, by volume.
double particles_of(const Scene& scene) {
  if (scene.fluid.ball) {
    const double r = scene.fluid.ball->radius / scene.mps.spacing;
    return std::round(std::numbers::pi * (scene.dimension == 2 ? r * r : 4.0 / 3 * r * r * r));
  }
  if (scene.fluid.packing == "relaxed") {
    double cells = 1;
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.dimension); ++d)
      cells *= (scene.fluid.max[d] - scene.fluid.min[d]) / scene.mps.spacing;
    return std::round(cells);
  }
  const auto cells = lattice_cells(scene.fluid, scene.mps.spacing, scene.dimension);
  return cells[0] * cells[1] * cells[2];
}

/// Two figures, rounded down: a suggestion to type.
double rounded_down(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::floor(value / unit) * unit;
}

void warn_of_speed(const Scene& scene, Plan& plan) {
  const MpsCase& mps = scene.mps;
  if (plan.cfl <= mps.cfl_warn) return;
  const std::string cure =
      mps.adaptive ? fmt::format("mps.courant = {:.2g}", mps.cfl_warn)
                   : fmt::format("mps.time_step = {:.2g}", rounded_down(mps.time_step * mps.cfl_warn / plan.cfl));
  plan.warnings.push_back(
      fmt::format("cfl may reach {:.2f} at the front of a collapse (2 sqrt(g H) dt / spacing), cfl_warn is {:.2g} "
                  "-> {} keeps it",
                  plan.cfl, mps.cfl_warn, cure));
}

void warn_of_output(const Scene& scene, Plan& plan) {
  if (scene.output.every_time == 0 && scene.probes.empty()) {
    plan.warnings.emplace_back(
        "no frames and no probes: only history.csv will tell what happened -> output.every_time, [[probe]]");
  }
  if (scene.output.every_time > 0 && scene.output.every_time < scene.mps.time_step) {
    plan.warnings.emplace_back("output.every_time is shorter than mps.time_step: one frame per step");
  }
}

void warn_of_meshes(const Scene& scene, Plan& plan) {
  for (const MeshCase& mesh : scene.meshes)
    for (const std::string& repair : mesh.repairs)
      plan.warnings.push_back(fmt::format("mesh {}: {}", mesh.name, repair));
}

/// Shared by warnings about what lies in what.
bool within(const Point& x, const Corners& room, double slack, int dimension) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    if (x[d] < room.min[d] - slack || x[d] > room.max[d] + slack) return false;
  }
  return true;
}

void warn_of_motion(const Scene& scene, Plan& plan) {
  const double slack = scene.mps.spacing;
  const auto shapes = shapes_of(scene);
  for (const Shape& moving : shapes) {
    if (!moving.geometry->motion) continue;
    const std::string& name = moving.geometry->name;
    const auto step = longest_step(Motion(*moving.geometry->motion), scene.end, scene.mps.time_step, reach_of(moving));
    const double cfl = step.way / scene.mps.spacing;
    if (cfl > scene.mps.cfl_warn)
      plan.warnings.push_back(
          scene.mps.adaptive
              ? fmt::format("{} would move {:.2f} x spacing in the step at t = {:.4g} s: shorter steps will be taken",
                            name, cfl, step.time)
              : fmt::format(
                    "{} moves {:.2f} x spacing in the step at t = {:.4g} s, cfl_warn is {:.2g} -> mps.time_step", name,
                    cfl, step.time, scene.mps.cfl_warn));
    for (const Shape& inner : shapes) {
      const bool holds = within(inner.bounds.min, moving.bounds, slack, scene.dimension) &&
                         within(inner.bounds.max, moving.bounds, slack, scene.dimension);
      if (&inner != &moving && holds && !inner.geometry->motion)
        plan.warnings.push_back(fmt::format("{} moves and {} in it does not -> the same motion in [geometry.{}.motion]",
                                            name, inner.geometry->name, inner.geometry->name));
    }
  }
}

void warn_of_probes(const Scene& scene, Plan& plan) {
  const auto shapes = shapes_of(scene);
  if (shapes.empty()) return;
  Corners room{scene.fluid.min, scene.fluid.max};
  for (const Shape& shape : shapes) {
    for (std::size_t d = 0; d < 3; ++d) {
      room.min[d] = std::min(room.min[d], shape.bounds.min[d]);
      room.max[d] = std::max(room.max[d], shape.bounds.max[d]);
    }
  }
  for (const ProbeCase& probe : scene.probes) {
    Point at = room.min;
    if (probe.kind == "wall_pressure") at = probe.point;
    if (probe.kind == "surface_height") at[0] = probe.x;
    if (probe.kind == "surface_height" && probe.y) at[1] = *probe.y;
    if (!within(at, room, scene.mps.spacing, scene.dimension))
      plan.warnings.push_back(fmt::format("probe {} is outside of all walls and water", probe.name));
  }
}

Plan plan_of_structures(const Scene& scene) {
  // Element matrices of 24 x 24 numbers where no two elements are alike, forces, and a sparse matrix for the frequencies.
  constexpr double bytes_per_element = 20000;
  Plan plan;
  for (const StructureCase& structure : scene.structures)
    plan.memory += bytes_per_element * static_cast<double>(structure.mesh.elements.size());
  plan.steps = std::ceil(scene.end / scene.step * (1 - 1e-12));
  if (scene.output.every_time > 0) plan.frames = std::floor(scene.end / scene.output.every_time + 1e-9) + 1;
  return plan;
}

}  // namespace

double front_cfl(const Scene& scene) {
  const std::size_t up = static_cast<std::size_t>(scene.dimension) - 1;
  const Point& g = scene.gravity;
  const double height = scene.fluid.max[up] - scene.fluid.min[up];
  const double cfl = 2 * std::sqrt(std::hypot(g[0], g[1], g[2]) * height) * scene.mps.time_step / scene.mps.spacing;
  return scene.mps.adaptive ? std::min(cfl, scene.mps.courant) : cfl;
}

std::array<double, 3> lattice_cells(const FluidCase& fluid, double spacing, int dimension) {
  constexpr double round_off = 1e-6;  // of a cell: 0.4 / 0.001 is not quite 400
  std::array<double, 3> cells{1, 1, 1};
  for (std::size_t d = 0; d < static_cast<std::size_t>(dimension); ++d) {
    cells[d] = std::floor((fluid.max[d] - fluid.min[d]) / spacing + round_off);
  }
  return cells;
}

Plan plan_of(const Scene& scene) {
  if (!scene.has_fluid) return plan_of_structures(scene);
  Plan plan;
  plan.particles = particles_of(scene);
  plan.at_most = scene.fluid.packing == "relaxed";
  plan.steps = std::ceil(scene.end / step_at_rest(scene) * (1 - 1e-12));
  plan.at_least = scene.mps.adaptive;
  if (scene.output.every_time > 0) {
    plan.frames = std::floor(scene.end / scene.output.every_time + 1e-9) + 1;
    if (!plan.at_least) plan.frames = std::min(plan.frames, plan.steps + 1);
  }
  plan.memory = memory_of(scene, plan.particles);
  plan.disk = disk_of(scene, plan.particles, plan.frames);
  plan.cfl = front_cfl(scene);
  warn_of_meshes(scene, plan);
  warn_of_speed(scene, plan);
  warn_of_motion(scene, plan);
  warn_of_probes(scene, plan);
  warn_of_output(scene, plan);
  return plan;
}

void require_memory(const Plan& plan, double memory, const Scene& scene) {
  require<ResourceError>(scene.has_fluid || plan.memory <= memory, "the structures need about ", plan.memory / 1e9,
                         " GB of memory, this machine has ", memory / 1e9, " GB; take fewer divisions");
  if (!scene.has_fluid) return;
  constexpr double most_particles = std::numeric_limits<int>::max();
  const std::string cure = fmt::format("; take a larger mps.spacing than {:.6g} m", scene.mps.spacing);
  const Place& place = scene.mps.spacing_place;
  if (!(plan.memory <= memory)) {
    throw ResourceError(
        complaint(place, fmt::format("{:.0f} particles need about {:.3g} GB of memory, this machine has {:.3g} GB{}",
                                     plan.particles, plan.memory / 1e9, memory / 1e9, cure)));
  }
  if (plan.particles > most_particles) {
    throw ResourceError(complaint(place, fmt::format("{:.0f} particles are more than the program can number ({:.0f}){}",
                                                     plan.particles, most_particles, cure)));
  }
}

std::vector<std::string> plan_lines(const Plan& plan, const Scene& scene) {
  std::vector<std::string> lines{
      fmt::format("fluid     {}: {}{:.0f} particles, spacing {:.6g} m, dt {}{:.6g} s, cfl {:.2f} at the front",
                  scene.fluid.name, plan.at_most ? "at most " : "", plan.particles, scene.mps.spacing,
                  scene.mps.adaptive ? "up to " : "", step_at_rest(scene), plan.cfl),
      fmt::format("plan      {}{:.0f} steps, {:.0f} frames, {:.2g} GB disk, {:.2g} GB memory (estimates)",
                  plan.at_least ? "at least " : "", plan.steps, plan.frames, plan.disk / 1e9, plan.memory / 1e9)};
  for (const std::string& warning : plan.warnings) lines.push_back("warning   " + warning);
  return lines;
}

}  // namespace greenwater
