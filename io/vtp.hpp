#pragma once
// The .vtp format: XML with the arrays as raw bytes at its end.

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace greenwater {

/// Collects the arrays of one PolyData piece, then prints the file. Arrays are copied in: one frame at a time.
class Vtp {
 public:
  enum class Section { field_data, point_data, points, verts, lines, polys };
  struct Counts {
    std::size_t points = 0, verts = 0, lines = 0, polys = 0;
  };

  explicit Vtp(const Counts& counts) : counts_(counts) {}

  /// `type` is VTK's name: Float32, Int32 ... ; `values` are written as they are.
  template <class T>
  void add(Section section, const std::string& name, const char* type, int components, const std::vector<T>& values) {
    const auto* first = reinterpret_cast<const char*>(values.data());
    declare(section, name, type, components, values.size());
    append(first, values.size() * sizeof(T));
  }

  /// The whole file.
  std::string text() const;

 private:
  void declare(Section section, const std::string& name, const char* type, int components, std::size_t values);
  void append(const char* first, std::size_t bytes);

  Counts counts_;
  std::string sections_[6];
  std::string data_;
};

}  // namespace greenwater
