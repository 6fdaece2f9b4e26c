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
  enum class Section { field_data, point_data, points, verts, lines };

  Vtp(std::size_t points, std::size_t verts, std::size_t lines);

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

  std::size_t points_, verts_, lines_;
  std::string sections_[5];
  std::string data_;
};

}  // namespace greenwater
