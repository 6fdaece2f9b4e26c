#include "io/quantity.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/check.hpp"

namespace greenwater {
namespace {

struct Named {
  std::string_view name;
  Unit unit;
  bool prefixed;  // takes milli, kilo ...
};

constexpr double degree = std::numbers::pi / 180;

//                 kg  m  s rad 10^ scale
constexpr std::array<Named, 17> base_units{{
    {"m", {0, 1, 0, 0, 0, 1}, true},
    {"g", {1, 0, 0, 0, -3, 1}, true},
    {"s", {0, 0, 1, 0, 0, 1}, true},
    {"min", {0, 0, 1, 0, 0, 60}, false},
    {"h", {0, 0, 1, 0, 0, 3600}, false},
    {"rad", {0, 0, 0, 1, 0, 1}, true},
    {"deg", {0, 0, 0, 1, 0, degree}, false},
    {"N", {1, 1, -2, 0, 0, 1}, true},
    {"Pa", {1, -1, -2, 0, 0, 1}, true},
    {"bar", {1, -1, -2, 0, 5, 1}, true},
    {"J", {1, 2, -2, 0, 0, 1}, true},
    {"W", {1, 2, -3, 0, 0, 1}, true},
    {"Hz", {0, 0, -1, 0, 0, 1}, true},
    {"t", {1, 0, 0, 0, 3, 1}, false},
    {"%", {0, 0, 0, 0, -2, 1}, false},
    {"-", {0, 0, 0, 0, 0, 1}, false},
    {"1", {0, 0, 0, 0, 0, 1}, false},
}};

struct Prefix {
  std::string_view name;
  int power;
};
constexpr std::array<Prefix, 9> prefixes{
    {{"n", -9}, {"u", -6}, {"µ", -6}, {"m", -3}, {"c", -2}, {"d", -1}, {"k", 3}, {"M", 6}, {"G", 9}}};

std::optional<Unit> base_unit(std::string_view name) {
  for (const Named& known : base_units) {
    if (known.name == name) return known.unit;
  }
  for (const Prefix& prefix : prefixes) {
    if (!name.starts_with(prefix.name)) continue;
    for (const Named& known : base_units) {
      if (!known.prefixed || known.name != name.substr(prefix.name.size())) continue;
      Unit unit = known.unit;
      unit.decimal_power += prefix.power;
      return unit;
    }
  }
  return {};
}

void multiply(Unit& product, const Unit& factor, int power) {
  product.kilogram += power * factor.kilogram;
  product.metre += power * factor.metre;
  product.second += power * factor.second;
  product.radian += power * factor.radian;
  product.decimal_power += power * factor.decimal_power;
  if (factor.scale != 1) product.scale *= std::pow(factor.scale, power);
}

bool ends_name(char c) {
  return c == ' ' || c == '*' || c == '/' || c == '^' || c == '+' || (std::isdigit(static_cast<unsigned char>(c)) != 0);
}

/// Takes the exponent off the front of `rest`: `^2`, `2`, `^-3`, `-3`; 1 when there is none, nothing when malformed.
std::optional<int> take_power(std::string_view& rest) {
  const bool caret = rest.starts_with('^');
  if (caret) rest.remove_prefix(1);
  int power = 1;
  const auto [end, fault] = std::from_chars(rest.data(), rest.data() + rest.size(), power);
  if (fault != std::errc()) {
    if (caret) return {};
    return 1;
  }
  if (std::abs(power) > 9) return {};
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return power;
}

/// Takes one factor such as `cm^3` off the front of `rest`.
std::optional<Unit> take_factor(std::string_view& rest, int sign) {
  std::size_t length = 1;  // the unit "1" and the unit "-" are one character
  if (!rest.starts_with('1') && !rest.starts_with('-')) {
    while (length < rest.size() && !ends_name(rest[length]) && rest[length] != '-') ++length;
  }
  const auto base = base_unit(rest.substr(0, length));
  if (!base) return {};
  rest.remove_prefix(length);
  const auto power = take_power(rest);
  if (!power) return {};
  Unit factor;
  multiply(factor, *base, sign * *power);
  return factor;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// The digits with the power of ten written behind them, read at once: no rounding beyond that of the last digit.
std::optional<double> scaled_number(std::string digits, int power) {
  const auto mark = digits.find_first_of("eE");
  if (mark != std::string::npos) {
    int own = 0;
    const char* first = digits.data() + mark + 1;
    if (*first == '+') ++first;
    if (std::from_chars(first, digits.data() + digits.size(), own).ec != std::errc()) return {};
    if (std::abs(own) > 1000) return {};
    power += own;
    digits.resize(mark);
  }
  digits += 'e' + std::to_string(power);
  double value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (fault != std::errc() || end != digits.data() + digits.size()) return {};
  return value;
}

/// Length of the number at the front of `text`.
std::size_t number_length(std::string_view text) {
  double ignored = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), ignored);
  return fault == std::errc::invalid_argument ? 0 : static_cast<std::size_t>(end - text.data());
}

}  // namespace

bool Unit::same_kind(const Unit& other) const {
  return kilogram == other.kilogram && metre == other.metre && second == other.second && radian == other.radian;
}

std::optional<Unit> parse_unit(std::string_view text) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with("x ")) return Unit{};  // "x spacing": a multiple of a length of the case
  if (rest.empty()) return {};
  Unit product;
  int sign = 1;
  while (!rest.empty()) {
    const auto factor = take_factor(rest, sign);
    if (!factor) return {};
    multiply(product, *factor, 1);
    rest = trimmed(rest);
    if (rest.empty()) break;
    sign = rest.front() == '/' ? -1 : 1;
    if (rest.front() == '/' || rest.front() == '*') rest = trimmed(rest.substr(1));
    if (rest.empty()) return {};
  }
  return product;
}

double parse_quantity(const std::string& text, const std::string& unit) {
  std::string_view rest = trimmed(text);
  if (rest.starts_with('+')) rest.remove_prefix(1);
  const std::size_t length = number_length(rest);
  require(length > 0, '"', text, "\" is not a number with a unit; write for example \"1.5 ", unit,
          "\" or the plain number");
  const std::string_view written = trimmed(rest.substr(length));
  const auto wanted = parse_unit(unit);
  expect(wanted.has_value());
  require(!written.empty(), "write the number ", text, " without quotes, or give it a unit: \"", text, ' ', unit, '"');
  const auto given = parse_unit(written);
  require(given.has_value(), "unknown unit \"", written, "\"; a quantity in ", unit, " is wanted");
  require(given->same_kind(*wanted), "wrong dimension: \"", text, "\" is in ", written, ", but ", unit, " is wanted");
  const auto value = scaled_number(std::string(rest.substr(0, length)), given->decimal_power);
  require(value.has_value(), '"', text, "\" does not fit into a number");
  return *value * given->scale;
}

}  // namespace greenwater
