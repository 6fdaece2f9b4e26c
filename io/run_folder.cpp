#include "io/run_folder.hpp"

#include "io/file.hpp"
#include "io/run_origin.hpp"

namespace greenwater {
namespace {

namespace fs = std::filesystem;

bool something_is_at(const fs::path& path) {
  std::error_code fault;
  return fs::exists(fs::symlink_status(path, fault));
}

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

void remove_old_run(const fs::path& path) {
  std::error_code fault;
  fs::remove_all(path, fault);
  require<FileError>(!fault, path.string(), ": error: the older run cannot be removed: ", fault.message());
}

/// False when somebody else has it.
bool make_new(const fs::path& path) {
  if (path.has_parent_path()) make_folder(path.parent_path());
  std::error_code fault;
  const bool made = fs::create_directory(path, fault);
  require<FileError>(!fault || something_is_at(path), path.string(),
                     ": error: cannot create the run folder: ", fault.message());
  return made;
}

fs::path without_end_slash(fs::path path) {
  path = path.lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

std::string folder_from_pattern(const std::string& pattern, const std::string& name, WallTime date,
                                const Place& place) {
  std::string text = pattern;
  replace_all(text, "{name}", name);
  replace_all(text, "{date}", folder_date(date));
  require_at(place, text.find_first_of("{}") == std::string::npos, "directory = \"", pattern,
             "\": only {name} and {date} are filled in");
  return text;
}

void check_folder(const FolderWish& wish) {
  if (!wish.by_user || !something_is_at(wish.path)) return;
  const std::string name = wish.path.string();
  require(wish.overwrite, name, ": error: the run folder exists; take another -o, or add --overwrite to replace it");
  std::error_code fault;
  const bool free = fs::is_directory(wish.path) && fs::is_empty(wish.path, fault);
  require(free || is_run_folder(wish.path), name,
          ": error: --overwrite replaces only the folder of an earlier run, and this one has no manifest.json of ours; "
          "take another -o");
}

RunFolder::RunFolder(const FolderWish& wish) : path_(without_end_slash(wish.path)) {
  check_folder(wish);
  if (wish.by_user) {
    if (something_is_at(path_)) remove_old_run(path_);
    require(make_new(path_), path_.string(), ": error: the run folder exists; take another -o");
    return;
  }
  const std::string first = path_.string();
  for (int number = 2; !make_new(path_); ++number) path_ = first + '-' + std::to_string(number);
}

void RunFolder::write(const std::string& name, std::string_view text) const { write_atomically(path_ / name, text); }

void RunFolder::mark(Marker marker) const {
  const char* name = marker == Marker::done ? "DONE" : marker == Marker::stopped ? "STOPPED" : "FAILED";
  TextFile(path_ / name).close();
}

}  // namespace greenwater
