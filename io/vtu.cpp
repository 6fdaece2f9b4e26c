#include "io/vtu.hpp"

#include <fmt/format.h>

#include "core/check.hpp"
#include "io/vtk_arrays.hpp"

namespace greenwater {
namespace {

constexpr std::uint8_t vtk_quad = 9, vtk_hexahedron = 12;

template <std::size_t Width>
std::vector<float> side_by_side(const std::vector<std::array<double, Width>>& rows) {
  std::vector<float> values;
  values.reserve(rows.size() * Width);
  for (const auto& row : rows) {
    for (const double value : row) values.push_back(static_cast<float>(value));
  }
  return values;
}

/// No element for a list that is left out.
template <std::size_t Width>
std::string added(VtkArrays& arrays, const std::string& name, const std::vector<std::array<double, Width>>& rows,
                  std::size_t count) {
  if (rows.empty()) return {};
  expect(rows.size() == count);
  return arrays.add(name, static_cast<int>(Width), side_by_side(rows));
}

std::string added(VtkArrays& arrays, const std::vector<Column>& columns, std::size_t rows) {
  std::string text;
  for (const Column& column : columns) text += arrays.add(column.name, column, rows);
  return text;
}

std::vector<std::array<double, 3>> moved_nodes(const SolidMesh& mesh, const SolidFrame& frame) {
  std::vector<std::array<double, 3>> places = mesh.nodes;
  for (std::size_t i = 0; i < frame.displacement.size(); ++i) {
    for (std::size_t d = 0; d < 3; ++d) places[i][d] += frame.displacement[i][d];
  }
  return places;
}

std::string cells(VtkArrays& arrays, const SolidMesh& mesh) {
  const int corners = mesh.nodes_per_element();
  std::vector<std::int32_t> connectivity, offsets;
  for (const auto& element : mesh.elements) {
    connectivity.insert(connectivity.end(), element.begin(), element.begin() + corners);
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(mesh.elements.size(), mesh.dim == 2 ? vtk_quad : vtk_hexahedron);
  std::string text = arrays.add("connectivity", 1, connectivity);
  text += arrays.add("offsets", 1, offsets);
  text += arrays.add("types", 1, types);
  return text;
}

}  // namespace

std::string vtu_text(const SolidMesh& mesh, const SolidFrame& frame) {
  const std::size_t nodes = mesh.nodes.size(), elements = mesh.elements.size();
  expect(frame.displacement.empty() || frame.displacement.size() == nodes);
  VtkArrays arrays;
  const std::string time = arrays.add_time(frame.time);
  std::string node_data = added(arrays, "displacement", frame.displacement, nodes);
  node_data += added(arrays, "velocity", frame.velocity, nodes);
  node_data += added(arrays, frame.node_data, nodes);
  std::string element_data = added(arrays, "stress", frame.stress, elements);
  element_data += added(arrays, frame.element_data, elements);
  const std::string points = arrays.add("Points", 3, side_by_side(moved_nodes(mesh, frame)));
  const std::string cell_arrays = cells(arrays, mesh);
  return arrays.file("UnstructuredGrid",
                     fmt::format("<FieldData>\n{}</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n"
                                 "<PointData>\n{}</PointData>\n<CellData>\n{}</CellData>\n<Points>\n{}</Points>\n"
                                 "<Cells>\n{}</Cells>\n</Piece>\n",
                                 time, nodes, elements, node_data, element_data, points, cell_arrays));
}

}  // namespace greenwater
