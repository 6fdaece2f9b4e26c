#include "io/paraview.hpp"

#include <fmt/format.h>

#include <numeric>
#include <optional>

#include "core/check.hpp"
#include "io/file.hpp"
#include "io/vtp.hpp"

namespace greenwater {
namespace {

constexpr int vtk_axes = 3;

std::vector<std::int32_t> counting(std::size_t count, std::int32_t first) {
  std::vector<std::int32_t> numbers(count);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

std::string particles(const Table& table) {
  Vtp vtp({.points = table.rows, .verts = table.rows});
  vtp.add_time(table.time);
  for (const Column& column : table.columns) {
    if (column.name == "position") {
      vtp.add(Vtp::Section::points, "Points", column);
    } else {
      vtp.add(Vtp::Section::point_data, column.name, column);
    }
  }
  vtp.add(Vtp::Section::verts, "connectivity", 1, counting(table.rows, 0));
  vtp.add(Vtp::Section::verts, "offsets", 1, counting(table.rows, 1));
  return vtp.text();
}

/// The cells of one section, as VTK has them: the points of each, one cell after the other, and where each ends.
struct Cells {
  std::vector<std::int32_t> connectivity, offsets;

  void add(std::int32_t first_point, std::size_t corners) {
    for (std::size_t i = 0; i < corners; ++i) connectivity.push_back(first_point + static_cast<std::int32_t>(i));
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
  }
  void write(Vtp& vtp, Vtp::Section section) const {
    vtp.add(section, "connectivity", 1, connectivity);
    vtp.add(section, "offsets", 1, offsets);
  }
};

std::string shapes(const std::vector<WallShape>& walls, std::optional<double> time) {
  std::vector<float> points;
  Cells lines, polys;
  for (const WallShape& wall : walls) {
    expect(wall.size() >= 2);
    Cells& cells = wall.size() == 2 ? lines : polys;
    cells.add(static_cast<std::int32_t>(points.size() / vtk_axes), wall.size());
    for (const auto& corner : wall) {
      for (const double coordinate : corner) points.push_back(static_cast<float>(coordinate));
    }
  }
  Vtp vtp({.points = points.size() / vtk_axes, .lines = lines.offsets.size(), .polys = polys.offsets.size()});
  if (time) vtp.add_time(*time);
  vtp.add(Vtp::Section::points, "Points", vtk_axes, points);
  lines.write(vtp, Vtp::Section::lines);
  polys.write(vtp, Vtp::Section::polys);
  return vtp.text();
}

}  // namespace

Paraview::Paraview(const std::filesystem::path& folder, const std::string& name) : folder_(folder), name_(name) {
  make_folder(folder / name);
}

void Paraview::write(const Table& table) {
  require_room(folder_, vtp_bytes(table));
  add(table.time, "vtp", particles(table));
}

void Paraview::write(double time, const std::vector<WallShape>& walls) {
  const std::string text = shapes(walls, time);
  require_room(folder_, static_cast<double>(text.size()));
  add(time, "vtp", text);
}

void Paraview::write(const SolidMesh& mesh, const SolidFrame& frame) {
  const std::string text = vtu_text(mesh, frame);
  require_room(folder_, static_cast<double>(text.size()));
  add(frame.time, "vtu", text);
}

void Paraview::add(double time, const char* format, const std::string& text) {
  const std::string file = fmt::format("{0}/{0}_{1:06d}.{2}", name_, frames_, format);
  write_atomically(folder_ / file, text);
  entries_ += fmt::format("<DataSet timestep=\"{:.9g}\" part=\"0\" file=\"{}\"/>\n", time, file);
  write_atomically(folder_ / (name_ + ".pvd"),
                   "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n" + entries_ +
                       "</Collection>\n</VTKFile>\n");
  ++frames_;
}

void write_walls(const std::filesystem::path& path, const std::vector<WallShape>& walls) {
  write_atomically(path, shapes(walls, std::nullopt));
}

double vtp_bytes(const Table& table) {
  constexpr double header = 4e3, per_row = 8;  // text; connectivity and offset
  double bytes = header + per_row * static_cast<double>(table.rows);
  for (const Column& column : table.columns) {
    const double width = column.components > 1 ? vtk_axes : 1;
    const double size = column.values.index() < 2 ? 4 : column.values.index() == 2 ? 8 : 1;
    bytes += width * size * static_cast<double>(table.rows);
  }
  return bytes;
}

}  // namespace greenwater
