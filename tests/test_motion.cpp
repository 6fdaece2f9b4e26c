// Motion of walls over time, against formulas.

#include <cmath>
#include <numbers>

#include "app/motion.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr double tiny = 1e-12;  // [m]

VectorFormula formulas(const std::string& x, const std::string& y, const std::string& z = "0") {
  VectorFormula vector;
  vector.text = {x, y, z};
  return vector;
}

TimeTable table(const std::vector<double>& time, const std::vector<std::vector<double>>& value) {
  TimeTable made;
  made.time = time;
  made.value = value;
  return made;
}

double distance(const Point& a, const Point& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

}  // namespace

TEST_CASE("a gate rises by its law, given as a way or as a speed", "[unit][motion]") {
  const auto law = [](double t) { return -285.115 * t * t * t + 72.305 * t * t + 0.1463 * t; };
  MotionCase way, speed;
  way.displacement = formulas("0", "-285.115*t^3 + 72.305*t^2 + 0.1463*t");
  speed.velocity = formulas("0", "-3*285.115*t^2 + 2*72.305*t + 0.1463");
  const Motion by_way(way), by_speed(speed);
  for (double t : {1e-6, 0.01, 0.0999, 0.05, 0.13}) {
    CHECK(std::fabs(by_way.displacement(t)[1] - law(t)) < tiny);
    CHECK(std::fabs(by_speed.displacement(t)[1] - law(t)) < tiny);
    CHECK(by_speed.angle(t) == 0);
    CHECK(distance(by_way.at({0.6, 0.1, 0}, t), {0.6, 0.1 + law(t), 0}) < tiny);
  }
  for (double t : {0.0, -1.0}) {
    CHECK(by_way.at({0.6, 0.1, 0}, t) == Point{0.6, 0.1, 0});
    CHECK(by_speed.at({0.6, 0.1, 0}, t) == Point{0.6, 0.1, 0});
  }
}

TEST_CASE("speeds are integrated to rounding, also over jumps, in any order", "[unit][motion]") {
  MotionCase motion;
  motion.velocity = formulas("2*pi*cos(2*pi*t)", "t < 0.3 ? 1 : (t < 0.7012345 ? -2 : 0)", "exp(-t)*sin(40*t)");
  const Motion one(motion), other(motion);
  const auto exact = [](double t) {
    const double jumps = std::min(t, 0.3) - 2 * std::clamp(t - 0.3, 0.0, 0.4012345);
    const double damped = (40 - std::exp(-t) * (40 * std::cos(40 * t) + std::sin(40 * t))) / (1 + 40 * 40);
    return Point{std::sin(2 * std::numbers::pi * t), jumps, damped};
  };
  std::vector<Point> ascending;
  for (int k = 1; k <= 300; ++k) ascending.push_back(one.displacement(k * 0.01));
  for (int k = 300; k >= 1; --k) {
    CHECK(other.displacement(k * 0.01) == ascending[k - 1]);
    CHECK(distance(ascending[k - 1], exact(k * 0.01)) < tiny);
  }
}

TEST_CASE("tables are followed in straight lines, their speeds integrated exactly", "[unit][motion]") {
  MotionCase way, speed;
  way.displacement_table = table({0, 1, 3}, {{0, 0}, {0.5, 1}, {0.5, -1}});
  speed.velocity_table = table({-1, 1, 3}, {{0, 1}, {2, 1}, {0, 1}});
  const Motion by_way(way), by_speed(speed);
  CHECK(distance(by_way.displacement(0.5), {0.25, 0.5, 0}) < tiny);
  CHECK(distance(by_way.displacement(2), {0.5, 0, 0}) < tiny);
  CHECK(distance(by_way.displacement(9), {0.5, -1, 0}) < tiny);
  CHECK(distance(by_speed.displacement(1), {1.5, 1, 0}) < tiny);  // u = 1 + t, then 3 - t, then 0
  CHECK(distance(by_speed.displacement(2), {3, 2, 0}) < tiny);
  CHECK(distance(by_speed.displacement(5), {3.5, 5, 0}) < tiny);
  CHECK(by_speed.displacement(0) == Point{0, 0, 0});
}

TEST_CASE("rotation is anti-clockwise in 2-D and right-handed in 3-D", "[unit][motion]") {
  constexpr double quarter = std::numbers::pi / 2;
  MotionCase flat;
  flat.rotation = NumberFormula{"pi/2*t", {}};
  flat.about = {1, 0, 0};
  const Motion plane(flat);
  CHECK(plane.angle(1) == Approx(quarter));
  CHECK(distance(plane.at({2, 0, 0}, 1), {1, 1, 0}) < tiny);
  CHECK(distance(plane.at({1, 0, 0}, 0.7), {1, 0, 0}) < tiny);
  MotionCase rolling = flat;
  rolling.rotation.reset();
  rolling.rotation_table = table({0, 1}, {{0}, {quarter}});
  rolling.axis = {0, 3, 0};
  rolling.displacement = formulas("t", "0", "2*t");
  const Motion roll(rolling);
  CHECK(distance(roll.at({1, 5, 1}, 1), {1 + 1 + 1, 5, 0 + 2}) < tiny);  // z turns to x
  CHECK(distance(roll.at({1, 5, 1}, 0.5), {1 + std::sqrt(0.5) + 0.5, 5, std::sqrt(0.5) + 1}) < tiny);
}

TEST_CASE("the longest step of a motion is found", "[unit][motion]") {
  MotionCase motion;
  motion.velocity = formulas("t", "0");
  motion.rotation = NumberFormula{"2*t", {}};
  const LongestStep last = longest_step(Motion(motion), 1, 0.01, 0.5);
  CHECK(last.way == Approx(0.01 * 0.995 + 0.02 * 0.5));
  CHECK(last.time == Approx(0.99));
  motion.velocity = formulas("t > 0.5 ? sqrt(0.5 - t) : 0", "0");
  CHECK(std::isnan(longest_step(Motion(motion), 1, 0.01, 0.5).way));
}

TEST_CASE("a jump stays as long in a short time, a fast motion does not", "[unit][motion]") {
  MotionCase smooth, jump;
  smooth.velocity = formulas("t", "0");
  jump.displacement = formulas("0", "t < 0.7 ? t : 0.2 + t");
  const Motion by_speed(smooth), by_jump(jump);
  const LongestStep part = fastest_part(by_speed, {0.375, 0.5}, 0.5, 0);
  CHECK(part.way == Approx(0.5 / 1024).epsilon(1e-3));
  CHECK(part.time == Approx(1 - 0.5 / 1024));
  const LongestStep leap = fastest_part(by_jump, longest_step(by_jump, 1, 0.1, 0), 0.1, 0);
  CHECK(leap.way == Approx(0.2).epsilon(1e-3));
  CHECK(leap.time == Approx(0.7).margin(1e-4));
}
