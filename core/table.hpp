#pragma once
// Host data for files: named columns with units. Free of Kokkos, so that io never needs it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace greenwater {

/// One quantity for every row; a vector quantity has its components side by side (row-major).
struct Column {
  std::string name;    ///< as in the files: position, velocity, pressure ...
  std::string unit;    ///< SI, "-" without dimension
  int components = 1;  ///< 1, or the dimension of the scene
  std::variant<std::vector<double>, std::vector<float>, std::vector<std::int64_t>, std::vector<std::uint8_t>> values;
};

/// What the program hands to a file at one instant.
struct Table {
  std::string name;  ///< e.g. the fluid's name
  double time = 0;   ///< [s]
  std::int64_t step = 0;
  std::size_t rows = 0;
  std::vector<Column> columns;
};

}  // namespace greenwater
