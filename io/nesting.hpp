#pragma once
// How deep names, lists and tables of a case may lie in each other.

#include <functional>
#include <string_view>

namespace greenwater {

/// Of tables and lists in each other; a case needs four or five. Whoever walks through a case calls himself for each
/// level, the TOML library too, and deeper ones would use up the stack.
constexpr int most_levels = 32;

/// Where a text goes deeper: lines and columns from 1.
struct TooDeep {
  int line = 0, column = 0;
};

/// Looks through a text before anybody parses it, and calls `refuse` where more than most_levels brackets are open, or more
/// than so many names hang together by dots. It need not be TOML.
void check_nesting(std::string_view text, const std::function<void(const TooDeep&)>& refuse);

}  // namespace greenwater
