#include "kernels/mirror_wall.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr coord right_angle = 1e-9;  // cosine below which two faces meet at a right angle

// x' = x - 2 ((x - x_w) . n) n
Mirror mirror_of(const WallFace& wall) {
  Mirror m{};
  const coord x = wall.end[1][0] - wall.end[0][0], y = wall.end[1][1] - wall.end[0][1];
  const coord length = std::hypot(x, y);
  m.normal[0] = -y / length;
  m.normal[1] = x / length;
  for (int e = 0; e < 2; ++e)
    for (int d = 0; d < 3; ++d) m.end[e][d] = wall.end[e][d];
  coord foot = 0, speed = 0, acceleration = 0;  // normal components of the wall's place and motion
  for (int d = 0; d < 3; ++d) {
    foot += m.normal[d] * wall.end[0][d];
    speed += m.normal[d] * wall.velocity[d];
    acceleration += m.normal[d] * wall.acceleration[d];
  }
  for (int d = 0; d < 3; ++d) {
    for (int e = 0; e < 3; ++e) m.map[d][e] = (d == e ? 1 : 0) - 2 * m.normal[d] * m.normal[e];
    m.shift[d] = 2 * foot * m.normal[d];
    m.velocity[d] = static_cast<real>(2 * speed * m.normal[d]);
    m.acceleration[d] = static_cast<real>(acceleration * m.normal[d]);
  }
  m.face[0] = m.face[1] = -1;
  m.body = wall.body;
  return m;
}

coord cosine(const Mirror& f, const Mirror& g) { return f.normal[0] * g.normal[0] + f.normal[1] * g.normal[1]; }

coord distance_to_face(const Mirror& m, coord x, coord y) {
  const coord tx = m.end[1][0] - m.end[0][0], ty = m.end[1][1] - m.end[0][1];
  const coord s = std::clamp(((x - m.end[0][0]) * tx + (y - m.end[0][1]) * ty) / (tx * tx + ty * ty), 0.0, 1.0);
  return std::hypot(x - m.end[0][0] - s * tx, y - m.end[0][1] - s * ty);
}

// An end of one face on the other: they touch there.
bool touch(const Mirror& f, const Mirror& g, coord tolerance) {
  for (int e = 0; e < 2; ++e)
    if (distance_to_face(g, f.end[e][0], f.end[e][1]) < tolerance ||
        distance_to_face(f, g.end[e][0], g.end[e][1]) < tolerance)
      return true;
  return false;
}

// Both reflections in turn; at a right angle their order does not matter.
Mirror corner_of(const std::vector<Mirror>& faces, int i, int j) {
  const Mirror &f = faces[i], &g = faces[j];
  Mirror m{};
  for (int d = 0; d < 3; ++d) {
    m.shift[d] = f.shift[d] + g.shift[d];
    for (int e = 0; e < 3; ++e) m.map[d][e] = f.map[d][e] + g.map[d][e] - (d == e ? 1 : 0);
    m.velocity[d] = f.velocity[d] + g.velocity[d];
    m.acceleration[d] = f.acceleration[d] + g.acceleration[d];
    m.end[0][d] = m.end[1][d] = (f.shift[d] + g.shift[d]) / 2;  // foot points of the origin, at a right angle
  }
  m.face[0] = i;
  m.face[1] = j;
  m.body = -1;
  return m;
}

std::vector<Mirror> all_mirrors(const WallFaces& walls, coord tolerance) {
  std::vector<Mirror> mirrors;
  for (const WallFace& wall : walls.faces) mirrors.push_back(mirror_of(wall));
  const int faces = static_cast<int>(mirrors.size());
  for (int i = 0; i < faces; ++i)
    for (int j = i + 1; j < faces; ++j) {
      if (!touch(mirrors[i], mirrors[j], tolerance)) continue;
      const coord c = cosine(mirrors[i], mirrors[j]);
      require(std::fabs(c) < right_angle, "geometry: '", walls.bodies[mirrors[i].body], "' and '",
              walls.bodies[mirrors[j].body], "' meet at ", std::acos(std::min(std::fabs(c), 1.0)) * 180 / M_PI,
              " degrees: walls that touch must be at right angles to each other");
      mirrors.push_back(corner_of(mirrors, i, j));
    }
  return mirrors;
}

coord distance_to_mirror(const std::vector<Mirror>& mirrors, const Mirror& m, coord x, coord y) {
  if (m.face[0] < 0) return distance_to_face(m, x, y);
  return std::max(distance_to_face(mirrors[m.face[0]], x, y), distance_to_face(mirrors[m.face[1]], x, y));
}

// For each cell the mirrors within one radius of any point in it; and one bin more with all of them.
void bin(MirrorWalls& walls, const std::vector<Mirror>& mirrors, const GridShape& grid) {
  const coord within = grid.cell * (1 + std::sqrt(0.5));  // one radius from a corner of the cell, seen from its centre
  std::vector<int> first{0}, reach;
  for (int c = 0; c < grid.count(); ++c) {
    const coord x = grid.origin[0] + (c % grid.cells[0] + 0.5) * grid.cell;
    const coord y = grid.origin[1] + (c / grid.cells[0] % grid.cells[1] + 0.5) * grid.cell;
    for (int k = 0; k < static_cast<int>(mirrors.size()); ++k)
      if (distance_to_mirror(mirrors, mirrors[k], x, y) < within) reach.push_back(k);
    first.push_back(static_cast<int>(reach.size()));
  }
  for (int k = 0; k < static_cast<int>(mirrors.size()); ++k) reach.push_back(k);
  first.push_back(static_cast<int>(reach.size()));
  auto upload = [](const std::string& label, const std::vector<int>& from) {
    IndexField to = uncleared<IndexField>(label, from.size());
    Kokkos::deep_copy(to, Kokkos::View<const int*, Kokkos::HostSpace>(from.data(), from.size()));
    return to;
  };
  walls.first = upload("greenwater::mirror_first", first);
  walls.reach = upload("greenwater::mirror_reach", reach);
}

}  // namespace

MirrorWalls make_mirror_walls(const WallFaces& walls, const GridShape& grid, coord spacing) {
  MirrorWalls made;
  if (walls.faces.empty()) return made;
  made.tolerance = 1e-9 * spacing;
  const std::vector<Mirror> mirrors = all_mirrors(walls, 1e-6 * spacing);
  made.count = static_cast<int>(mirrors.size());
  made.mirror = uncleared<Kokkos::View<Mirror*, Device>>("greenwater::mirrors", mirrors.size());
  Kokkos::deep_copy(made.mirror, Kokkos::View<const Mirror*, Kokkos::HostSpace>(mirrors.data(), mirrors.size()));
  bin(made, mirrors, grid);
  return made;
}

}  // namespace greenwater
