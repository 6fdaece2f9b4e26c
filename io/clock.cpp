#include "io/clock.hpp"

#include <fmt/chrono.h>

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

std::tm local(WallTime time) { return fmt::localtime(std::chrono::system_clock::to_time_t(time)); }

}  // namespace

std::string utc_text(WallTime time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(time)));
}

std::string folder_date(WallTime time) { return fmt::format("{:%Y%m%d-%H%M%S}", local(time)); }

std::string finish_text(WallTime now, double seconds_left) {
  constexpr double longest = 1e9;  // beyond that nobody asks for the hour
  if (!(seconds_left >= 0) || seconds_left > longest) return "--:--:--";
  const auto left = std::chrono::seconds(std::llround(seconds_left));
  const std::tm today = local(now);
  const std::tm then = local(now + left);
  const bool same_day = today.tm_yday == then.tm_yday && today.tm_year == then.tm_year;
  return same_day ? fmt::format("{:%H:%M:%S}", then) : fmt::format("{:%Y-%m-%d %H:%M}", then);
}

std::string duration_text(double seconds) {
  constexpr double longest = 3.6e9;
  if (!(seconds >= 0) || seconds > longest) return "--:--:--";
  const auto whole = std::llround(seconds);
  return fmt::format("{:02d}:{:02d}:{:02d}", whole / 3600, whole / 60 % 60, whole % 60);
}

Eta::Eta(double total_steps) {
  constexpr double fraction = 0.05, fewest = 10, most = 1e4;
  keep_ = 1 - 1 / std::clamp(fraction * total_steps, fewest, most);
}

void Eta::step(double seconds) {
  mean_ = keep_ * mean_ + (1 - keep_) * seconds;
  weight_ = keep_ * weight_ + (1 - keep_);
}

double Eta::seconds_per_step() const { return mean_ / weight_; }

}  // namespace greenwater
