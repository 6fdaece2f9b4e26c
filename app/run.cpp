#include "app/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <new>

#include "app/failure.hpp"
#include "app/plan.hpp"
#include "app/recorder.hpp"
#include "app/stop_signals.hpp"
#include "core/build_facts.hpp"
#include "core/kokkos.hpp"
#include "core/region.hpp"
#include "io/status.hpp"
#include "io/summary.hpp"
#include "io/thermo.hpp"

namespace greenwater {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

RunOrigin origin_of(const RunOptions& options, const Scene& scene, const CaseFile& file) {
  return {scene.name,
          file.name(),
          file.options(),
          options.command_line,
          Runtime::space_name(),
          Runtime::concurrency(),
          std::chrono::system_clock::now()};
}

/// No work for a folder that is taken: complains before the particles are made.
const Scene& with_free_folder(const RunOptions& options, const Scene& scene, WallTime now) {
  folder_wish(options, scene, now);
  return scene;
}

class Run {
 public:
  Run(const RunOptions& options, const Scene& scene, const CaseFile& file)
      : options_(options),
        scene_(scene),
        origin_(origin_of(options, scene, file)),
        plan_(plan_of(scene)),
        log_({options.verbosity, options.color}),
        eta_(total_steps()),
        simulation_(make_simulation(with_free_folder(options, scene, origin_.started))),
        recorder_(options, scene, file, origin_, *simulation_),
        status_(recorder_.folder().path() / "status.json") {}

  int go();

 private:
  double total_steps() const;
  Progress progress() const;
  bool at_end() const;
  void say_header();
  void loop();
  void one_step();
  void report(const RunFacts& facts);
  void say_summary();
  RunEnd end_of(int code, const std::string& outcome, const std::string& message = {}) const;
  int finish(const RunEnd& end, Marker marker, const char* state);
  int fail(const Failure& failure);

  const RunOptions& options_;
  const Scene& scene_;
  RunOrigin origin_;
  Plan plan_;
  Log log_;
  Eta eta_;
  StopSignals signals_;
  std::unique_ptr<Simulation> simulation_;
  Recorder recorder_;
  StatusFile status_;
  Clock::time_point start_ = Clock::now();
  double output_seconds_ = 0, work_ = 0;
  double reported_seconds_ = 0;  // loop time at the last report
  std::int64_t reported_step_ = 0;
  double work_per_step_ = 0;
};

double Run::total_steps() const {
  if (options_.max_steps == 0) return plan_.steps;
  const auto most = static_cast<double>(options_.max_steps);
  return plan_.at_least ? most : std::min(plan_.steps, most);
}

bool Run::at_end() const {
  constexpr double round_off = 1e-9;
  return simulation_->time() >= scene_.end * (1 - round_off);
}

Progress Run::progress() const {
  Progress now;
  now.step = simulation_->steps();
  now.time = simulation_->time();
  now.end = scene_.end;
  const double by_time = now.time / scene_.end;
  const double by_steps = static_cast<double>(now.step) / total_steps();
  now.fraction = std::min(1.0, options_.max_steps > 0 ? std::max(by_time, by_steps) : by_time);
  now.ms_per_step = 1000 * eta_.seconds_per_step();
  const double steps_left = now.fraction > 0 ? static_cast<double>(now.step) * (1 / now.fraction - 1) : total_steps();
  now.eta = eta_.left(steps_left);
  return now;
}

void Run::say_header() {
  const BuildFacts& facts = build_facts();
  log_.say(fmt::format("greenwater {} (git {}, {})  case {}  {}", facts.version, facts.git, facts.build_type,
                       scene_.name, utc_text(origin_.started)));
  log_.say(fmt::format("Kokkos {} ({})  back-end {}, {} thread(s)  arch {}  kernels {}  flags {}  host {}",
                       facts.kokkos_version, facts.kokkos_devices, origin_.backend, origin_.threads, facts.kokkos_arch,
                       facts.kokkos_kernels, facts.flags, host_name()));
  log_.say(fmt::format("units     SI{}", scene_.dimension == 2 ? "; forces and energies are per metre of depth" : ""));
  for (const std::string& line : simulation_->plan()) log_.say(line);
  for (const std::string& option : origin_.case_options) log_.say("changed   " + option);
  log_.say("output    " + recorder_.folder().path().string());
  log_.say("");
}

void Run::report(const RunFacts& facts) {
  const double seconds = seconds_since(start_);
  const double steps = static_cast<double>(std::max<std::int64_t>(1, facts.step - reported_step_));
  const double ms = facts.step > 0 ? 1000 * (seconds - reported_seconds_) / steps : 0;
  reported_seconds_ = seconds;
  reported_step_ = facts.step;
  work_per_step_ = facts.work;
  for (const Notice& notice : facts.notices) log_.warn(notice, facts.step);
  recorder_.history(facts, ms);
  log_.thermo(simulation_->thermo_header() + pace_header(), facts.thermo + pace_text(ms, progress().eta));
  require<NumericsError>(facts.finite, "step ", facts.step, ", t = ", facts.time,
                         " s: a velocity is not a number; a shorter time step or a smaller spacing may help");
}

void Run::one_step() {
  const auto before = Clock::now();
  simulation_->step();
  work_ += work_per_step_;
  const auto stepped = Clock::now();
  if (simulation_->steps() % scene_.output.history_every_steps == 0 || at_end()) report(simulation_->run_facts());
  recorder_.sample(*simulation_);
  log_.progress(progress());
  status_.update(progress(), log_.warnings());
  output_seconds_ += seconds_since(stepped);
  eta_.step(seconds_since(before));
}

void Run::loop() {
  report(simulation_->run_facts());
  recorder_.sample(*simulation_);
  output_seconds_ += seconds_since(start_);
  while (!at_end() && signals_.received() == 0 &&
         (options_.max_steps == 0 || simulation_->steps() < options_.max_steps)) {
    one_step();
  }
  if (reported_step_ != simulation_->steps()) report(simulation_->run_facts());
  recorder_.last_frame(*simulation_);
}

void Run::say_summary() {
  const RunSpeed speed{simulation_->steps(), simulation_->time(), seconds_since(start_), work_,
                       scene_.has_fluid ? "particle" : "element"};
  std::vector<TimedSection> sections;
  for (const RegionTime& region : region_times()) {
    if (region.name != "step") sections.push_back({region.name, region.seconds});  // "step" holds all the others
  }
  sections.push_back({"output", output_seconds_});
  log_.say("");
  for (const std::string& line : summary_lines(speed, sections)) log_.say(line);
  for (const std::string& line : log_.warning_counts()) log_.say(line);
}

RunEnd Run::end_of(int code, const std::string& outcome, const std::string& message) const {
  return {code, outcome, message, simulation_->steps(), simulation_->time(), std::chrono::system_clock::now()};
}

int Run::finish(const RunEnd& end, Marker marker, const char* state) {
  say_summary();
  log_.say(fmt::format("results   {}", recorder_.folder().path().string()));
  status_.write(state, progress(), log_.warnings());
  log_.say(fmt::format("exit {} ({})", end.exit_code, end.outcome));
  recorder_.finish(end, marker);
  return end.exit_code;
}

/// Keeps what can be kept; a disk that is full will refuse again, and is then left alone.
int Run::fail(const Failure& failure) {
  std::cerr << failure.message << '\n';
  try {
    if (failure.code == 3) {
      for (const Notice& notice : simulation_->run_facts().notices) log_.warn(notice, simulation_->steps());
    }
    log_.note(failure.message);
    if (failure.code == 3) recorder_.last_frame(*simulation_);
  } catch (const std::exception& again) {
    std::cerr << again.what() << '\n';
  }
  try {
    return finish(end_of(failure.code, failure.kind, failure.message), Marker::failed, "failed");
  } catch (const std::exception&) {
    std::cerr << fmt::format("exit {} ({})\n", failure.code, failure.kind);
    return failure.code;
  }
}

int Run::go() {
  constexpr int resumable = 75;
  try {
    log_.open(recorder_.folder().path() / "run.log");
    say_header();
    reset_region_times();
    start_ = Clock::now();
    loop();
    if (signals_.received() != 0 && !at_end()) {
      return finish(end_of(resumable, fmt::format("stopped by signal {}", signals_.received())), Marker::stopped,
                    "stopped");
    }
    const std::string outcome = at_end() ? "finished" : fmt::format("finished, --max-steps {}", options_.max_steps);
    return finish(end_of(0, outcome), Marker::done, "finished");
  } catch (...) {
    return fail(failure_of(std::current_exception()));
  }
}

}  // namespace

int run_case(const RunOptions& options, const Scene& scene, const CaseFile& file) {
  return Run(options, scene, file).go();
}

}  // namespace greenwater
