#include "io/data_file.hpp"

#include <algorithm>
#include <fstream>

namespace greenwater {
namespace {

/// The lines up to number `last`, for quoting.
std::vector<std::string> first_lines(const std::string& text, int last) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at <= text.size() && lines.size() < static_cast<std::size_t>(last);) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    if (!lines.back().empty() && lines.back().back() == '\r') lines.back().pop_back();
    at = end + 1;
  }
  return lines;
}

}  // namespace

DataFile read_data_file(const std::filesystem::path& path, const Place& place) {
  constexpr std::uintmax_t largest = std::uintmax_t{1} << 30U;  // bytes
  DataFile file{path.string(), {}, place};
  std::error_code fault;
  const auto kind = std::filesystem::status(path, fault).type();
  if (kind == std::filesystem::file_type::not_found) {
    refuse(place, "there is no file ", file.name, "; a relative name is looked up beside the case file");
  }
  require_at(place, kind == std::filesystem::file_type::regular, file.name, " is not a file that can be read",
             fault ? ": " + fault.message() : "");
  const auto size = std::filesystem::file_size(path, fault);
  require_at(place, !fault && size <= largest, file.name, " is larger than 1 GB; write a coarser one");
  std::ifstream stream(path, std::ios::binary);
  file.text.resize(size);
  if (size > 0) stream.read(file.text.data(), static_cast<std::streamsize>(size));
  require<FileError>(stream.good(), complaint(place, file.name + " cannot be read; see who may read it (ls -l)"));
  return file;
}

std::string data_complaint(const DataFile& file, const DataSpot& spot, const std::string& message) {
  Place place{file.name, spot.line, spot.column, spot.length, nullptr};
  if (spot.line > 0 && !looks_binary(file.text)) {
    place.lines = std::make_shared<const std::vector<std::string>>(first_lines(file.text, spot.line));
  }
  return text_of(complaint(place, message), '\n', file.named_at, ": the file is named here");
}

bool looks_binary(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte == 0x7F || (byte < 0x20 && c != '\t' && c != '\n' && c != '\r' && c != '\v' && c != '\f');
  });
}

}  // namespace greenwater
