#include "io/vtk_arrays.hpp"

#include <fmt/format.h>

#include <bit>

#include "core/check.hpp"

namespace greenwater {
namespace {

static_assert(std::endian::native == std::endian::little, "the header of the file says LittleEndian");

int width_of(const Column& column) { return column.components == 2 ? 3 : column.components; }

/// Real values in float32, vectors with the missing component as 0.
std::vector<float> padded(const Column& column, std::size_t rows) {
  const auto components = static_cast<std::size_t>(column.components);
  const auto width = static_cast<std::size_t>(width_of(column));
  std::vector<float> out(rows * width, 0.0F);
  std::visit(
      [&](const auto& values) {
        for (std::size_t i = 0; i < rows; ++i) {
          for (std::size_t d = 0; d < components; ++d) {
            out[i * width + d] = static_cast<float>(values[i * components + d]);
          }
        }
      },
      column.values);
  return out;
}

}  // namespace

std::string VtkArrays::add(const std::string& name, const Column& column, std::size_t rows) {
  const auto length = std::visit([](const auto& values) { return values.size(); }, column.values);
  expect(length == rows * static_cast<std::size_t>(column.components));
  if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&column.values)) {
    return add(name, column.components, *whole);
  }
  if (const auto* flags = std::get_if<std::vector<std::uint8_t>>(&column.values)) {
    return add(name, column.components, *flags);
  }
  return add(name, width_of(column), padded(column, rows));
}

std::string VtkArrays::add_time(double time) {
  const std::string element = fmt::format(
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"appended\" "
      "offset=\"{}\"/>\n",
      bytes_.size());
  append(&time, sizeof time);
  return element;
}

std::string VtkArrays::file(const std::string& grid, const std::string& inside) const {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<{0}>\n{1}</{0}>\n<AppendedData encoding=\"raw\">\n_",
      grid, inside);
  text += bytes_;
  text += "\n</AppendedData>\n</VTKFile>\n";
  return text;
}

std::string VtkArrays::declared(const std::string& name, const char* type, int components) const {
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n", type, name,
      components, bytes_.size());
}

void VtkArrays::append(const void* first, std::size_t bytes) {
  const auto length = static_cast<std::uint64_t>(bytes);
  bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
  if (bytes > 0) bytes_.append(static_cast<const char*>(first), bytes);
}

}  // namespace greenwater
