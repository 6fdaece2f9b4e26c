// The whole step, region by region. A stretch of steps is run once to be looked at (launches, iterations, rows, memory)
// and then, from the same state each time, to be timed: all rounds do the same work.

#include <fmt/format.h>

#include <map>
#include <set>

#include "bench/bytes.hpp"
#include "bench/measure.hpp"
#include "bench/water.hpp"
#include "core/kokkos.hpp"
#include "core/listener.hpp"

namespace greenwater::bench {
namespace {

/// What the round that is looked at tells of one step, in the mean.
struct Overview {
  Counts counts;
  double launches = 0, memory = 0;  // memory [bytes] as views hold it
  std::map<std::string, double> launches_by_label;
  std::vector<double> iterations;  // of each step
  int recoveries = 0;              // solves that needed help
};

using Samples = std::map<std::string, std::vector<double>>;  // region -> [ms]

std::vector<std::string> sets_of(const BenchOptions& options) {
  const double tolerance = options.tolerances.empty() ? 1e-4 : options.tolerances.front();
  std::vector<std::string> sets{fmt::format("mps.pressure.tolerance={}", tolerance)};
  sets.insert(sets.end(), options.sets.begin(), options.sets.end());
  return sets;
}

void add_rows(const Fluid& fluid, double part, Counts& counts) {
  counts.dim = fluid.particles.dim;
  counts.cells = fluid.grid.shape().count();
  counts.walls = fluid.walls.count > 0;
  counts.keep_weights = fluid.keep_weights;
  counts.particles += part * fluid.particles.count;
  counts.entries += part * static_cast<double>(fluid.rows.near.entries);
  counts.places += part * static_cast<double>(fluid.rows.near.stored);
  counts.image_entries += part * static_cast<double>(fluid.rows.images.entries);
  counts.image_places += part * static_cast<double>(fluid.rows.images.stored);
}

void add_nodes(const GridNodes& nodes, Counts& counts) {
  counts.first_nodes = nodes.first;
  counts.nodes = nodes.all;
}

Overview look(Water& water, Listener& listener, int steps) {
  Overview overview;
  const double part = 1.0 / steps;
  listener.forget_launches();
  for (int k = 0; k < steps; ++k) {
    const StepReport report = water.step();
    overview.iterations.push_back(report.solve.iterations);
    overview.counts.iterations += part * report.solve.iterations;
    overview.recoveries += report.solve.recovery.empty() ? 0 : 1;
    add_rows(water.fluid(), part, overview.counts);
  }
  overview.launches = part * static_cast<double>(listener.launches());
  overview.memory = static_cast<double>(listener.bytes());
  for (const auto& [label, number] : listener.launches_by_label())
    overview.launches_by_label[label] = part * static_cast<double>(number);
  overview.counts.collision_finds = part * static_cast<double>(listener.launches("greenwater::collision_find_close"));
  overview.counts.collision_looks = part * static_cast<double>(listener.launches("greenwater::count_collisions"));
  overview.counts.collision_moves = part * static_cast<double>(listener.launches("greenwater::collision"));
  return overview;
}

void time_round(Water& water, int steps, Samples& samples) {
  for (int k = 0; k < steps; ++k) {
    reset_region_times();
    water.step();
    for (const RegionTime& region : region_times()) samples[region.name].push_back(1e3 * region.seconds);
  }
}

/// The rows, built in one pass on a host and as on a GPU.
struct BothWays {
  std::vector<double> one_pass, portable;  // [ms]
};

void time_both_ways(Water& water, BothWays& rows) {
  water.sort();
  for (int k = 0; k < 3; ++k) {
    rows.one_pass.push_back(ms_of([&] { water.build_rows(false); }));
    rows.portable.push_back(ms_of([&] { water.build_rows(true); }));
  }
}

const RegionModel& model_of(const std::string& region) {
  static const RegionModel unknown{"", "step", nullptr};
  for (const RegionModel& model : region_models())
    if (model.name == region) return model;
  return unknown;
}

// What of each step is in no region of its own.
std::vector<double> others(const Samples& samples) {
  std::vector<double> rest = samples.at("step");
  for (const auto& [region, ms] : samples)
    if (model_of(region).inside == "step")
      for (std::size_t k = 0; k < ms.size(); ++k) rest[k] -= ms[k];
  return rest;
}

/// The known regions in the order of the step, then those that are not, then the rest.
std::vector<std::string> order_of(const Samples& samples) {
  std::vector<std::string> order;
  for (const RegionModel& model : region_models())
    if (samples.count(model.name)) order.push_back(model.name);
  for (const auto& [region, ms] : samples)
    if (model_of(region).name.empty() && region != "other") order.push_back(region);
  order.push_back("other");
  return order;
}

// Of the step itself: the sum of its parts.
Traffic traffic_of(const std::string& region, const Counts& counts) {
  if (region != "step") {
    const auto traffic = model_of(region).traffic;
    return traffic ? traffic(counts) : Traffic{};
  }
  Traffic sum;
  for (const RegionModel& model : region_models()) {
    if (model.inside != "step" || !model.traffic) continue;
    const Traffic part = model.traffic(counts);
    sum.moved += part.moved;
    sum.touched = std::max(sum.touched, part.touched);
  }
  return sum;
}

// One for each size of working set.
void measure_triads(const Counts& counts, Triads& triads) {
  std::set<double> sizes;
  for (const RegionModel& model : region_models())
    if (model.traffic) sizes.insert(Triads::size_of(model.traffic(counts).touched));
  for (const double bytes : sizes) triads.measure(bytes);
}

Json region_row(const Json& base, const std::string& region, const Spread& ms, const Overview& overview,
                Triads& triads) {
  Json row = base;
  row["region"] = region;
  row["inside"] = model_of(region).inside;
  add_spread(row, ms);
  const double particles = overview.counts.particles;
  row["ns_per_particle"] = 1e6 * ms.median / particles;
  const Traffic traffic = traffic_of(region, overview.counts);
  if (traffic.moved <= 0) return row;
  const double rate = 1e-6 * traffic.moved / ms.median, yardstick = triads.at(traffic.touched).median;
  row["bytes"] = traffic.moved;
  row["bytes_per_particle"] = traffic.moved / particles;
  row["working_set"] = traffic.touched;
  row["gb_per_s"] = rate;
  row["triad_gb_per_s"] = yardstick;
  row["share"] = rate / yardstick;
  return row;
}

void add_overview(Json& row, const Scene& scene, const Overview& overview) {
  const Spread iterations = spread_of(overview.iterations);
  row["tolerance"] = scene.mps.pressure.tolerance;
  row["preconditioner"] = scene.mps.pressure.preconditioner;
  row["weights"] = scene.mps.pressure.weights;
  row["dt"] = scene.mps.time_step;
  row["iterations"] = iterations.median;
  row["iterations_min"] = iterations.low;
  row["iterations_max"] = iterations.high;
  row["recoveries"] = overview.recoveries;
  row["launches"] = overview.launches;
  row["memory"] = overview.memory;
  row["memory_per_particle"] = overview.memory / overview.counts.particles;
  row["entries_per_particle"] = overview.counts.entries / overview.counts.particles;
  row["image_entries_per_particle"] = overview.counts.image_entries / overview.counts.particles;
  row["launches_by_label"] = overview.launches_by_label;
}

std::string cell(const Json& row, const char* key, double factor = 1) {
  return row.contains(key) ? figure(factor * row[key].get<double>()) : "-";
}

void print_row(const Json& row) {
  fmt::print("  {:<12}{:>9}{:>20}{:>9}{:>11}{:>9}{:>9}{:>8}\n", row["region"].get<std::string>(), cell(row, "ms"),
             cell(row, "ms_min") + " - " + cell(row, "ms_max"), cell(row, "ns_per_particle"),
             cell(row, "bytes_per_particle"), cell(row, "gb_per_s"), cell(row, "triad_gb_per_s"),
             row.contains("share") ? fmt::format("{:.0f} %", 100 * row["share"].get<double>()) : "-");
}

void print_head(const Json& step) {
  fmt::print(
      "\n{} particles, {}-D, {}: {} iterations ({} to {}), {} launches a step, {} bytes of memory per particle\n",
      step["particles"].get<int>(), step["dim"].get<int>(), step["state"].get<std::string>(), cell(step, "iterations"),
      cell(step, "iterations_min"), cell(step, "iterations_max"), cell(step, "launches"),
      cell(step, "memory_per_particle"));
  fmt::print("  {:<12}{:>9}{:>20}{:>9}{:>11}{:>9}{:>9}{:>8}\n", "region", "ms", "min - max", "ns/part.", "byte/part.",
             "GB/s", "triad", "share");
}

void measure(const BenchOptions& options, const Size& size, const std::string& name, Triads& triads, Json& rows) {
  const State state = state_at(state_folder(options.cache), size, name);
  const Scene scene = bench_scene(size, sets_of(options));
  Overview overview;
  Samples samples;
  BothWays both;
  {
    auto listener = std::make_unique<Listener>();
    Water water(scene, state);
    overview = look(water, *listener, options.steps);
    listener.reset();  // who is timed is not listened to
    overview.counts.multigrid = scene.mps.pressure.preconditioner == "multigrid";
    if (overview.counts.multigrid) add_nodes(nodes_in_use(water.fluid()), overview.counts);
    for (int round = 0; round < options.rounds; ++round) {
      water.put(state);
      time_round(water, options.steps, samples);
      if (on_host) time_both_ways(water, both);
      measure_triads(overview.counts, triads);
    }
  }
  samples["other"] = others(samples);
  Json base = row_of(size, state.particles(), name);
  base["threads"] = Runtime::concurrency();
  for (const std::string& region : order_of(samples)) {
    Json row = region_row(base, region, spread_of(samples.at(region)), overview, triads);
    if (region == "step") {
      add_overview(row, scene, overview);
      row["rows_one_pass_ms"] = spread_of(both.one_pass).median;
      row["rows_portable_ms"] = spread_of(both.portable).median;
      print_head(row);
    }
    print_row(row);
    rows.push_back(row);
  }
  if (on_host)
    fmt::print("  rows, in turn: in one pass {} ms, as on a GPU {} ms\n", figure(spread_of(both.one_pass).median),
               figure(spread_of(both.portable).median));
  std::fflush(stdout);
}

}  // namespace

Json bench_step(const BenchOptions& options) {
  Triads triads;
  Json rows = Json::array();
  const auto sizes = options.sizes.empty() ? usual_sizes(options.dimension, false) : options.sizes;
  const auto states = options.states.empty() ? std::vector<std::string>{"collapse"} : options.states;
  for (const int particles : sizes)
    for (const std::string& state : states)
      measure(options, size_near(options.dimension, particles), state, triads, rows);
  Json all = results("step", origin(options, Runtime::concurrency(), Runtime::space_name()));
  all["triad"] = triad_list(triads);
  all["rows"] = rows;
  return all;
}

}  // namespace greenwater::bench
