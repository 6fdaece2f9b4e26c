#include "app/recorder.hpp"

#include <algorithm>
#include <cmath>

#include "io/thermo.hpp"

namespace greenwater {
namespace {

/// What a probe of this kind measures: the head of its column.
std::string quantity_name(const std::string& kind) {
  if (kind == "wave_front") return "front";
  if (kind == "surface_height") return "height";
  if (kind == "wall_pressure") return "pressure";
  if (kind == "wall_force") return "force";
  return "count";
}

Precision precision_of(const OutputCase& output) {
  return output.precision == "float64" ? Precision::float64 : Precision::float32;
}

}  // namespace

bool Schedule::due(double time) {
  constexpr double round_off = 1e-9;  // of a period
  if (period_ <= 0) return true;
  if (time < next_ - round_off * period_) return false;
  next_ = period_ * (std::floor(time / period_ + round_off) + 1);
  return true;
}

FolderWish folder_wish(const RunOptions& options, const Scene& scene, WallTime now) {
  FolderWish wish;
  wish.by_user = options.output.has_value();
  wish.overwrite = options.overwrite;
  wish.path = wish.by_user ? *options.output
                           : folder_from_pattern(scene.output.directory, scene.name, now, scene.output.directory_place);
  check_folder(wish);
  return wish;
}

Recorder::Recorder(const RunOptions& options, const Scene& scene, const CaseFile& file, const RunOrigin& origin)
    : scene_(scene),
      origin_(origin),
      case_text_(file.text()),
      folder_(folder_wish(options, scene, origin.started)),
      history_(folder_.path() / "history.csv", history_header(scene.dimension)),
      frames_wanted_(!options.no_fields && scene.output.every_time > 0),
      paraview_wanted_(std::count(scene.output.paraview.begin(), scene.output.paraview.end(), "vtp") > 0),
      frame_schedule_(scene.output.every_time) {
  folder_.write("case.toml", file.text());
  folder_.write("case.resolved.toml", file.resolved());
  folder_.write("manifest.json", manifest_text(origin, {}));
}

void Recorder::open_probes(Simulation& simulation) {
  if (scene_.probes.empty()) return;
  make_folder(folder_.path() / "probes");
  for (std::size_t i = 0; i < scene_.probes.size(); ++i) {
    const ProbeCase& probe = scene_.probes[i];
    const std::string head = quantity_name(probe.kind) + '[' + simulation.probe_unit(i) + ']';
    probes_.push_back(
        {Csv(folder_.path() / "probes" / (probe.name + ".csv"), {"time[s]", head}), Schedule(probe.every_time), i});
  }
}

void Recorder::open_frames(Simulation& simulation) {
  if (!frames_wanted_) return;
  const auto origin = results_origin(origin_, case_text_);
  results_ = std::make_unique<Results>(folder_.path() / "results.h5", origin, precision_of(scene_.output));
  if (!paraview_wanted_) return;
  paraview_ = std::make_unique<Paraview>(folder_.path() / "paraview", scene_.fluid.name);
  if (simulation.walls_move()) {
    moving_walls_ = std::make_unique<Paraview>(folder_.path() / "paraview", "walls");
  } else {
    write_walls(folder_.path() / "paraview" / "walls.vtp", simulation.wall_shapes());
  }
}

void Recorder::history(const StepFacts& facts, double ms_per_step) { history_.row(history_row(facts, ms_per_step)); }

void Recorder::sample(Simulation& simulation) {
  if (!opened_) {
    opened_ = true;
    open_probes(simulation);
    open_frames(simulation);
  }
  const double time = simulation.time();
  for (Probe& probe : probes_) {
    if (probe.schedule.due(time)) probe.file.row({time, simulation.sample(probe.index)});
  }
  if (results_ && frame_schedule_.due(time)) frame(simulation);
}

void Recorder::frame(Simulation& simulation) {
  const Table table = simulation.fluid_table();
  const std::vector<WallShape> moving = simulation.walls_move() ? simulation.wall_shapes() : std::vector<WallShape>();
  results_->write(table, moving);
  if (paraview_) paraview_->write(table);
  if (moving_walls_) moving_walls_->write(table.time, moving);
  last_frame_step_ = simulation.steps();
}

void Recorder::last_frame(Simulation& simulation) {
  if (results_ && last_frame_step_ != simulation.steps()) frame(simulation);
}

void Recorder::finish(const RunEnd& end, Marker marker) {
  history_.close();
  for (Probe& probe : probes_) probe.file.close();
  folder_.write("manifest.json", manifest_text(origin_, end));
  folder_.mark(marker);
}

}  // namespace greenwater
