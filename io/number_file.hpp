#pragma once
// Tables of numbers in text files: from spreadsheets, from measurements, typed.

#include <filesystem>
#include <vector>

#include "io/place.hpp"

namespace greenwater {

struct NumberRow {
  int line = 0;  ///< in the file, from 1
  std::vector<double> value;
};

/// Rows of `columns` finite numbers each. Between numbers stand a comma, a semicolon, or blanks and tabs; the decimal
/// sign is a point. Lines before the first row without any number in them are a header; what follows a '#' is a comment.
/// Throws CaseError that names the file with line and column, and `place` where the case names it; FileError when it
/// cannot be read.
std::vector<NumberRow> read_number_rows(const std::filesystem::path& path, std::size_t columns, const Place& place);

/// The same without the lines.
std::vector<std::vector<double>> read_number_file(const std::filesystem::path& path, std::size_t columns,
                                                  const Place& place);

}  // namespace greenwater
