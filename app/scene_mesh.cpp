// Walls from files: [geometry.NAME] with type = "stl", and the points of polylines.

#include <map>

#include "app/scene_parts.hpp"
#include "core/mesh_faults.hpp"
#include "io/data_file.hpp"
#include "io/number_file.hpp"
#include "io/stl.hpp"

namespace greenwater {
namespace {

std::string listed_below(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += "\n  - " + item;
  return text;
}

struct Wanted {
  bool closed = false, mended = false;
};

/// What keeps the mesh from use, in words.
std::vector<std::string> complaints_about(const TriangleMesh& mesh, const Wanted& wanted) {
  MeshFaults faults = find_faults(mesh);
  if (wanted.closed && !faults.closed()) {
    faults.words.push_back(words_of(faults.holes) +
                           "; closed = true wants none: fill them, or leave closed out for a tank that is open");
  }
  return faults.words;
}

/// Mends the mesh where that is wanted, and refuses what is left. Lengths in messages are those of the file, as that is
/// where the cure is. Returns what was done.
std::vector<std::string> settle(TriangleMesh& mesh, const Wanted& wanted, const DataFile& file,
                                const std::string& header) {
  const std::vector<std::string> before = complaints_about(mesh, wanted);
  if (before.empty()) return {};
  const std::vector<std::string> done = mend(mesh);
  const std::vector<std::string> after = complaints_about(mesh, wanted);
  if (!after.empty()) {
    refuse(file, {}, "the surface cannot be used", listed_below(wanted.mended ? after : before),
           "\n  (triangles as numbered", wanted.mended ? " after the repair" : " in the file",
           ", lengths in the unit of the file); ",
           wanted.mended ? "this is left after repair = \"mend\": " : "repair = \"mend\" would not mend all of it: ",
           "mend it in the program that made it");
  }
  require_at(file, {}, wanted.mended, "the surface cannot be used", listed_below(before),
             "\n  (triangles as numbered in the file, lengths in its unit); repair = \"mend\" in ", header,
             " would mend this: ", done.empty() ? "" : done.front(), done.size() > 1 ? " ..." : "");
  return done;
}

}  // namespace

double metres_in(const std::string& unit) {
  static const std::map<std::string, double> metres{{"m", 1}, {"mm", 1e-3}, {"cm", 1e-2}, {"in", 0.0254}};
  return metres.at(unit);
}

MeshCase read_mesh(const std::string& name, Section& section) {
  MeshCase mesh;
  mesh.name = name;
  mesh.place = section.place();
  const std::filesystem::path path = section.file("file", "tank.stl");
  const std::string unit = section.choice("unit", {"m", "mm", "cm", "in"}, std::string("m"));
  const Point axis = section.vector("axis", "-", 3, Point{0, 0, 1});
  const double angle = section.number("turn", "rad", any_number, 0.0);
  const Point by = section.vector("move", "m", 3, Point{0, 0, 0});
  const Wanted wanted{section.flag("closed", false),
                      section.choice("repair", {"refuse", "mend"}, std::string("refuse")) == "mend"};
  require_at(section.place("axis"), axis != Point{0, 0, 0}, "axis = [0, 0, 0] has no direction; write [0, 0, 1] for z");
  const Place place = section.place("file");
  mesh.closed = wanted.closed;
  mesh.mesh = read_stl(path, place);
  mesh.repairs = settle(mesh.mesh, wanted, {path.string(), {}, place}, section.header());
  scale(mesh.mesh, metres_in(unit));
  if (angle != 0) turn(mesh.mesh, axis, angle);
  move(mesh.mesh, by);
  return mesh;
}

std::vector<Point> read_point_file(const std::filesystem::path& path, const Place& place) {
  std::vector<Point> points;
  int line_before = 0;
  for (const NumberRow& row : read_number_rows(path, 2, place)) {
    const Point point{row.value[0], row.value[1], 0};
    require_at(place, points.empty() || points.back() != point, path.string(), ": lines ", line_before, " and ",
               row.line, " are the same point ", toml_point(point, 2), "; delete one of them");
    points.push_back(point);
    line_before = row.line;
  }
  return points;
}

}  // namespace greenwater
