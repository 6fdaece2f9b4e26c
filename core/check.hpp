#pragma once
// Two kinds of complaint. require() is for the user: what is wrong, where, and how to mend it; it throws one of the
// errors below, which main() turns into an exit code. expect() is for the programmer: it stops at the line.
// Neither is for device code: a kernel counts, the host complains.

#include <cstdlib>
#include <iostream>
#include <source_location>
#include <sstream>
#include <stdexcept>
#include <string>

namespace greenwater {

/// The base of every error with a message for the user; `code` is the exit code of the program.
struct Error : std::runtime_error {
  Error(int exit_code, const std::string& text) : std::runtime_error(text), code(exit_code) {}
  int code;
};

/// Wrong input: case file, option, geometry. Exit code 2.
struct CaseError : Error {
  explicit CaseError(const std::string& text) : Error(2, text) {}
};

/// The numbers failed: not a number, stalled pressure solve. Exit code 3.
struct NumericsError : Error {
  explicit NumericsError(const std::string& text) : Error(3, text) {}
};

/// A file could not be read or written. Exit code 4.
struct FileError : Error {
  explicit FileError(const std::string& text) : Error(4, text) {}
};

/// Memory, device or back-end that is not there. Exit code 5.
struct ResourceError : Error {
  explicit ResourceError(const std::string& text) : Error(5, text) {}
};

/// The pieces in one string, as operator<< prints them.
template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

/// Throws `Kind` (CaseError unless said otherwise) with the pieces as its message when `holds` is false.
template <class Kind = CaseError, class... Parts>
void require(bool holds, const Parts&... parts) {
  if (!holds) throw Kind(text_of(parts...));
}

/// A promise of the program to itself. Broken: file, line and function on stderr, then abort.
inline void expect(bool holds, std::source_location here = std::source_location::current()) {
  if (holds) return;
  std::cerr << here.file_name() << ':' << here.line() << ": internal error in " << here.function_name() << '\n';
  std::abort();
}

}  // namespace greenwater
