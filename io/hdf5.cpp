#include "io/hdf5.hpp"

#include "core/check.hpp"

namespace greenwater {
namespace {

/// Called from the outermost to the innermost message; the last one is the cause.
herr_t keep_last(unsigned, const H5E_error2_t* message, void* kept) {
  auto& text = *static_cast<std::string*>(kept);
  if (message->desc != nullptr && *message->desc != '\0') text = message->desc;
  return 0;
}

/// Out of a low-level report only the system's own words: `errno = 28, error message = 'No space left on device', ...`.
std::string system_words(const std::string& cause) {
  const std::string before = "error message = '";
  const auto start = cause.find(before);
  const auto end = start == std::string::npos ? start : cause.find('\'', start + before.size());
  return end == std::string::npos ? cause : cause.substr(start + before.size(), end - start - before.size());
}

}  // namespace

void hdf5_failure(const std::filesystem::path& path, const std::string& what) {
  std::string cause;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &cause);
  H5Eclear2(H5E_DEFAULT);
  throw FileError(text_of(path.string(), ": error: ", what, cause.empty() ? "" : ": ", system_words(cause)));
}

void quiet_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

Hdf5Handle hdf5_access(const std::filesystem::path& path) {
  Hdf5Handle access = hdf5_made(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "cannot be opened");
#if H5_VERSION_GE(1, 10, 7)
  hdf5_done(H5Pset_file_locking(access.id(), false, true), path, "cannot be opened");
#endif
  return access;
}

}  // namespace greenwater
