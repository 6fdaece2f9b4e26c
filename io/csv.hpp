#pragma once
// Comma-separated values for spreadsheets, pandas and ParaView: one header row, '.' as the decimal sign, LF, %.9g.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "io/file.hpp"

namespace greenwater {

class Csv {
 public:
  /// Creates the file with its header row, e.g. {"time[s]", "front[m]"}. Throws FileError.
  Csv(const std::filesystem::path& path, const std::vector<std::string>& header);

  /// One row, as many values as the header has. Reaches the disk at once, or within a second when rows come faster.
  void row(const std::vector<double>& values);
  void close();

 private:
  TextFile file_;
  std::size_t columns_;
  std::string line_;
  std::chrono::steady_clock::time_point flushed_;
};

}  // namespace greenwater
