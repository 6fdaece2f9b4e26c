#pragma once
// The .vtp format: points, lines and polygons.

#include <string>
#include <vector>

#include "io/vtk_arrays.hpp"

namespace greenwater {

/// Collects the arrays of one PolyData piece, then prints the file. Arrays are copied in: one frame at a time.
class Vtp {
 public:
  enum class Section { point_data, points, verts, lines, polys };
  struct Counts {
    std::size_t points = 0, verts = 0, lines = 0, polys = 0;
  };

  explicit Vtp(const Counts& counts) : counts_(counts) {}

  /// The time of the frame [s].
  void add_time(double time) { field_data_ += arrays_.add_time(time); }

  /// As VtkArrays::add(); columns have a row for each point.
  template <class T>
  void add(Section section, const std::string& name, int components, const std::vector<T>& values) {
    sections_[static_cast<int>(section)] += arrays_.add(name, components, values);
  }
  void add(Section section, const std::string& name, const Column& column) {
    sections_[static_cast<int>(section)] += arrays_.add(name, column, counts_.points);
  }

  /// The whole file.
  std::string text() const;

 private:
  Counts counts_;
  std::string field_data_, sections_[5];
  VtkArrays arrays_;
};

}  // namespace greenwater
