#pragma once
// Values as TOML writes them: for resolved cases and for the examples in messages.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace greenwater {

using Point = std::array<double, 3>;  ///< x, y, z; z = 0 in 2-D

/// The shortest text that reads back as the same number, always with a point or an exponent.
std::string toml_number(double value);
std::string toml_number(std::int64_t value);
std::string toml_flag(bool value);
/// In quotes, with escapes where they are needed.
std::string toml_text(std::string_view value);
/// A bare key where TOML allows it, else in quotes.
std::string toml_key(std::string_view name);
/// `[a, b, c]`
std::string toml_list(const std::vector<std::string>& items);
std::string toml_texts(const std::vector<std::string>& values);
/// The first `dimension` components.
std::string toml_point(const Point& value, int dimension);

}  // namespace greenwater
