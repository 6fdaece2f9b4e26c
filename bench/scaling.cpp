// Sizes and threads. Every measurement is a process of its own; those of one size follow each other, so that their ratio
// holds where the machine's speed drifts.

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "app/machine.hpp"
#include "bench/measure.hpp"
#include "core/check.hpp"

namespace greenwater::bench {
namespace {

/// A file name for the time being; the file is removed at the end.
class Scratch {
 public:
  Scratch() : path_(std::filesystem::temp_directory_path() / fmt::format("greenwater_bench_{}.json", getpid())) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

void run_self(std::vector<std::string> words) {
  std::fflush(stdout);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<char*> argv{const_cast<char*>(self.c_str())};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    leave_processor();
    execv(self.c_str(), argv.data());
    _exit(127);
  }
  int status = 0;
  require<ResourceError>(
      child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0,
      "bench scaling: error: a measurement failed: greenwater ", fmt::format("{}", fmt::join(words, " ")));
}

std::vector<std::string> common_words(const BenchOptions& options, const std::string& verb, int particles,
                                      const std::string& state, int threads) {
  std::vector<std::string> words{"bench",     verb,
                                 "--dim",     std::to_string(options.dimension),
                                 "--sizes",   std::to_string(particles),
                                 "--states",  state,
                                 "--threads", std::to_string(threads)};
  if (!options.cache.empty()) words.insert(words.end(), {"--cache", options.cache});
  return words;
}

Json measured(const BenchOptions& options, int particles, const std::string& state, int threads) {
  const Scratch file;
  auto words = common_words(options, "step", particles, state, threads);
  words.insert(words.end(), {"--json", file.path(), "--rounds", std::to_string(options.rounds), "--steps",
                             std::to_string(options.steps)});
  if (!options.tolerances.empty())
    words.insert(words.end(), {"--tolerance", fmt::format("{}", options.tolerances.front())});
  for (const std::string& set : options.sets) words.insert(words.end(), {"--set", set});
  run_self(words);
  std::ifstream stream(file.path());
  return Json::parse(stream);
}

void print_table(const Json& rows) {
  fmt::print("\n  {:<10}{:>10}{:>9}{:>12}{:>10}{:>13}{:>8}{:>8}{:>8}{:>10}\n", "state", "particles", "threads",
             "ms a step", "ns/part.", "bytes/part.", "GB/s", "triad", "its", "speed-up");
  const Json* first = nullptr;  // of a size: the one that others are compared with
  for (const Json& row : rows) {
    if (row["region"] != "step") continue;
    if (!first || row["particles"] != (*first)["particles"] || row["state"] != (*first)["state"]) first = &row;
    const auto cell = [&](const char* key) { return figure(row[key].get<double>()); };
    fmt::print("  {:<10}{:>10}{:>9}{:>12}{:>10}{:>13}{:>8}{:>8}{:>8}{:>10.2f}\n", row["state"].get<std::string>(),
               row["particles"].get<int>(), row["threads"].get<int>(), cell("ms"), cell("ns_per_particle"),
               cell("bytes_per_particle"), cell("gb_per_s"), cell("triad_gb_per_s"), cell("iterations"),
               (*first)["ms"].get<double>() / row["ms"].get<double>());
  }
}

std::vector<int> usual_threads() { return machine_processors() > 1 ? std::vector{1, 2} : std::vector{1}; }

}  // namespace

Json bench_scaling(const BenchOptions& options) {
  const auto sizes = options.sizes.empty() ? usual_sizes(options.dimension, true) : options.sizes;
  const auto states = options.states.empty() ? std::vector<std::string>{"early"} : options.states;
  const auto threads = options.threads.empty() ? usual_threads() : options.threads;
  const int most = *std::max_element(threads.begin(), threads.end());
  Json all = results("scaling", origin(options, most, ""));
  all["triad"] = all["rows"] = Json::array();
  for (const std::string& state : states)
    for (const int particles : sizes) {
      run_self(common_words(options, "states", particles, state, most));
      for (const int number : threads) {
        const Json part = measured(options, particles, state, number);
        all["origin"]["backend"] = part["origin"]["backend"];
        for (const Json& row : part["rows"]) all["rows"].push_back(row);
        for (Json rate : part["triad"]) {
          rate["threads"] = number;
          all["triad"].push_back(rate);
        }
      }
    }
  print_table(all["rows"]);
  return all;
}

}  // namespace greenwater::bench
