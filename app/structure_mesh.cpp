#include "app/structure_mesh.hpp"

#include "app/plate_frame.hpp"

namespace greenwater {
namespace {

/// A box along three axes at right angles, or two: right, over (the width) and up, right x over = up.
struct Block {
  PlateFrame frame;
  double right = 0, over = 0, up = 0;  // [m]
};

/// right x over = up: in a 2-D scene, where y is up, the width goes along -z.
void set_width_of_2d_scene(Block& block, double width) {
  block.frame.over = {0, 0, -1};
  block.frame.corner[2] = width / 2;
}

SolidMesh mesh_of(const Block& block, const Divisions& n) {
  const bool flat = n.size() == 2;
  const std::array<int, 3> divisions{static_cast<int>(n[0]), static_cast<int>(flat ? n[1] : n[2]),
                                     static_cast<int>(flat ? 1 : n[1])};
  const Point high = flat ? Point{block.right, block.up, 0} : Point{block.right, block.over, block.up};
  SolidMesh mesh = box_mesh(flat ? 2 : 3, {0, 0, 0}, high, divisions);
  for (Point& x : mesh.nodes) {
    const Point at = flat ? Point{x[0], 0, x[1]} : x;
    for (std::size_t d = 0; d < 3; ++d) {
      x[d] = block.frame.corner[d] + at[0] * block.frame.right[d] + at[1] * block.frame.over[d] +
             at[2] * block.frame.up[d];
    }
  }
  return mesh;
}

}  // namespace

SolidMesh mesh_of(const PlateCase& plate, int dimension, const Divisions& divisions) {
  Block block{frame_of(plate, dimension), plate.thickness, plate.width, plate.height};
  if (dimension == 2 && divisions.size() == 3) set_width_of_2d_scene(block, plate.width);
  return mesh_of(block, divisions);
}

SolidMesh mesh_of_box(const Point& min, const Point& max, double width, int dimension, const Divisions& divisions) {
  Block block{{{0, 1, 0}, {1, 0, 0}, {0, 0, 0}, min}, max[0] - min[0], width, max[1] - min[1]};
  Divisions along = divisions;
  if (dimension == 3) {
    block = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, min}, max[0] - min[0], max[1] - min[1], max[2] - min[2]};
    std::swap(along[1], along[2]);
  } else if (divisions.size() == 3) {
    set_width_of_2d_scene(block, width);
  }
  return mesh_of(block, along);
}

}  // namespace greenwater
