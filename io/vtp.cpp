#include "io/vtp.hpp"

#include <fmt/format.h>

#include <bit>

namespace greenwater {

static_assert(std::endian::native == std::endian::little, "the header of the file says LittleEndian");

void Vtp::declare(Section section, const std::string& name, const char* type, int components, std::size_t values) {
  const bool field = section == Section::field_data;
  const std::string shape = field ? fmt::format("NumberOfTuples=\"{}\"", values / static_cast<std::size_t>(components))
                                  : fmt::format("NumberOfComponents=\"{}\"", components);
  sections_[static_cast<int>(section)] += fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" {} format=\"appended\" offset=\"{}\"/>\n", type, name, shape, data_.size());
}

void Vtp::append(const char* first, std::size_t bytes) {
  const auto length = static_cast<std::uint64_t>(bytes);
  data_.append(reinterpret_cast<const char*>(&length), sizeof length);
  if (bytes > 0) data_.append(first, bytes);
}

std::string Vtp::text() const {
  const auto section = [&](Section which) -> const std::string& { return sections_[static_cast<int>(which)]; };
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      "<FieldData>\n{}</FieldData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n"
      "<PointData>\n{}</PointData>\n<Points>\n{}</Points>\n<Verts>\n{}</Verts>\n<Lines>\n{}</Lines>\n"
      "<Polys>\n{}</Polys>\n"
      "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
      section(Section::field_data), counts_.points, counts_.verts, counts_.lines, counts_.polys,
      section(Section::point_data), section(Section::points), section(Section::verts), section(Section::lines),
      section(Section::polys));
  text += data_;
  text += "\n</AppendedData>\n</VTKFile>\n";
  return text;
}

}  // namespace greenwater
