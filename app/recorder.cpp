#include "app/recorder.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

Precision precision_of(const OutputCase& output) {
  return output.precision == "float64" ? Precision::float64 : Precision::float32;
}

template <std::size_t N>
Column column_of(const std::string& name, const std::string& unit, const std::vector<std::array<double, N>>& rows) {
  std::vector<double> values;
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return {name, unit, static_cast<int>(N), std::move(values)};
}

Table nodes_table(const SolidPicture& solid) {
  auto position = solid.mesh->nodes;
  for (std::size_t i = 0; i < position.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) position[i][d] += solid.frame.displacement[i][d];
  Table table{solid.name, solid.frame.time, 0, position.size(), {}};
  table.columns = {column_of("position", "m", position), column_of("displacement", "m", solid.frame.displacement),
                   column_of("velocity", "m/s", solid.frame.velocity)};
  return table;
}

Table elements_table(const SolidPicture& solid) {
  std::vector<std::int64_t> nodes;
  const int corners = solid.mesh->nodes_per_element();
  for (const auto& element : solid.mesh->elements)
    nodes.insert(nodes.end(), element.begin(), element.begin() + corners);
  Table table{solid.name + "_elements", solid.frame.time, 0, solid.mesh->elements.size(), {}};
  table.columns = {{"nodes", "-", corners, std::move(nodes)}, column_of("stress", "Pa", solid.frame.stress)};
  return table;
}

std::vector<std::string> with_pace(std::vector<std::string> header) {
  header.emplace_back("ms_per_step");
  return header;
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

Recorder::Recorder(const RunOptions& options, const Scene& scene, const CaseFile& file, const RunOrigin& origin,
                   const Simulation& simulation)
    : scene_(scene),
      origin_(origin),
      case_text_(file.text()),
      folder_(folder_wish(options, scene, origin.started)),
      history_(folder_.path() / "history.csv", with_pace(simulation.history_header())),
      frames_wanted_(!options.no_fields && scene.output.every_time > 0),
      paraview_wanted_(std::count(scene.output.paraview.begin(), scene.output.paraview.end(), "vtp") > 0),
      frame_schedule_(scene.output.every_time) {
  folder_.write("case.toml", file.text());
  folder_.write("case.resolved.toml", file.resolved());
  folder_.write("manifest.json", manifest_text(origin, {}));
}

void Recorder::open_probes(const Simulation& simulation) {
  if (scene_.probes.empty()) return;
  make_folder(folder_.path() / "probes");
  for (std::size_t i = 0; i < scene_.probes.size(); ++i) {
    const ProbeCase& probe = scene_.probes[i];
    const auto [quantity, unit] = simulation.probe_head(i);
    const std::string head = quantity + '[' + unit + ']';
    probes_.push_back(
        {Csv(folder_.path() / "probes" / (probe.name + ".csv"), {"time[s]", head}), Schedule(probe.every_time), i});
  }
}

void Recorder::open_frames(const Simulation& simulation) {
  if (!frames_wanted_) return;
  const auto origin = results_origin(origin_, case_text_);
  results_ = std::make_unique<Results>(folder_.path() / "results.h5", origin, precision_of(scene_.output));
  if (paraview_wanted_) open_paraview(simulation.picture());
}

void Recorder::open_paraview(const Picture& first) {
  const auto folder = folder_.path() / "paraview";
  for (const Table& fluid : first.fluids) paraview_ = std::make_unique<Paraview>(folder, fluid.name);
  for (const SolidPicture& solid : first.solids) solids_.emplace_back(folder, solid.name);
  if (first.walls.empty()) return;
  if (first.walls_move)
    moving_walls_ = std::make_unique<Paraview>(folder, "walls");
  else
    write_walls(folder / "walls.vtp", first.walls);
}

void Recorder::history(const RunFacts& facts, double ms_per_step) {
  std::vector<double> row = facts.history;
  row.push_back(ms_per_step);
  history_.row(row);
}

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

void Recorder::frame(const Simulation& simulation) {
  const Picture picture = simulation.picture();
  const double time = simulation.time();
  const Table nothing{scene_.name, time, simulation.steps(), 0, {}};
  std::vector<Table> solids;
  for (const SolidPicture& solid : picture.solids) {
    solids.push_back(nodes_table(solid));
    solids.push_back(elements_table(solid));
  }
  results_->write(picture.fluids.empty() ? nothing : picture.fluids.front(),
                  picture.walls_move ? picture.walls : std::vector<WallShape>(), std::move(solids));
  if (paraview_) paraview_->write(picture.fluids.front());
  if (moving_walls_) moving_walls_->write(time, picture.walls);
  for (std::size_t i = 0; i < solids_.size(); ++i) solids_[i].write(*picture.solids[i].mesh, picture.solids[i].frame);
  last_frame_step_ = simulation.steps();
}

void Recorder::last_frame(const Simulation& simulation) {
  if (results_ && last_frame_step_ != simulation.steps()) frame(simulation);
}

void Recorder::finish(const RunEnd& end, Marker marker) {
  history_.close();
  for (Probe& probe : probes_) probe.file.close();
  folder_.write("manifest.json", manifest_text(origin_, end));
  folder_.mark(marker);
}

}  // namespace greenwater
