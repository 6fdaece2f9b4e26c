#pragma once
// "Did you mean": the nearest of the known words.

#include <string>
#include <string_view>
#include <vector>

namespace greenwater {

/// Letters to insert, delete, change or swap with their neighbour to turn one word into the other; case is ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known word nearest to `word`, or an empty string when none is near enough to be meant.
std::string nearest(std::string_view word, const std::vector<std::string>& known);

/// `a, b, c` for messages.
std::string listed(const std::vector<std::string>& words);

}  // namespace greenwater
