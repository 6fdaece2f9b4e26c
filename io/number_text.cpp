#include "io/number_text.hpp"

#include <charconv>

namespace greenwater {
namespace {

/// from_chars knows no plus.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

template <class Number>
NumberText parse(std::string_view text, Number& value) {
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || fault == std::errc::invalid_argument) return NumberText::none;
  return fault == std::errc() ? NumberText::number : NumberText::too_large;
}

/// Of a number that fits into no double.
bool is_tiny(std::string_view digits) {
  return digits.find("e-") != std::string_view::npos || digits.find("E-") != std::string_view::npos;
}

}  // namespace

NumberText parse_number(std::string_view text, double& value) {
  const std::string_view digits = without_plus(text);
  const NumberText kind = parse(digits, value);
  if (kind != NumberText::too_large || !is_tiny(digits)) return kind;
  value = 0;
  return NumberText::number;
}

NumberText parse_number(std::string_view text, std::int64_t& value) { return parse(without_plus(text), value); }

}  // namespace greenwater
