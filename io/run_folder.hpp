#pragma once
// The folder of one run. It is made only when everything else is ready, and never over another one by accident.

#include <filesystem>
#include <string>
#include <string_view>

#include "io/clock.hpp"
#include "io/place.hpp"

namespace greenwater {

/// Which folder is wanted.
struct FolderWish {
  std::filesystem::path path;
  bool by_user = false;    ///< -o: this one and no other; else a taken name gets -2, -3 ...
  bool overwrite = false;  ///< with -o: remove an older run first
};

/// The pattern with {name} and {date} filled in. Throws CaseError at `place` for any other brace.
std::string folder_from_pattern(const std::string& pattern, const std::string& name, WallTime date, const Place& place);

/// Throws CaseError when the wish cannot be fulfilled: an explicit folder that exists without --overwrite, or that is
/// not the folder of a run. Changes nothing.
void check_folder(const FolderWish& wish);

enum class Marker { done, stopped, failed };

class RunFolder {
 public:
  /// check_folder(), then makes it. Throws CaseError or FileError.
  explicit RunFolder(const FolderWish& wish);

  const std::filesystem::path& path() const { return path_; }
  /// A text file in the folder, replaced whole. Throws FileError.
  void write(const std::string& name, std::string_view text) const;
  /// The empty file DONE, STOPPED or FAILED; the last thing written.
  void mark(Marker marker) const;

 private:
  std::filesystem::path path_;
};

}  // namespace greenwater
