// Numbers with units, and formulas.

#include <cmath>
#include <numbers>

#include "app/formula.hpp"
#include "io/quantity.hpp"
#include "tests/catch.hpp"
#include "tests/program.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

std::string refusal(const std::string& text, const std::string& unit) {
  try {
    parse_quantity(text, unit);
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

std::string refused_formula(const std::string& text) {
  try {
    Formula(text, Place{"case.toml", 3, 7, 1, nullptr});
  } catch (const CaseError& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("quantities become exactly the SI number that one would type", "[unit][quantity]") {
  CHECK(parse_quantity("3.43 GPa", "Pa") == 3.43e9);
  CHECK(parse_quantity("1.20 g/cm^3", "kg/m^3") == 1200);
  CHECK(parse_quantity("3 mm", "m") == 0.003);
  CHECK(parse_quantity("3mm", "m") == 0.003);
  CHECK(parse_quantity("0.115 ms", "s") == 0.000115);
  CHECK(parse_quantity("-9.81e2 cm/s2", "m/s^2") == -9.81);
  CHECK(parse_quantity("+1e-2 cm2/s", "m^2/s") == 1e-6);
  CHECK(parse_quantity("4.5e-10 1/Pa", "1/Pa") == 4.5e-10);
  CHECK(parse_quantity("2 N*s/m^2", "kg/m/s") == 2);
  CHECK(parse_quantity("2 N s m-2", "kg/m/s") == 2);
  CHECK(parse_quantity("1 bar", "Pa") == 1e5);
  CHECK(parse_quantity("2 min", "s") == 120);
  CHECK(parse_quantity("15 deg", "rad") == Approx(15 * std::numbers::pi / 180).epsilon(1e-15));
  CHECK(parse_quantity("20 %", "-") == 0.2);
  CHECK(parse_quantity("5 us", "s") == 5e-6);
  CHECK(parse_quantity("5 µs", "s") == 5e-6);
}

TEST_CASE("what is no quantity is refused with both units", "[unit][quantity]") {
  CHECK(contains(refusal("3 mm", "kg/m^3"), "wrong dimension: \"3 mm\" is in mm, but kg/m^3 is wanted"));
  CHECK(contains(refusal("15 deg", "m"), "wrong dimension"));
  CHECK(contains(refusal("15 deg", "-"), "wrong dimension"));
  CHECK(contains(refusal("3 furlong", "m"), "unknown unit \"furlong\""));
  CHECK(contains(refusal("0.003", "m"), "without quotes"));
  CHECK(contains(refusal("wide", "m"), "not a number"));
  CHECK(contains(refusal("", "m"), "not a number"));
  CHECK(contains(refusal("1e999 m", "m"), "does not fit"));
  CHECK(contains(refusal("1,5 m", "m"), "unknown unit"));
  for (const char* broken : {"1 m/", "1 m^", "1 /m", "1 m^99", "1 kkg", "1 m//s"}) CHECK(!refusal(broken, "m").empty());
}

TEST_CASE("formulas know x, y, z, t and the usual functions", "[unit][formula]") {
  const Place place;
  CHECK(Formula("1 + 2*x - y^2 + z*t", place)(1, 2, 3, 4) == 1 + 2 - 4 + 12);
  CHECK(Formula("sin(pi/2) + e", place)(0, 0, 0, 0) == Approx(1 + std::numbers::e));
  CHECK(Formula("x > 0.5 ? 3 : 4", place)(1, 0, 0, 0) == 3);
  CHECK(Formula("sqrt(x*x + y*y)", place)(3, 4, 0, 0) == 5);
  CHECK(Formula("x == 1 ? 2 : 3", place)(1, 0, 0, 0) == 2);
  CHECK(Formula("2*pi", place).constant());
  CHECK(!Formula("2*t", place).constant());
  CHECK(Formula("2*t", place).varies_in_time());
  CHECK(!Formula("2*x", place).varies_in_time());
  CHECK(is_zero(compile({"0", "1-1", "0.0"}, place)));
  CHECK(!is_zero(compile({"0", "x", "0"}, place)));
}

TEST_CASE("a formula knows the variables of its place", "[unit][formula]") {
  const Place place{"case.toml", 3, 7, 1, nullptr};
  CHECK(Formula("t^2", place, Variables::time)(0, 0, 0, 3) == 9);
  CHECK(Formula("x + 2*u - v*w", place, Variables::place_time_velocity)(1, 0, 0, 0, {2, 3, 4}) == 1 + 4 - 12);
  const auto refused = [&](const std::string& text, Variables variables) -> std::string {
    try {
      Formula(text, place, variables);
    } catch (const CaseError& error) {
      return error.what();
    }
    return {};
  };
  CHECK(contains(refused("exp(t) + x", Variables::time),
                 "character 10: \"x\" has no meaning here; the only variable is t"));
  CHECK(contains(refused("max(1, u)", Variables::place_and_time), "character 8: \"u\" has no meaning here"));
  CHECK(contains(refused("q", Variables::place_time_velocity), "the velocity u, v, w [m/s]"));
}

TEST_CASE("what is no formula is refused with its position", "[unit][formula]") {
  CHECK(contains(refused_formula("2*sin(x"), "case.toml:3:7: error: formula \"2*sin(x\", character 8"));
  CHECK(contains(refused_formula("1 + v"), "character 5"));
  CHECK(contains(refused_formula("x = 3"), "character 3"));
  CHECK(contains(refused_formula("x = 3"), "equality is =="));
  for (const char* broken : {"", "1 2", "1,2", "sin()", "\"text\"", "1 +", "os.system(1)"}) {
    INFO(broken);
    CHECK(contains(refused_formula(broken), "variables are x, y, z"));
  }
}
