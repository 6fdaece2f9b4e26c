#pragma once
// The background grid: cells of one interaction radius at a fixed origin, and the particles sorted into them.

#include <array>
#include <string>

#include "core/particles.hpp"

namespace greenwater {

/// Where the cells are. x runs fastest, so that three neighbouring cells of a row hold consecutive particles.
struct GridShape {
  coord origin[3] = {0, 0, 0};  // lowest corner [m]
  coord cell = 1;               // edge length [m], a little over the largest radius
  int cells[3] = {1, 1, 1};     // in x, y, z

  KOKKOS_INLINE_FUNCTION int count() const { return cells[0] * cells[1] * cells[2]; }

  /// Cell index along one axis, kept inside the grid.
  KOKKOS_INLINE_FUNCTION int along(int axis, coord x) const {
    const coord k = floor((x - origin[axis]) / cell);
    return k < 0 ? 0 : k >= cells[axis] ? cells[axis] - 1 : static_cast<int>(k);
  }

  template <int Dim>
  KOKKOS_INLINE_FUNCTION int cell_of(const Vec<Dim, coord>& x) const {
    int c = 0;
    for (int d = Dim - 1; d >= 0; --d) c = c * cells[d] + along(d, x[d]);
    return c;
  }

  /// False outside the grid, and for a position that is not a number.
  template <int Dim>
  KOKKOS_INLINE_FUNCTION bool holds(const Vec<Dim, coord>& x) const {
    for (int d = 0; d < Dim; ++d)
      if (!(x[d] >= origin[d] && x[d] < origin[d] + cells[d] * cell)) return false;
    return true;
  }
};

/// Calls f(j) for every particle in the cells around x, in order; `first` says where each cell begins. The three cells of
/// a grid row lie side by side in memory.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_candidate(const GridShape& grid, const Read<IndexField>& first,
                                               const Vec<Dim, coord>& x, F f) {
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  for (int d = 0; d < Dim; ++d) {
    const int k = grid.along(d, x[d]);
    low[d] = k > 0 ? k - 1 : 0;
    high[d] = k + 1 < grid.cells[d] ? k + 1 : k;
  }
  for (int cz = low[2]; cz <= high[2]; ++cz)
    for (int cy = low[1]; cy <= high[1]; ++cy) {
      const int row = (cz * grid.cells[1] + cy) * grid.cells[0];
      for (int j = first(row + low[0]); j < first(row + high[0] + 1); ++j) f(j);
    }
}

/// A grid over the box [low, high] with cells a little wider than `radius`.
/// Throws ResourceError when the box would need more cells than can be numbered.
GridShape make_grid(int dim, const std::array<coord, 3>& low, const std::array<coord, 3>& high, coord radius);

/// Who left in a sort.
struct Departed {
  int outside = 0;       // beyond the grid
  int not_a_number = 0;  // nowhere: a coordinate is inf or nan
};

/// Particles in cell order, made anew every step by a stable counting sort: the same order at any number of threads.
class CellGrid {
 public:
  explicit CellGrid(const GridShape& shape = {}) : shape_(shape) {}

  /// Sorts all fields of the particles by cell. Those that are not in the grid leave.
  Departed sort(Particles& particles);

  const GridShape& shape() const { return shape_; }
  /// Particles of cell c are first(c) ... first(c + 1) - 1.
  const IndexField& first() const { return first_; }

 private:
  GridShape shape_;
  IndexField first_, fill_, cell_, order_;
  Reorder reorder_;
};

}  // namespace greenwater
