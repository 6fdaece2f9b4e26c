#pragma once
// The background grid: cells of one interaction radius at a fixed origin, and the particles sorted into them.

#include <array>
#include <string>

#include "core/lanes.hpp"
#include "core/particles.hpp"

namespace greenwater {

/// Where the cells are. x runs fastest, so that three neighbouring cells of a row hold consecutive particles.
struct GridShape {
  coord origin[3] = {0, 0, 0};  // lowest corner [m]
  coord cell = 1;               // edge length [m], a little over the largest radius
  int cells[3] = {1, 1, 1};     // in x, y, z; the last one of an axis that repeats may be narrower
  coord period[3] = {0, 0, 0};  // after which space repeats itself, from the origin on [m]; 0: it does not

  KOKKOS_INLINE_FUNCTION int count() const { return cells[0] * cells[1] * cells[2]; }
  KOKKOS_INLINE_FUNCTION bool repeats() const { return period[0] > 0 || period[1] > 0 || period[2] > 0; }

  /// Cell index along one axis, kept inside the grid; 0 of what is not a number.
  KOKKOS_INLINE_FUNCTION int along(int axis, coord x) const {
    const coord k = floor((x - origin[axis]) / cell);
    return k >= cells[axis] ? cells[axis] - 1 : k > 0 ? static_cast<int>(k) : 0;
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

/// Where space repeats itself, of all ways that differ by whole periods the shortest; of a way, or of a pack of them.
template <int Dim, class V>
KOKKOS_INLINE_FUNCTION Vec<Dim, V> shortest_way(const GridShape& grid, Vec<Dim, V> way) {
  for (int d = 0; d < Dim; ++d) {
    const coord period = grid.period[d], half = period / 2;
    if (period > 0) way[d] = select(way[d] > half, way[d] - period, select(way[d] < -half, way[d] + period, way[d]));
  }
  return way;
}

/// The way from x_i to a particle at x_j: the shortest one.
template <int Dim, class V>
KOKKOS_INLINE_FUNCTION Vec<Dim, V> way_between(const GridShape& grid, const Vec<Dim, V>& xi, const Vec<Dim, V>& xj) {
  const auto way = difference(xj, xi);
  return grid.repeats() ? shortest_way(grid, way) : way;
}

/// Cells along each axis around a place; where space repeats itself, a second range beyond the edge, and how far particles
/// in it have to be moved to be beside the place.
struct CellRanges {
  int low[3][2], high[3][2];
  coord move[3] = {0, 0, 0};  // of the second range [m]
  int ranges[3] = {1, 1, 1};

  template <int Dim>
  KOKKOS_INLINE_FUNCTION static CellRanges around(const GridShape& grid, const Vec<Dim, coord>& x) {
    CellRanges made{};
    for (int d = 0; d < 3; ++d) made.ranges[d] = 1;
    for (int d = 0; d < Dim; ++d) {
      const int k = grid.along(d, x[d]);
      made.low[d][0] = k > 0 ? k - 1 : 0;
      made.high[d][0] = k + 1 < grid.cells[d] ? k + 1 : k;
      const coord period = grid.period[d];
      if (period == 0) continue;
      const bool before = x[d] - grid.cell<grid.origin[d], after = x[d] + grid.cell> grid.origin[d] + period;
      if (!before && !after) continue;
      made.ranges[d] = 2;
      made.move[d] = before ? -period : period;
      made.low[d][1] = before ? grid.along(d, x[d] - grid.cell + period) : 0;
      made.high[d][1] = before ? grid.cells[d] - 1 : grid.along(d, x[d] + grid.cell - period);
    }
    return made;
  }
};

/// Calls f(first, last, move) for the stretches of particles in the cells around x: the cells of a grid row lie side by side
/// in memory. `first` says where each cell begins; particles have to be moved by `move`, whole periods, to be there.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_stretch(const GridShape& grid, const int* first, const Vec<Dim, coord>& x, F f) {
  const auto cells = CellRanges::around<Dim>(grid, x);
  for (int rz = 0; rz < cells.ranges[2]; ++rz)
    for (int cz = cells.low[2][rz]; cz <= cells.high[2][rz]; ++cz)
      for (int ry = 0; ry < cells.ranges[1]; ++ry)
        for (int cy = cells.low[1][ry]; cy <= cells.high[1][ry]; ++cy)
          for (int rx = 0; rx < cells.ranges[0]; ++rx) {
            const int row = (cz * grid.cells[1] + cy) * grid.cells[0], of_axis[3] = {rx, ry, rz};
            Vec<Dim, coord> move;
            for (int d = 0; d < Dim; ++d) move[d] = of_axis[d] == 1 ? cells.move[d] : coord(0);
            f(first[row + cells.low[0][rx]], first[row + cells.high[0][rx] + 1], move);
          }
}

/// Calls f(j) for every particle in the cells around x, in order.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_candidate(const GridShape& grid, const Read<IndexField>& first,
                                               const Vec<Dim, coord>& x, F f) {
  for_each_stretch<Dim>(grid, first.data(), x, [&](const int begin, const int end, const Vec<Dim, coord>&) {
    for (int j = begin; j < end; ++j) f(j);
  });
}

/// A grid over the box [low, high] with cells a little wider than `radius`; along axes where it `repeats` the box is a
/// period, and must be at least `shortest_period` cells long.
/// Throws ResourceError when the box would need more cells than can be numbered.
constexpr int shortest_period = 4;  // no particle sees another one twice
GridShape make_grid(int dim, const std::array<coord, 3>& low, const std::array<coord, 3>& high, coord radius,
                    const std::array<bool, 3>& repeats = {});

/// Who left in a sort.
struct Departed {
  int outside = 0;       // beyond the grid
  int not_a_number = 0;  // nowhere: a coordinate is inf or nan
};

/// Particles in cell order, made anew every step by a stable counting sort: the same order at any number of threads.
class CellGrid {
 public:
  explicit CellGrid(const GridShape& shape = {}) : shape_(shape) {}

  /// Sorts all fields of the particles by cell. Those that are not in the grid leave; where space repeats itself they come
  /// in again on the other side.
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
