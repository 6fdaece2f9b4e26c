#pragma once
// Walls and clouds of many shapes, and turning them.

#include <Eigen/Geometry>
#include <functional>

#include "tests/support.hpp"

namespace greenwater::test {

using Turn = Eigen::Matrix3d;

inline std::array<coord, 3> turned(const Turn& turn, const std::array<coord, 3>& x) {
  const Eigen::Vector3d y = turn * Eigen::Vector3d(x[0], x[1], x[2]);
  return {y[0], y[1], y[2]};
}

inline Positions turned(const Turn& turn, Positions x) {
  for (auto& point : x) point = turned(turn, point);
  return x;
}

inline WallFaces turned(const Turn& turn, WallFaces walls) {
  for (auto& face : walls.faces)
    for (auto& corner : face.corner) corner.position = turned(turn, corner.position);
  return walls;
}

inline Turn turn_about(double angle, const std::array<double, 3>& axis = {0, 0, 1}) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(axis[0], axis[1], axis[2]).normalized()).toRotationMatrix();
}

inline WallFace triangle(const std::array<coord, 3>& a, const std::array<coord, 3>& b, const std::array<coord, 3>& c,
                         int body = 0) {
  WallFace face;
  face.corner[0].position = a;
  face.corner[1].position = b;
  face.corner[2].position = c;
  face.body = body;
  return face;
}

/// a, b, c, d go round.
inline void add_rectangle(WallFaces& walls, const std::array<coord, 3>& a, const std::array<coord, 3>& b,
                          const std::array<coord, 3>& c, const std::array<coord, 3>& d, int body = 0) {
  walls.faces.push_back(triangle(a, b, c, body));
  walls.faces.push_back(triangle(a, c, d, body));
}

/// Walls of a 2-D scene drawn up from z = 0 to `height`.
inline WallFaces drawn_up(const WallFaces& flat, coord height) {
  WallFaces walls{3, {}, flat.bodies};
  for (const WallFace& face : flat.faces) {
    auto a = face.corner[0].position, b = face.corner[1].position, c = b, d = a;
    c[2] = d[2] = height;
    add_rectangle(walls, a, b, c, d, face.body);
  }
  return walls;
}

/// A floor and a lid for walls drawn up: rectangles at z = 0 and z = height.
inline void add_ends(WallFaces& walls, coord low, coord high, coord height) {
  for (const coord z : {coord(0), height})
    add_rectangle(walls, {low, low, z}, {high, low, z}, {high, high, z}, {low, high, z});
}

/// Two walls from the origin: one along x, one at `angle` from it.
inline WallFaces wedge(double angle, coord length) {
  return walls_of({segment(0, 0, length, 0), segment(0, 0, length * std::cos(angle), length * std::sin(angle), 1)});
}

inline bool in_wedge(const std::array<coord, 3>& x, double angle) {
  const double at = std::atan2(x[1], x[0]);
  return at > 0 && at < angle;
}

inline Positions only(const Positions& all, const std::function<bool(const std::array<coord, 3>&)>& wanted) {
  Positions x;
  std::copy_if(all.begin(), all.end(), std::back_inserter(x), wanted);
  return x;
}

/// A cubic lattice of cell centres, from the origin.
inline Positions lattice_3d(int nx, int ny, int nz, coord l0) {
  Positions x;
  for (int k = 0; k < nz; ++k)
    for (const auto& p : lattice(nx, ny, l0)) x.push_back({p[0], p[1], (k + 0.5) * l0});
  return x;
}

/// The box [0, x] x [0, y] x [0, z], without a lid.
inline WallFaces open_box(coord x, coord y, coord z) {
  WallFaces walls =
      drawn_up(walls_of({segment(0, 0, x, 0), segment(x, 0, x, y), segment(x, y, 0, y), segment(0, y, 0, 0)}), z);
  add_rectangle(walls, {0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0});
  return walls;
}

}  // namespace greenwater::test
