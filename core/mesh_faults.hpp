#pragma once
// What can be wrong with a surface of triangles, in words, and the mending of what can be mended without guessing.

#include <string>
#include <vector>

#include "core/triangle_mesh.hpp"

namespace greenwater {

/// Below this part of its longest edge the smallest height of a triangle makes it a sliver: its normal is noise.
inline constexpr coord sliver_height = 1e-6;

/// A loop of edges that belong to one triangle only.
struct MeshHole {
  int edges = 0;
  coord length = 0;               // round it [m]
  std::array<coord, 3> centre{};  // mean of its corners [m]
};

struct MeshFaults {
  /// Each in words, with how many there are and the first of them: its triangle, counted from 1, and coordinates.
  std::vector<std::string> words;
  /// No fault as such: an open tank has one. Largest first.
  std::vector<MeshHole> holes;

  bool sound() const { return words.empty(); }
  bool closed() const { return holes.empty(); }
};

/// Looks for triangles without area, slivers, triangles that are there twice, vertices on the edge of a triangle that
/// does not end there, edges of more than two triangles, neighbours that face opposite ways, and closed parts that are
/// inside out. A closed part within another is a cavity and has to face inwards. Surfaces that cut each other are not
/// found.
MeshFaults find_faults(const TriangleMesh& mesh);

/// The holes in words; empty when there is none.
std::string words_of(const std::vector<MeshHole>& holes);

/// Welds vertices that are 1e-6 of the mesh apart, takes out what has no area or is there twice, collapses or turns
/// slivers, ends edges where a vertex lies on them, and turns triangles until neighbours agree and closed parts face
/// outwards. Nothing moves by more than about 1e-6 of the mesh, and no hole is closed. Returns what was done in words;
/// find_faults() tells what is left.
std::vector<std::string> mend(TriangleMesh& mesh);

}  // namespace greenwater
