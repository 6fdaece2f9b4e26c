#pragma once
// A text such as "0.1*sin(2*pi*x)*exp(-t)", compiled once and evaluated often.

#include <array>
#include <memory>
#include <string>

#include "io/place.hpp"

namespace greenwater {

/// What a formula may depend on: x, y, z [m]; t [s]; the velocity u, v, w [m/s].
enum class Variables { place_and_time, time, place_time_velocity };

/// A function of its variables, with the constants pi and e, the usual functions (sin, exp, sqrt, min, if-else as
/// `a ? b : c` ...) and no side effects. Not for several threads at a time.
class Formula {
 public:
  /// Throws CaseError at `place`, with the position in the text and what is allowed, when it is no formula of these
  /// variables.
  Formula(const std::string& text, const Place& place, Variables variables = Variables::place_and_time);
  ~Formula();
  Formula(Formula&&) noexcept;
  Formula& operator=(Formula&&) noexcept;

  /// Value at a point [m], time [s] and velocity [m/s]; may be inf or nan, which is for the caller to judge.
  double operator()(double x, double y, double z, double t, const std::array<double, 3>& u = {}) const;
  /// True when no variable stands in it.
  bool constant() const;
  /// True when t stands in it.
  bool varies_in_time() const;

 private:
  struct Engine;
  std::unique_ptr<Engine> engine_;
};

/// One formula for each component.
std::array<Formula, 3> compile(const std::array<std::string, 3>& text, const Place& place,
                               Variables variables = Variables::place_and_time);

/// True when every component is a constant zero.
bool is_zero(const std::array<Formula, 3>& formulas);

}  // namespace greenwater
