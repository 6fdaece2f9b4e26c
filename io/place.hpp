#pragma once
// Where in the input something stands, and complaints that point at it.

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "core/check.hpp"

namespace greenwater {

/// A position in a case file, or a command-line option that stands for one.
struct Place {
  std::string file;                                       ///< name of the file, or the option as typed
  int line = 0, column = 0;                               ///< from 1; 0: the file as a whole
  int length = 1;                                         ///< characters to underline
  std::shared_ptr<const std::vector<std::string>> lines;  ///< the text it points into; may be empty
};

/// `file:line:column`, or only the file where there is no line.
std::ostream& operator<<(std::ostream& out, const Place& place);

/// `file:line:column: error: message`, then the source line and a line of carets below it.
std::string complaint(const Place& place, const std::string& message);

/// A file that the case names: beside the case file where it is relative, or beside the working folder where it was
/// named by an option.
std::filesystem::path beside_case(const Place& place, const std::string& file);

/// Throws CaseError with complaint() of the pieces.
template <class... Parts>
[[noreturn]] void refuse(const Place& place, const Parts&... parts) {
  throw CaseError(complaint(place, text_of(parts...)));
}

/// As require(), with a place in the input. Throws CaseError when `holds` is false.
template <class... Parts>
void require_at(const Place& place, bool holds, const Parts&... parts) {
  if (!holds) refuse(place, parts...);
}

}  // namespace greenwater
