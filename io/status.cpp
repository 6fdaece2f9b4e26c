#include "io/status.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

#include "io/clock.hpp"
#include "io/file.hpp"

namespace greenwater {
namespace {

/// JSON knows neither inf nor nan.
std::string json_number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null"; }

}  // namespace

void StatusFile::update(const Progress& progress, std::int64_t warnings) {
  constexpr std::chrono::seconds period{2};
  if (std::chrono::steady_clock::now() - written_ < period) return;
  write("running", progress, warnings);
}

void StatusFile::write(const std::string& state, const Progress& progress, std::int64_t warnings) {
  constexpr double longest = 1e9;  // [s]
  const auto now = std::chrono::system_clock::now();
  const bool foreseen = std::isfinite(progress.eta) && progress.eta < longest;
  const auto finish = now + std::chrono::seconds(foreseen ? std::llround(progress.eta) : 0);
  write_atomically(
      path_, fmt::format("{{\"state\":\"{}\",\"step\":{},\"time\":{},\"end\":{},\"fraction\":{},\"ms_per_step\":{},"
                         "\"eta_s\":{},\"finish\":{},\"warnings\":{},\"pid\":{},\"updated\":\"{}\"}}\n",
                         state, progress.step, json_number(progress.time), json_number(progress.end),
                         json_number(progress.fraction), json_number(progress.ms_per_step), json_number(progress.eta),
                         foreseen ? '"' + utc_text(finish) + '"' : "null", warnings, getpid(), utc_text(now)));
  written_ = std::chrono::steady_clock::now();
}

}  // namespace greenwater
