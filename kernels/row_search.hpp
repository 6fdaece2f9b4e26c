#pragma once
// Everything that one row needs: who may be near, who is in sight, and how much it weighs. For both ways of building rows.

#include "kernels/neighbor_rows.hpp"

namespace greenwater {

/// The search for one particle after another. Pairs are judged from the lower index: both get the same answer, to the
/// last bit.
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

  KOKKOS_INLINE_FUNCTION static coord distance2(const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) {
    const auto r = difference(b, a);
    return dot(r, r);
  }

  KOKKOS_INLINE_FUNCTION bool within_reach(coord r2) const { return r2 < radius * radius; }

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
      const auto xj = load<Dim>(x, j);
      const coord r2 = distance2(xi, xj);
      if (!within_reach(r2)) return;
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
      const auto xj = load<Dim>(x, j);
      const coord r2 = distance2(xi, xj);
      if (!within_reach(r2)) return;  // a path by way of walls is longer than the straight one
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
