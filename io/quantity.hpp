#pragma once
// Numbers with units: "3.43 GPa", "1.20 g/cm^3", "15 deg" in, SI out.

#include <optional>
#include <string>
#include <string_view>

namespace greenwater {

/// A product of powers of the base units, with a scale: value in SI = number * scale * 10^decimal_power.
struct Unit {
  int kilogram = 0, metre = 0, second = 0, radian = 0;
  int decimal_power = 0;  ///< kept apart from `scale`, so that 3 mm is exactly the number 0.003
  double scale = 1;       ///< what is no power of ten: degrees, minutes, hours

  /// True when both measure the same kind of thing; scales are not compared.
  bool same_kind(const Unit& other) const;
};

/// Reads `kg/m^3`, `m2/s`, `1/Pa`, `g/cm^3`, `x spacing`, `-`: factors joined by blank, `*` or `/`, powers with or
/// without `^`, each with an SI prefix where that is usual. Nothing when it is no unit.
std::optional<Unit> parse_unit(std::string_view text);

/// The SI value of a quantity such as "0.115 ms", wanted in `unit` (SI). Throws CaseError (no place in it) that names
/// both units when the kind differs, or says what could not be read.
double parse_quantity(const std::string& text, const std::string& unit);

}  // namespace greenwater
