#include "bench/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "app/machine.hpp"
#include "core/build_facts.hpp"
#include "core/real.hpp"
#include "io/clock.hpp"
#include "io/file.hpp"
#include "io/run_origin.hpp"

namespace greenwater::bench {
namespace {

constexpr int format = 1;

}  // namespace

Json origin(const BenchOptions& options, int threads, const std::string& backend) {
  const BuildFacts& build = build_facts();
  return {{"version", std::string(build.version)},
          {"git", std::string(build.git)},
          {"kokkos", std::string(build.kokkos_version)},
          {"kokkos_devices", std::string(build.kokkos_devices)},
          {"kokkos_arch", std::string(build.kokkos_arch)},
          {"kokkos_kernels", std::string(build.kokkos_kernels)},
          {"compiler", std::string(build.compiler)},
          {"build_type", std::string(build.build_type)},
          {"flags", std::string(build.flags)},
          {"precision", sizeof(real) == sizeof(float) ? "single" : "double"},
          {"backend", backend},
          {"threads", threads},
          {"host", host_name()},
          {"processor", processor_name()},
          {"processors", machine_processors()},
          {"date", utc_text(std::chrono::system_clock::now())},
          {"environment", run_environment()},
          {"command_line", shell_text(options.command_line)}};
}

Json results(const std::string& kind, const Json& from) {
  return {{"greenwater_bench", format}, {"kind", kind}, {"origin", from}};
}

void add_spread(Json& row, const Spread& ms) {
  row["ms"] = ms.median;
  row["ms_min"] = ms.low;
  row["ms_max"] = ms.high;
  row["ms_q1"] = ms.q1;
  row["ms_q3"] = ms.q3;
}

Json row_of(const Size& size, int particles, const std::string& state) {
  return {{"case", scene_name(size.dim)}, {"dim", size.dim}, {"particles", particles}, {"state", state}};
}

Json triad_list(const Triads& triads) {
  Json list = Json::array();
  for (const auto& [bytes, rate] : triads.all())
    list.push_back({{"bytes", std::round(bytes)},
                    {"gb_per_s", rate.median},
                    {"gb_per_s_min", rate.low},
                    {"gb_per_s_max", rate.high}});
  return list;
}

void write_results(const BenchOptions& options, const Json& all) {
  if (options.json.empty()) return;
  write_atomically(options.json, all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::string figure(double value) {
  if (value == 0) return "0";
  const int decimals = std::max(0, 2 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return fmt::format("{:.{}f}", value, decimals);
}

}  // namespace greenwater::bench
