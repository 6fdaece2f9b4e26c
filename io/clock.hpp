#pragma once
// Times for people and for files, and the stretch of time left.

#include <chrono>
#include <string>

namespace greenwater {

using WallTime = std::chrono::system_clock::time_point;

/// `2026-11-22T10:14:03Z`
std::string utc_text(WallTime time);
/// `20261122-101403`, local time, for folder names.
std::string folder_date(WallTime time);
/// `11:09:55` local time; with the day in front when that is another one.
std::string finish_text(WallTime now, double seconds_left);
/// `00:29:50`; `--:--:--` when it is not known.
std::string duration_text(double seconds);

/// Predicts the time left from the steps done, smoothed over about the last twentieth of the run: the pressure solve
/// grows slower at an impact and quicker behind it.
class Eta {
 public:
  explicit Eta(double total_steps);
  void step(double seconds);
  double seconds_per_step() const;  ///< smoothed; not a number before the first step
  double left(double steps_left) const { return steps_left * seconds_per_step(); }

 private:
  double keep_;  // weight of the past in each update
  double mean_ = 0, weight_ = 0;
};

}  // namespace greenwater
