#pragma once
// A file of data that a case names, and complaints that point into it.

#include <filesystem>
#include <string>
#include <utility>

#include "io/place.hpp"

namespace greenwater {

struct DataFile {
  std::string name;  ///< for messages
  std::string text;  ///< byte for byte
  Place named_at;    ///< where the case names it
};

/// The whole file. Throws CaseError when there is none, or it is no file or too large (1 GB), and FileError
/// when it cannot be read.
DataFile read_data_file(const std::filesystem::path& path, const Place& place);

/// A position in the file, both from 1 (a line of 0: the file as a whole), and how many characters to underline.
struct DataSpot {
  int line = 0, column = 0, length = 1;
};

/// The message at its place in the file, the quoted line, and where the case names the file.
std::string data_complaint(const DataFile& file, const DataSpot& spot, const std::string& message);

/// Throws CaseError with data_complaint() of the pieces.
template <class... Parts>
[[noreturn]] void refuse(const DataFile& file, const DataSpot& spot, const Parts&... parts) {
  throw CaseError(data_complaint(file, spot, text_of(parts...)));
}

/// As require_at(), in a data file.
template <class... Parts>
void require_at(const DataFile& file, const DataSpot& spot, bool holds, const Parts&... parts) {
  if (!holds) refuse(file, spot, parts...);
}

/// True when the text holds bytes that no text file has.
bool looks_binary(const std::string& text);

}  // namespace greenwater
