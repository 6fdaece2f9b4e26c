#include "io/vtp.hpp"

#include <fmt/format.h>

namespace greenwater {

std::string Vtp::text() const {
  const auto section = [&](Section which) -> const std::string& { return sections_[static_cast<int>(which)]; };
  return arrays_.file("PolyData",
                      fmt::format("<FieldData>\n{}</FieldData>\n"
                                  "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" "
                                  "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n"
                                  "<PointData>\n{}</PointData>\n<Points>\n{}</Points>\n<Verts>\n{}</Verts>\n"
                                  "<Lines>\n{}</Lines>\n<Polys>\n{}</Polys>\n</Piece>\n",
                                  field_data_, counts_.points, counts_.verts, counts_.lines, counts_.polys,
                                  section(Section::point_data), section(Section::points), section(Section::verts),
                                  section(Section::lines), section(Section::polys)));
}

}  // namespace greenwater
