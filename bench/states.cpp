#include "bench/states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/water.hpp"
#include "core/build_facts.hpp"
#include "io/clock.hpp"
#include "io/file.hpp"

namespace greenwater::bench {
namespace {

constexpr int format = 1;  // of the file, and of all that makes a state another one without changing the case

// FNV-1a
std::uint64_t fingerprint(const std::string& text) {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

template <class T>
bool take(std::istream& stream, std::vector<T>& values, std::size_t count) {
  values.resize(count);
  return static_cast<bool>(
      stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T))));
}

std::int64_t steps_until(const Size& size, const std::string& name) {
  return std::llround(time_of_state(name) / size.dt);
}

std::string words(const Size& size) {
  return fmt::format("{} particles in {}-D, spacing {:.4g} mm", size.particles, size.dim, size.spacing * 1e3);
}

/// Says now and then how far it is.
class Progress {
 public:
  explicit Progress(std::int64_t total) : total_(total), eta_(static_cast<double>(total)) {}

  void step() {
    const auto now = Clock::now();
    eta_.step(std::chrono::duration<double>(now - last_).count());
    last_ = now;
    ++done_;
    const double quiet = std::chrono::duration<double>(now - said_).count();
    if (quiet < (said_once_ ? 30 : 5) || done_ == total_) return;
    fmt::print("  step {} of {}, {} left\n", done_, total_,
               duration_text(eta_.left(static_cast<double>(total_ - done_))));
    std::cout.flush();
    std::fflush(stdout);
    said_ = now;
    said_once_ = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::int64_t total_, done_ = 0;
  Eta eta_;
  Clock::time_point last_ = Clock::now(), said_ = last_;
  bool said_once_ = false;
};

void sort_by_time(std::vector<std::string>& names) {
  std::sort(names.begin(), names.end(),
            [](const auto& a, const auto& b) { return time_of_state(a) < time_of_state(b); });
  names.erase(std::unique(names.begin(), names.end()), names.end());
}

std::optional<State> latest_before(const std::filesystem::path& folder, const Size& size, const std::string& name) {
  std::vector<std::string> earlier{"rest", "early", "collapse"};
  for (auto at = earlier.rbegin(); at != earlier.rend(); ++at) {
    const auto file = state_file(folder, size, *at);
    if (time_of_state(*at) < time_of_state(name) && std::filesystem::exists(file)) return read_state(file);
  }
  return std::nullopt;
}

}  // namespace

void write_state(const std::filesystem::path& path, const State& state) {
  const nlohmann::ordered_json head{
      {"greenwater_state", format}, {"dim", state.dim},   {"particles", state.particles()},
      {"steps", state.steps},       {"time", state.time}, {"git", state.made_by}};
  std::string bytes = head.dump() + '\n';
  append(bytes, state.id);
  append(bytes, state.position);
  append(bytes, state.velocity);
  append(bytes, state.pressure);
  write_atomically(path, bytes);
}

State read_state(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string line;
  std::getline(stream, line);
  const auto head = nlohmann::json::parse(line, nullptr, false);
  const bool known = head.is_object() && head.value("greenwater_state", 0) == format;
  require<FileError>(known, path.string(), ": error: not a state of this version; delete it, and it is made again");
  State state;
  state.dim = head.value("dim", 2);
  state.steps = head.value("steps", std::int64_t{0});
  state.time = head.value("time", 0.0);
  state.made_by = head.value("git", "unknown");
  const auto count = head.value("particles", std::size_t{0}), vectors = count * static_cast<std::size_t>(state.dim);
  const bool whole = take(stream, state.id, count) && take(stream, state.position, vectors) &&
                     take(stream, state.velocity, vectors) && take(stream, state.pressure, count);
  require<FileError>(whole && stream.peek() == std::ifstream::traits_type::eof(), path.string(),
                     ": error: the file is cut short or longer than it says; delete it, and it is made again");
  return state;
}

std::filesystem::path state_folder(const std::string& wished) {
  if (!wished.empty()) return wished;
  const char *cache = std::getenv("XDG_CACHE_HOME"), *home = std::getenv("HOME");
  if (cache && *cache) return std::filesystem::path(cache) / "greenwater" / "bench";
  if (home && *home) return std::filesystem::path(home) / ".cache" / "greenwater" / "bench";
  return std::filesystem::temp_directory_path() / "greenwater-bench";
}

std::filesystem::path state_file(const std::filesystem::path& folder, const Size& size, const std::string& name) {
  const std::string what = fmt::format("{} {} {}", scene_text(size), name, format);
  return folder / fmt::format("{}d_{}_{}_{:016x}.state", size.dim, size.particles, name, fingerprint(what));
}

void make_states(const std::filesystem::path& folder, const Size& size, std::vector<std::string> names) {
  sort_by_time(names);
  std::erase_if(names, [&](const auto& name) { return std::filesystem::exists(state_file(folder, size, name)); });
  if (names.empty()) return;
  make_folder(folder);
  const auto start = latest_before(folder, size, names.front());
  Water water(bench_scene(size), start);
  const std::int64_t end = steps_until(size, names.back());
  fmt::print("making states of {}: {} steps\n", words(size), end - water.steps());
  Progress progress(end - water.steps());
  for (const std::string& name : names) {
    while (water.steps() < steps_until(size, name)) {
      water.step();
      progress.step();
    }
    write_state(state_file(folder, size, name), water.state());
    fmt::print("  {} at t = {:.4g} s is kept in {}\n", name, water.time(), state_file(folder, size, name).string());
  }
  std::fflush(stdout);
}

State state_at(const std::filesystem::path& folder, const Size& size, const std::string& name) {
  make_states(folder, size, {name});
  return read_state(state_file(folder, size, name));
}

}  // namespace greenwater::bench
