#pragma once
// Closed surfaces with known volumes, and STL files of them. All face outwards.

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <sstream>
#include <string>

#include "core/triangle_mesh.hpp"

namespace greenwater::test {

inline TriangleMesh box_mesh(const std::array<coord, 3>& min, const std::array<coord, 3>& max) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.vertices.push_back({(corner & 1) != 0 ? max[0] : min[0], (corner & 2) != 0 ? max[1] : min[1],
                             (corner & 4) != 0 ? max[2] : min[2]});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

/// A trough along y: two sides that slope from its lowest line at x = z = 0, two upright ends, and a flat lid or none.
struct VTank {
  coord half_angle = std::numbers::pi / 4;  // between a side and the vertical [rad]
  coord height = 1, length = 1;             // [m] along z, along y from 0
  bool open_top = false;

  coord half_width() const { return height * std::tan(half_angle); }                    // at the top [m]
  coord area_below(coord level) const { return level * level * std::tan(half_angle); }  // of the cross-section [m^2]
};

inline TriangleMesh v_tank_mesh(const VTank& tank) {
  const coord w = tank.half_width(), h = tank.height, l = tank.length;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, l, 0}, {-w, 0, h}, {-w, l, h}, {w, 0, h}, {w, l, h}};
  mesh.triangles = {{0, 4, 2}, {1, 3, 5}, {0, 1, 4}, {1, 5, 4}, {0, 2, 1}, {1, 2, 3}};
  if (!tank.open_top) {
    mesh.triangles.push_back({2, 4, 5});
    mesh.triangles.push_back({2, 5, 3});
  }
  return mesh;
}

/// About 2 rings^2 x 2 triangles with their corners on the sphere.
inline TriangleMesh sphere_mesh(const std::array<coord, 3>& centre, coord radius, int rings) {
  TriangleMesh mesh;
  const int sectors = 2 * rings;
  const auto add = [&](coord theta, coord phi) {
    mesh.vertices.push_back({centre[0] + radius * std::sin(theta) * std::cos(phi),
                             centre[1] + radius * std::sin(theta) * std::sin(phi),
                             centre[2] + radius * std::cos(theta)});
  };
  add(0, 0);
  for (int ring = 1; ring < rings; ++ring)
    for (int s = 0; s < sectors; ++s) add(std::numbers::pi * ring / rings, 2 * std::numbers::pi * s / sectors);
  add(std::numbers::pi, 0);
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int ring, int s) { return 1 + (ring - 1) * sectors + s % sectors; };
  for (int s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
    for (int ring = 1; ring + 1 < rings; ++ring) {
      mesh.triangles.push_back({at(ring, s), at(ring + 1, s), at(ring + 1, s + 1)});
      mesh.triangles.push_back({at(ring, s), at(ring + 1, s + 1), at(ring, s + 1)});
    }
  }
  return mesh;
}

inline TriangleMesh turned(TriangleMesh mesh, const std::array<coord, 3>& axis, coord angle) {
  turn(mesh, axis, angle);
  return mesh;
}

/// Both surfaces in one mesh.
inline TriangleMesh together(TriangleMesh mesh, const TriangleMesh& other) {
  const int shift = static_cast<int>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

inline std::string stl_text(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "solid test\n";
  for (const auto& triangle : mesh.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      const auto& x = mesh.vertices[static_cast<std::size_t>(corner)];
      text << "vertex " << x[0] << ' ' << x[1] << ' ' << x[2] << '\n';
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid test\n";
  return text.str();
}

/// `title` is the beginning of the first 80 bytes.
inline std::string stl_binary(const TriangleMesh& mesh, const std::string& title = "binary") {
  std::string bytes = title;
  bytes.resize(80, ' ');
  const auto add = [&](std::uint32_t value) {
    for (int byte = 0; byte < 4; ++byte) bytes += static_cast<char>((value >> (8 * byte)) & 0xFFU);
  };
  add(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) add(0);
    for (const int corner : triangle)
      for (const coord x : mesh.vertices[static_cast<std::size_t>(corner)])
        add(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    bytes += std::string(2, '\0');
  }
  return bytes;
}

}  // namespace greenwater::test
