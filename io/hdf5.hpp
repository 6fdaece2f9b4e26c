#pragma once
// Handles of the HDF5 library that close themselves, and calls that are checked.

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <utility>

namespace greenwater {

/// An open file, group, data set ... of HDF5; closed when it goes.
class Hdf5Handle {
 public:
  using Closer = herr_t (*)(hid_t);

  Hdf5Handle(hid_t id, Closer closer) : id_(id), closer_(closer) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) closer_(id_);
  }

  hid_t id() const { return id_; }
  /// Closes now and returns HDF5's own answer, which a destructor would have to swallow.
  herr_t close() { return closer_(std::exchange(id_, H5I_INVALID_HID)); }

 private:
  hid_t id_;
  Closer closer_;
};

/// Throws FileError with the path, what was tried, and the library's own reason.
[[noreturn]] void hdf5_failure(const std::filesystem::path& path, const std::string& what);

/// The handle, or FileError when the library returned none.
inline Hdf5Handle hdf5_made(hid_t id, Hdf5Handle::Closer closer, const std::filesystem::path& path,
                            const std::string& what) {
  if (id < 0) hdf5_failure(path, what);
  return {id, closer};
}

inline void hdf5_done(herr_t status, const std::filesystem::path& path, const std::string& what) {
  if (status < 0) hdf5_failure(path, what);
}

/// Stops the library from printing its error stack; the messages above take its place.
void quiet_hdf5();

/// How our files are opened: without locks, because a reader at work must not end a run.
Hdf5Handle hdf5_access(const std::filesystem::path& path);

}  // namespace greenwater
