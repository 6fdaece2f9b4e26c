#include "kernels/cut_cells.hpp"

#include <algorithm>
#include <cmath>

#include "core/lanes.hpp"

namespace greenwater {
namespace {

using Place = std::array<coord, 3>;

// The cell of x, or -1 outside the grid.
int cell_at(const GridShape& grid, const Place& x, int dim) {
  int cell = 0;
  for (int d = dim - 1; d >= 0; --d) {
    const coord at = std::floor((x[d] - grid.origin[d]) / grid.cell);
    if (!(at >= 0 && at < grid.cells[d])) return -1;
    cell = cell * grid.cells[d] + static_cast<int>(at);
  }
  return cell;
}

Place centre_of(const GridShape& grid, const std::array<int, 3>& cell, int dim) {
  Place x{};
  for (int d = 0; d < dim; ++d) x[d] = grid.origin[d] + (cell[d] + 0.5) * grid.cell;
  return x;
}

// Calls f(cell) for those that the face may pass through: within half a diagonal of their centres.
template <class F>
void for_each_cell(const FaceCorners& corner, int dim, const GridShape& grid, F f) {
  std::array<int, 3> low{}, high{}, c;
  for (int d = 0; d < dim; ++d) {
    coord from = corner[0][d], to = from;
    for (int e = 1; e < dim; ++e) {
      from = std::min(from, corner[e][d]);
      to = std::max(to, corner[e][d]);
    }
    low[d] = grid.along(d, from);
    high[d] = grid.along(d, to);
  }
  for (c[2] = low[2]; c[2] <= high[2]; ++c[2])
    for (c[1] = low[1]; c[1] <= high[1]; ++c[1])
      for (c[0] = low[0]; c[0] <= high[0]; ++c[0])
        if (distance_to_face(corner, dim, centre_of(grid, c, dim)) <= 0.5 * std::sqrt(dim) * grid.cell) f(c);
}

}  // namespace

bool CutCells::known(const WallFaces& faces, const GridShape& grid) const {
  return faces.faces.size() == faces_.size() && grid.cell == grid_.cell &&
         std::equal(grid.cells, grid.cells + 3, grid_.cells) &&
         std::equal(grid.origin, grid.origin + 3, grid_.origin) &&
         std::equal(faces.faces.begin(), faces.faces.end(), faces_.begin(),
                    [](const WallFace& a, const FaceCorners& b) { return corners_of(a) == b; });
}

void CutCells::find(const WallFaces& faces, const GridShape& grid) {
  grid_ = grid;
  faces_.clear();
  cut_.clear();
  const int dim = faces.dim;
  const coord away = (std::sqrt(dim) + 0.05) * grid.cell;  // a cell that far from the plane is not cut itself
  for (const WallFace& face : faces.faces) {
    const FaceCorners& corner = faces_.emplace_back(corners_of(face));
    const Place normal = face_normal(corner, dim);
    if (normal == Place{}) continue;  // of no size
    for_each_cell(corner, dim, grid, [&](const std::array<int, 3>& cell) {
      Place foot = centre_of(grid, cell, dim), sides[2];
      coord height = 0;
      for (int d = 0; d < dim; ++d) height += (foot[d] - corner[0][d]) * normal[d];
      for (int d = 0; d < dim; ++d) foot[d] -= height * normal[d];
      for (int s = 0; s < 2; ++s)
        for (int d = 0; d < 3; ++d) sides[s][d] = foot[d] + (s == 0 ? away : -away) * normal[d];
      const int one = cell_at(grid, sides[0], dim), other = cell_at(grid, sides[1], dim);
      if (one >= 0 && other >= 0) cut_.push_back({cell, {one, other}});
    });
  }
}

const std::vector<std::array<int, 3>>& CutCells::nodes(const WallFaces& faces, const CellGrid& grid) {
  if (!known(faces, grid.shape())) find(faces, grid.shape());
  nodes_.clear();
  if (cut_.empty()) return nodes_;
  if (on_host || first_.extent(0) != grid.first().extent(0)) first_ = Kokkos::create_mirror_view(grid.first());
  Kokkos::deep_copy(first_, grid.first());
  const auto occupied = [&](int cell) { return first_(cell + 1) > first_(cell); };
  for (const Cut& cut : cut_) {
    if (!occupied(cut.beside[0]) || !occupied(cut.beside[1])) continue;
    for (int corner = 0; corner < (faces.dim == 2 ? 4 : 8); ++corner)
      nodes_.push_back({cut.cell[0] + (corner & 1), cut.cell[1] + (corner >> 1 & 1), cut.cell[2] + (corner >> 2)});
  }
  const auto before = [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  };
  std::sort(nodes_.begin(), nodes_.end(), before);
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  return nodes_;
}

}  // namespace greenwater
