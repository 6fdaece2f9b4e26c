#include "io/file.hpp"

#include <cerrno>
#include <cstring>
#include <iterator>

#include "core/check.hpp"

namespace greenwater {

TextFile::TextFile(const std::filesystem::path& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) fail("cannot be created");
}

void TextFile::write(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail("cannot be written");
}

void TextFile::flush() {
  if (std::fflush(file_.get()) != 0) fail("cannot be written");
}

void TextFile::close() {
  if (!file_) return;
  flush();
  if (std::fclose(file_.release()) != 0) fail("cannot be closed");
}

void TextFile::fail(const char* what) const {
  throw FileError(text_of(path_.string(), ": error: ", what, ": ", std::strerror(errno)));
}

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::path beside = path;
  beside += ".tmp";
  std::error_code fault;
  try {
    TextFile file(beside);
    file.write(text);
    file.close();
  } catch (const FileError&) {
    std::filesystem::remove(beside, fault);
    throw;
  }
  std::filesystem::rename(beside, path, fault);
  require<FileError>(!fault, path.string(), ": error: cannot be replaced: ", fault.message());
}

void make_folder(const std::filesystem::path& path) {
  std::error_code fault;
  std::filesystem::create_directories(path, fault);
  require<FileError>(!fault, path.string(), ": error: cannot create the folder: ", fault.message());
}

void require_room(const std::filesystem::path& path, double bytes) {
  std::error_code fault;
  const auto space = std::filesystem::space(path, fault);
  if (fault) return;
  const double free = static_cast<double>(space.available);
  require<FileError>(free >= bytes, path.string(), ": error: the disk is full: ", bytes / 1e6, " MB are needed, ",
                     free / 1e6, " MB are free");
}

}  // namespace greenwater
