#pragma once
// Where a wall has water on both sides: found on the host, from the walls' faces and the cells that hold particles.

#include <array>
#include <vector>

#include "core/wall_faces.hpp"
#include "kernels/cell_grid.hpp"

namespace greenwater {

class CutCells {
 public:
  /// Corners of the cells that a face may pass through while both the cells a good cell away on its one side and on its
  /// other hold particles; ascending in z, y, x. A floor or the wall of a tank has none.
  const std::vector<std::array<int, 3>>& nodes(const WallFaces& faces, const CellGrid& grid);

 private:
  struct Cut {
    std::array<int, 3> cell;
    int beside[2];  // the cells to look at
  };

  bool known(const WallFaces& faces, const GridShape& grid) const;
  void find(const WallFaces& faces, const GridShape& grid);

  std::vector<FaceCorners> faces_;  // that cut_ was found from
  GridShape grid_;
  std::vector<Cut> cut_;
  std::vector<std::array<int, 3>> nodes_;
  IndexField::host_mirror_type first_;
};

}  // namespace greenwater
