#pragma once
// Numbers as programs and people write them into files of data.

#include <cstdint>
#include <string_view>

namespace greenwater {

enum class NumberText { number, too_large, none };

/// Reads the whole of `text`, like 0.25, -2.5e-1, +3 or nan. A number too small for a double is 0; `value` is kept when
/// there is none, or one too large.
NumberText parse_number(std::string_view text, double& value);

/// The same for whole numbers, without point and exponent.
NumberText parse_number(std::string_view text, std::int64_t& value);

}  // namespace greenwater
