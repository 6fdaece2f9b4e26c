#include "io/place.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace greenwater {
namespace {

constexpr std::size_t widest_quote = 110;  // characters of a source line that are shown

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }  // UTF-8

/// The bytes before character number `column` (from 1), each character as one blank, tabs kept.
std::string blanks_before(const std::string& line, int column) {
  std::string blanks;
  for (const char c : line) {
    if (!starts_character(c)) continue;
    if (static_cast<int>(blanks.size()) + 1 >= column) break;
    blanks += c == '\t' ? '\t' : ' ';
  }
  return blanks;
}

std::string quote(const Place& place) {
  const std::string& line = (*place.lines)[static_cast<std::size_t>(place.line) - 1];
  std::ostringstream text;
  text << '\n' << std::setw(5) << place.line << " | " << line.substr(0, widest_quote);
  if (place.column > 0 && static_cast<std::size_t>(place.column) <= widest_quote) {
    const int room = std::max(1, static_cast<int>(std::min(line.size(), widest_quote)) - place.column + 1);
    text << "\n      | " << blanks_before(line, place.column)
         << std::string(static_cast<std::size_t>(std::clamp(place.length, 1, room)), '^');
  }
  return text.str();
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const Place& place) {
  out << place.file;
  if (place.line > 0) out << ':' << place.line << ':' << std::max(1, place.column);
  return out;
}

std::string complaint(const Place& place, const std::string& message) {
  std::string text = text_of(place, ": error: ", message);
  const bool quotable = place.lines && place.line > 0 && static_cast<std::size_t>(place.line) <= place.lines->size();
  return quotable ? text + quote(place) : text;
}

std::filesystem::path beside_case(const Place& place, const std::string& file) {
  const bool is_option = place.file.rfind("--", 0) == 0;
  const std::filesystem::path folder =
      is_option ? std::filesystem::path() : std::filesystem::path(place.file).parent_path();
  return folder / file;  // an absolute `file` replaces the folder
}

}  // namespace greenwater
