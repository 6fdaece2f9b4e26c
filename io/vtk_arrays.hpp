#pragma once
// What ParaView's XML formats share: arrays whose elements stand in the text and whose values stand as raw bytes behind
// it, each behind its length in bytes.

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/table.hpp"

namespace greenwater {

/// VTK's name of a type of number.
template <class T>
constexpr const char* vtk_type() {
  if constexpr (std::is_same_v<T, float>) {
    return "Float32";
  } else if constexpr (std::is_same_v<T, std::int32_t>) {
    return "Int32";
  } else if constexpr (std::is_same_v<T, std::int64_t>) {
    return "Int64";
  } else {
    static_assert(std::is_same_v<T, std::uint8_t>);
    return "UInt8";
  }
}

/// Collects the arrays of one file, then prints the file. Arrays are copied in: one frame at a time.
class VtkArrays {
 public:
  /// Takes the values as they are, `components` of them for each point or cell. Returns the array's element for the
  /// text.
  template <class T>
  std::string add(const std::string& name, int components, const std::vector<T>& values) {
    std::string element = declared(name, vtk_type<T>(), components);
    append(values.data(), values.size() * sizeof(T));
    return element;
  }
  /// The values of a column of `rows` rows: real ones as Float32, whole ones as they are, vectors of two components with 0 as the
  /// third.
  std::string add(const std::string& name, const Column& column, std::size_t rows);
  /// The time of a frame [s], an array of its field data.
  std::string add_time(double time);

  /// The whole file: `grid` is VTK's name of the kind (PolyData ...), `inside` the text of its element.
  std::string file(const std::string& grid, const std::string& inside) const;

 private:
  std::string declared(const std::string& name, const char* type, int components) const;
  void append(const void* first, std::size_t bytes);

  std::string bytes_;
};

}  // namespace greenwater
