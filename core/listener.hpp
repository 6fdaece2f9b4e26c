#pragma once
// What Kokkos does while somebody listens: the kernels it launches, and the memory that its views hold. Free of Kokkos.

#include <cstdint>
#include <map>
#include <string>

namespace greenwater {

/// Listens from its construction to its end. One at a time: the second to be made takes over.
class Listener {
 public:
  Listener();
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Launches since the start or the last forget_launches(), all of them or those with this label.
  std::int64_t launches() const;
  std::int64_t launches(const std::string& label) const;
  const std::map<std::string, std::int64_t>& launches_by_label() const { return launches_; }
  void forget_launches() { launches_.clear(); }

  /// Held by views that were made since the start and are still there [bytes].
  std::int64_t bytes() const { return bytes_; }

  void hear_launch(const char* label) { ++launches_[label]; }
  void hear_memory(std::int64_t bytes) { bytes_ += bytes; }

 private:
  std::map<std::string, std::int64_t> launches_;
  std::int64_t bytes_ = 0;
};

}  // namespace greenwater
