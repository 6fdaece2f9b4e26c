#pragma once
// Where a moving geometry is at any time.

#include <memory>

#include "app/scene.hpp"

namespace greenwater {

/// A rigid motion of the case, evaluated: x(t) = about + R(angle(t)) (x0 - about) + displacement(t). Times up to 0 give
/// the start. Answers do not depend on what was asked before; times that ascend are answered fastest. Not for several
/// threads at a time.
class Motion {
 public:
  /// Throws CaseError at a formula's place when it is none.
  explicit Motion(const MotionCase& motion);
  ~Motion();
  Motion(Motion&&) noexcept;
  Motion& operator=(Motion&&) noexcept;

  Point displacement(double t) const;  ///< [m]
  double angle(double t) const;        ///< [rad]
  /// Where the corner that was at x0 at t = 0 is now [m].
  Point at(const Point& x0, double t) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The value of a column at a time: straight lines between the rows, constant outside.
double value_of(const TimeTable& table, std::size_t column, double t);

/// No point at most `reach` [m] from the axis of rotation moves further than this [m] between two times; nan or inf where
/// the motion is none.
double longest_way(const Motion& motion, double from, double to, double reach);

/// The fastest step of a motion.
struct LongestStep {
  double way = 0;   ///< no point within reach moves further in that step [m]; nan or inf where the motion is none
  double time = 0;  ///< when it begins [s]
};

/// Looks at the steps from 0 to `end` [s] (of very many, at a part, evenly), for all points at most `reach` [m] from the
/// axis of rotation.
LongestStep longest_step(const Motion& motion, double end, double time_step, double reach);

/// The fastest part of that step, a thousandth of it long: what is still long there is a jump.
LongestStep fastest_part(const Motion& motion, LongestStep step, double time_step, double reach);

}  // namespace greenwater
