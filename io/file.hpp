#pragma once
// Files whose every write is checked: a full disk is noticed at once, and named.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace greenwater {

/// A file that is written from its start. Each member throws FileError with the path and the cause.
class TextFile {
 public:
  explicit TextFile(const std::filesystem::path& path);

  void write(std::string_view text);
  /// What was written reaches the system: a killed program loses nothing of it.
  void flush();
  /// Flushes and closes, so that a late failure is not lost in the destructor.
  void close();

  const std::filesystem::path& path() const { return path_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// Writes `path` beside itself and renames: readers see the old text or the new one, never a piece. Throws FileError.
void write_atomically(const std::filesystem::path& path, std::string_view text);

/// Creates the folder with its parents. Throws FileError.
void make_folder(const std::filesystem::path& path);

/// Throws FileError when fewer than `bytes` are free where `path` is; a disk that cannot say is trusted.
void require_room(const std::filesystem::path& path, double bytes);

}  // namespace greenwater
