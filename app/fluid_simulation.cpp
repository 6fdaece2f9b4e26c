#include "app/fluid_simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/plan.hpp"
#include "core/check.hpp"
#include "io/thermo.hpp"

namespace greenwater {
namespace {

int body_of(const WallFaces& walls, const std::string& name) {
  const auto found =
      std::find_if(walls.bodies.begin(), walls.bodies.end(), [&](const auto& b) { return b.name == name; });
  expect(found != walls.bodies.end());
  return static_cast<int>(found - walls.bodies.begin());
}

Reading reading_of(const ProbeCase& probe) { return probe.reading == "average" ? Reading::average : Reading::neumann; }

// "The lowest number there is" of a maximum over nothing.
double or_nothing(double value) { return value < -1e300 ? std::numeric_limits<double>::quiet_NaN() : value; }

template <class Value, class Field>
Column scalar_column(const std::string& name, const std::string& unit, const Field& field, int count) {
  const auto host = Kokkos::create_mirror_view(field);
  Kokkos::deep_copy(host, field);
  std::vector<Value> values(count);
  for (int i = 0; i < count; ++i) values[i] = static_cast<Value>(host(i));
  return {name, unit, 1, std::move(values)};
}

template <class Field>
Column vector_column(const std::string& name, const std::string& unit, const Field& field, int count) {
  const auto host = Kokkos::create_mirror_view(field);
  Kokkos::deep_copy(host, field);
  const int dim = static_cast<int>(field.extent(1));
  std::vector<double> values(static_cast<std::size_t>(count) * dim);
  for (int i = 0; i < count; ++i)
    for (int d = 0; d < dim; ++d) values[static_cast<std::size_t>(i) * dim + d] = host(i, d);
  return {name, unit, dim, std::move(values)};
}

std::string packing_line(const Packing& packing) {
  return fmt::format(
      "packing   {} sweeps; n is off by {:.2f} % rms and {:.2f} % at most, before by {:.3g} % and {:.3g} %",
      packing.sweeps, 100 * packing.after.rms, 100 * packing.after.most, 100 * packing.before.rms,
      100 * packing.before.most);
}

std::string effects_text(const Effects& effects) {
  std::string text;
  for (const Stage stage : {Stage::force, Stage::walls, Stage::after_move}) {
    for (const auto& effect : effects.at(stage)) text += (text.empty() ? "" : ", ") + std::string(effect->name());
  }
  return text.empty() ? "none" : text;
}

}  // namespace

FluidSimulation::FluidSimulation(const Scene& scene)
    : scene_(scene),
      structures_(build_structures(scene)),
      walls_at_start_(build_walls(scene)),
      coupler_(
          build_coupler(scene, structures_, add_wet_surfaces(scene, structures_, walls_at_start_), walls_at_start_)),
      fluid_(build_fluid(scene, walls_at_start_, &packing_)),
      effects_(build_effects(scene, fluid_)),
      scheme_(build_scheme(scene, fluid_)),
      step_length_(scene, structures_.empty() ? 0 : structures_.front().march_options().step),
      dt_(step_length_.next(fluid_, std::numeric_limits<double>::infinity())) {
  for (const ProbeCase& probe : scene_.probes) {
    const bool of_pressure = probe.kind == "wall_pressure";
    pressure_points_.push_back(of_pressure ? pressure_point(scene_, fluid_.faces, probe) : probe.point);
    reactions_.push_back(probe.reading == "reaction" ? scheme_->watch(body_of(fluid_.faces, probe.wall)) : -1);
    probe_motions_.push_back(of_pressure ? motion_of(scene_, fluid_.faces, probe) : nullptr);
  }
  // Potential energy is counted from the lowest corner along gravity, so that it is positive inside the scene.
  const Extent extent = scene_extent(scene_, fluid_.faces);
  for (int d = 0; d < 3; ++d) potential_zero_[d] = scene_.gravity[d] > 0 ? extent.high[d] : extent.low[d];
  at_start_ = fluid_.particles.count;
  first_energy_ = fluid_sums(fluid_, potential_zero_).energy();
  if (scene_.mps.undo.halvings > 0)
    guard_ = std::make_unique<StepGuard>(scene_, walls_move(), potential_zero_, first_energy_);
}

void FluidSimulation::step() { step_of(steps_ > 0 ? step_length_.next(fluid_, dt_) : dt_); }

void FluidSimulation::step_of(double dt) {
  Region region("step");
  if (!guard_) return take(dt);
  guard_->keep(fluid_, coupler_);
  const std::int64_t steps = steps_;
  Tries tries{0, dt, 0};
  for (;;) {
    try {
      return take(dt);
    } catch (const NumericsError& fault) {
      guard_->put_back(fluid_, coupler_);
      steps_ = steps;
      dt = shorter(dt, tries, fault.what());
    }
    settle_rows(fluid_);
  }
}

void FluidSimulation::take(double dt) {
  if (coupler_.any() && (steps_ + 1) % scene_.output.history_every_steps == 0) coupler_.ask_for_added_mass();
  StepReport report = scheme_->step(fluid_, effects_, coupler_, static_cast<real>(dt));
  if (guard_) guard_->check(fluid_, report);
  ++steps_;
  if (dt != step_length_.at_rest()) step_length_.let_differ();
  fluid_.time = time_after(dt);
  refuse(report);
  dt_ = dt;
  look_after(report);
  last_ = std::move(report);
}

/// The next try after one of `dt` that has failed [s].
double FluidSimulation::shorter(double dt, Tries& tries, const std::string& fault) {
  if (tries.failed++ == 0) tries.least = step_length_.allowed(fluid_) * std::exp2(-scene_.mps.undo.halvings);
  const double half = step_length_.half(dt);
  require<NumericsError>(
      half < dt && half >= tries.least, "step ", steps_ + 1, ", t = ", time(), " s: ", fault, "; tried ", tries.failed,
      " time(s), with ", tries.first, " s down to ", dt,
      " s, and undone each time: a shorter step does not mend it -> a smaller mps.spacing, or look at "
      "the last frame for what the flow does there");
  notices_.push_back({"undone",
                      text_of("t = ", time(), " s: ", fault, "; the step of ", dt,
                              " s was undone and is tried again with ", half, " s"),
                      1, true});
  return half;
}

/// Multiples where all steps are one, else sums; the end is then met exactly.
double FluidSimulation::time_after(double dt) const {
  return step_length_.differ() ? step_length_.end_of(time(), dt) : static_cast<accum>(steps_) * dt;
}

/// Throws when the step cannot stay as it is.
void FluidSimulation::refuse(const StepReport& report) const {
  require<NumericsError>(report.departed.not_a_number == 0, "step ", steps_, ", t = ", time(),
                         " s: ", report.departed.not_a_number,
                         " positions are not a number any more; a smaller mps.time_step may help");
  if (report.solve.converged || stalls_are_borne(report)) return;
  throw NumericsError(
      text_of(stall_text(report), "; a smaller mps.time_step, or mps.pressure.max_iterations larger, may help"));
}

bool FluidSimulation::stalls_are_borne(const StepReport& report) const {
  return scene_.mps.pressure.on_stall == "warn" && std::isfinite(report.solve.residual);
}

std::string FluidSimulation::stall_text(const StepReport& report) const {
  return text_of("pressure solve at step ", steps_, ", t = ", time(), " s: ", report.solve.cause, " after ",
                 report.solve.iterations, " iterations, relative residual ", report.solve.residual);
}

void FluidSimulation::look_after(const StepReport& report) {
  const std::int64_t lost_now = lost() - told_lost_;
  told_lost_ = lost();
  if (report.stopped > 0)
    note("crossing", text_of(report.stopped, " particles were stopped on their way through a wall"), report.stopped);
  if (lost_now > 0)
    note("lost",
         text_of("particles left the domain and were retired; so far ", lost(), " with ",
                 static_cast<double>(lost()) * fluid_.rho * std::pow(fluid_.spacing, scene_.dimension),
                 scene_.dimension == 2 ? " kg/m" : " kg"),
         lost_now);
  look_after_coupling();
  if (!report.solve.converged) return note("stall", stall_text(report), 1);
  if (!report.solve.recovery.empty())
    note("recovery",
         text_of("the pressure solve failed (", report.solve.cause, ") and went on with ", report.solve.recovery), 1);
}

void FluidSimulation::look_after_coupling() {
  if (coupler_.disagreed())
    note("disagreement",
         text_of("structures and the walls that the fluid saw differ by more than coupling.tolerance after ",
                 coupler_.passes(), " passes -> a shorter mps.time_step, or coupling.max_iterations larger"),
         1);
  if (const std::string alarm = coupler_.alarm(); !alarm.empty()) note("alternation", alarm, 1);
}

void FluidSimulation::note(const std::string& kind, const std::string& text, std::int64_t count) {
  const auto same = std::find_if(notices_.begin(), notices_.end(), [&](const Notice& n) { return n.kind == kind; });
  if (same == notices_.end())
    notices_.push_back({kind, text, count});
  else
    same->count += count;
}

StepFacts FluidSimulation::facts() {
  const FluidSums sums = fluid_sums(fluid_, potential_zero_);
  StepFacts facts;
  facts.step = steps_;
  facts.time = time();
  facts.dt = dt();
  facts.iterations = last_.solve.iterations;
  facts.residual = last_.solve.residual;
  facts.max_speed = sums.max_speed;
  facts.cfl = sums.max_speed * dt() / scene_.mps.spacing;
  facts.kinetic_energy = sums.kinetic;
  facts.potential_energy = sums.potential;
  facts.energy_ratio = first_energy_ > 0 ? sums.energy() / first_energy_ : 1;
  facts.density_error = sums.density_error;
  facts.particles = fluid_.particles.count;
  facts.lost = lost();
  if (facts.cfl > scene_.mps.cfl_warn)
    note("cfl", text_of("max speed x dt / spacing = ", facts.cfl, " is above mps.cfl_warn = ", scene_.mps.cfl_warn), 1);
  facts.notices = std::exchange(notices_, {});
  return facts;
}

double FluidSimulation::sample(std::size_t index) {
  const ProbeCase& probe = scene_.probes[index];
  if (is_of_structure(probe)) return sample_structure(probe);
  if (probe.kind == "wave_front") return or_nothing(wave_front(fluid_));
  if (probe.kind == "surface_height") return or_nothing(surface_height(fluid_, probe.x, probe.y));
  if (probe.kind == "wall_pressure") {
    const Point& start = pressure_points_[index];
    const Point now = probe_motions_[index] ? probe_motions_[index]->at(start, time()) : start;
    return sampler_.pressure(fluid_, {now}, reading_of(probe)).front();
  }
  if (probe.kind == "wall_force") {
    const std::size_t axis = probe.component.front() - 'x';
    if (reactions_[index] >= 0) return steps_ > 0 ? last_.reactions[reactions_[index]][axis] : 0;
    const auto patches = wall_patches(fluid_.faces, body_of(fluid_.faces, probe.wall), fluid_.spacing);
    return wall_force(sampler_, fluid_, patches, reading_of(probe))[axis];
  }
  expect(probe.kind == "particle_count");
  if (probe.min == probe.max) return static_cast<double>(fluid_.particles.count);
  return static_cast<double>(particle_count(fluid_, probe.min, probe.max));
}

double FluidSimulation::sample_structure(const ProbeCase& probe) {
  if (probe.kind != "structure_pressure" && probe.kind != "structure_force")
    return structures_[probe.structure].sample(probe);
  const WetSurface& surface = coupler_.body(probe.structure).surface;
  const Eigen::VectorXd& loads = coupler_.loads(probe.structure);
  if (probe.kind == "structure_pressure") return pressure_difference(surface, loads, band_of(scene_, probe));
  double force = 0;
  for (Eigen::Index i = probe.component.front() - 'x'; i < loads.size(); i += scene_.dimension) force += loads[i];
  return force;
}

ProbeHead FluidSimulation::probe_head(std::size_t index) const {
  const std::string& kind = scene_.probes[index].kind;
  if (kind == "structure_pressure") return {"pressure_difference", "Pa"};
  if (kind == "structure_force")
    return {"force_" + scene_.probes[index].component, scene_.dimension == 2 ? "N/m" : "N"};
  if (is_of_structure(scene_.probes[index])) return structure_probe_head(scene_.probes[index]);
  if (kind == "wave_front") return {"front", "m"};
  if (kind == "surface_height") return {"height", "m"};
  if (kind == "wall_pressure") return {"pressure", "Pa"};
  if (kind == "wall_force") return {"force", scene_.dimension == 2 ? "N/m" : "N"};
  return {"count", "-"};
}

Table FluidSimulation::fluid_table() const {
  const Particles& p = fluid_.particles;
  Table table{scene_.fluid.name, time(), steps_, static_cast<std::size_t>(p.count), {}};
  table.columns.push_back(scalar_column<std::int64_t>("id", "-", p.id, p.count));
  table.columns.push_back(vector_column("position", "m", p.position, p.count));
  table.columns.push_back(vector_column("velocity", "m/s", p.velocity, p.count));
  table.columns.push_back(scalar_column<double>("pressure", "Pa", p.pressure, p.count));
  table.columns.push_back(scalar_column<double>("number_density", "-", p.number_density, p.count));
  table.columns.push_back(scalar_column<std::uint8_t>("surface", "-", p.surface, p.count));
  return table;
}

std::vector<std::string> FluidSimulation::plan() const {
  Plan plan = plan_of(scene_);
  plan.particles = fluid_.particles.count;  // the arithmetic of the plan knows no plates and no slanting walls
  plan.at_most = false;
  std::vector<std::string> lines = plan_lines(plan, scene_);
  if (scene_.fluid.packing == "relaxed") lines.push_back(packing_line(packing_));
  lines.push_back(text_of("walls     ", fluid_.walls.panels, fluid_.faces.dim == 2 ? " straight" : " plane",
                          " panels, ", fluid_.walls.count - fluid_.walls.panels, " reflections in corners"));
  lines.push_back("effects   " + effects_text(effects_));
  for (const Structure& structure : structures_)
    for (const std::string& line : structure.plan()) lines.push_back(line);
  for (const std::string& line : coupling_lines(scene_)) lines.push_back(line);
  return lines;
}

std::vector<WallShape> FluidSimulation::wall_shapes() const {
  std::vector<WallShape> shapes;
  for (const WallFace& face : fluid_.faces.faces) {
    if (face.repeated) continue;
    shapes.emplace_back();
    for (int e = 0; e < fluid_.faces.dim; ++e) shapes.back().push_back(face.corner[e].position);
  }
  return shapes;
}

Picture FluidSimulation::picture() const {
  Picture picture{{fluid_table()}, wall_shapes(), walls_move(), {}};
  for (const Structure& structure : structures_) picture.solids.push_back(structure.picture());
  return picture;
}

std::vector<std::string> FluidSimulation::history_header() const {
  std::vector<std::string> header = greenwater::history_header(scene_.dimension);
  if (!structures_.empty()) header.emplace_back("passes");
  for (const Structure& structure : structures_)
    for (const char* column : {"work_by_fluid_%[J]", "work_received_%[J]", "impulse_x_%[N s]", "impulse_y_%[N s]",
                               "impulse_z_%[N s]", "balance_%[J]", "added_mass_%[-]"}) {
      std::string name = column;
      header.push_back(name.replace(name.find('%'), 1, structure.given().name));
    }
  return header;
}

/// What crosses the interfaces, and what the structures make of it, for the ledger in history.csv.
void FluidSimulation::add_ledger(std::vector<double>& row) const {
  if (!structures_.empty()) row.push_back(coupler_.passes());
  for (std::size_t k = 0; k < structures_.size(); ++k) {
    const InterfaceLedger::Sums& sums = coupler_.ledger(k).sums();
    for (const double value : {sums.by_fluid, sums.by_structure, sums.impulse[0], sums.impulse[1], sums.impulse[2],
                               structures_[k].march().energies().balance(), coupler_.added_mass_ratio(k)})
      row.push_back(value);
  }
}

std::string FluidSimulation::thermo_header() const { return greenwater::thermo_header(); }

RunFacts FluidSimulation::run_facts() {
  StepFacts now = facts();
  RunFacts told;
  told.step = now.step;
  told.time = now.time;
  told.finite = std::isfinite(now.max_speed) && std::isfinite(now.kinetic_energy);
  told.work = static_cast<double>(now.particles);
  told.history = history_row(now);
  add_ledger(told.history);
  told.thermo = thermo_line(now);
  told.notices = std::move(now.notices);
  return told;
}

}  // namespace greenwater
