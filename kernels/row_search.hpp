#pragma once
// Everything that one row needs: who may be near, who is in sight, and how much it weighs. For both ways of building rows.

#include "kernels/neighbor_rows.hpp"

namespace greenwater {

/// The search for one particle after another. Pairs are judged from the lower index: both get the same answer, to the
/// last bit, where space does not repeat itself between them.
template <int Dim>
struct RowSearch {
  Read<CoordField> x;
  Read<IndexField> cell_first;
  GridShape grid;
  MirrorWalls walls;
  Weight density, laplacian;
  coord radius;     // of the search [m]
  bool one_weight;  // density and laplacian are the same function

  static constexpr int capacity = 96;  // walls and corners near one particle; with more it goes on, slower

  KOKKOS_INLINE_FUNCTION bool within_reach(coord r2) const { return r2 < radius * radius; }

  /// Where j is, or its repetition beside x_i.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> place_beside(const Vec<Dim, coord>& xi, const Vec<Dim, coord>& way,
                                                      int j) const {
    return grid.repeats() ? along(xi, coord(1), way) : load<Dim>(x, j);
  }

  /// Calls f(j, r^2) for every neighbour of i.
  template <class F>
  KOKKOS_INLINE_FUNCTION void neighbours(int i, F f) const {
    const auto xi = load<Dim>(x, i);
    auto sight = sight_from(walls, grid, xi);
    int room[capacity];
    sight.narrow(xi, radius, room, capacity);
    const bool in_the_open = sight.begin == sight.end;
    for_each_candidate<Dim>(grid, cell_first, xi, [&](const int j) {
      if (j == i) return;
      const auto way = way_between(grid, xi, load<Dim>(x, j));
      const coord r2 = dot(way, way);
      if (!within_reach(r2)) return;
      const auto xj = place_beside(xi, way, j);
      if (in_the_open || (i < j ? sight.sees(xi, xj) : sight.sees(xj, xi))) f(j, r2);
    });
  }

  /// Calls f(j, k, r^2, share) for every image, of particle j in mirror k, that i sees.
  template <class F>
  KOKKOS_INLINE_FUNCTION void images(int i, F f) const {
    const auto xi = load<Dim>(x, i);
    auto sight = sight_from(walls, grid, xi);
    int room[capacity];
    sight.narrow(xi, radius, room, capacity);
    if (sight.begin == sight.end) return;
    for_each_candidate<Dim>(grid, cell_first, xi, [&](const int j) {
      const auto way_to_j = way_between(grid, xi, load<Dim>(x, j));
      const coord r2 = dot(way_to_j, way_to_j);
      if (!within_reach(r2)) return;  // a path by way of walls is longer than the straight one
      const auto xj = place_beside(xi, way_to_j, j);
      const bool forward = i <= j;
      const auto &a = forward ? xi : xj, &b = forward ? xj : xi;
      for (int m = sight.begin; m < sight.end; ++m) {
        const int k = sight.reach[m];
        const int way = forward ? k : sight.mirror[k].reverse;
        const coord image_r2 = sight.image_distance2(way, a, b, r2);
        if (!within_reach(image_r2)) continue;
        const real share = sight.sees_image(way, a, b);
        if (share > 0) f(j, k, image_r2, share);
      }
    });
  }
};

}  // namespace greenwater
