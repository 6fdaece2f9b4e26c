#pragma once
// status.json: how far a run is, for whoever looks from another window.

#include <chrono>
#include <filesystem>
#include <string>

#include "io/log.hpp"

namespace greenwater {

class StatusFile {
 public:
  explicit StatusFile(const std::filesystem::path& path) : path_(path) {}

  /// Replaces the file when the last time is two seconds ago. Throws FileError.
  void update(const Progress& progress, std::int64_t warnings);
  /// Replaces it now; `state` is running, finished, stopped or failed.
  void write(const std::string& state, const Progress& progress, std::int64_t warnings);

 private:
  std::filesystem::path path_;
  std::chrono::steady_clock::time_point written_;
};

}  // namespace greenwater
