#pragma once
// Who is near whom: for each particle a row of neighbours and a row of images, each entry with the weight of the
// pressure operator beside it. Rebuilt every step, as everything has moved (a list that lives longer must reach
// further, and pays for it in every sum).

#include "kernels/cell_grid.hpp"
#include "kernels/mirror_wall.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// Compressed rows: the entries of particle i are first(i) ... first(i + 1) - 1.
struct Rows {
  std::int64_t entries = 0;
  OffsetField first;
  IndexField index;    // neighbour j
  ScalarField weight;  // w of the Laplacian's radius, at the positions of the last build [-]; empty when not kept
};

/// Rows of images: entry k is the image of index(k) in mirror number mirror(k). A particle may be its own neighbour here.
struct ImageRows {
  std::int64_t entries = 0;
  OffsetField first;
  IndexField index;
  IndexField mirror;
  ScalarField weight;
};

/// Device view of both rows, at the positions that the particles have now.
template <int Dim>
struct Around {
  Read<CoordField> x;
  Read<OffsetField> first, image_first;
  Read<IndexField> index, image_index, image_mirror;
  Kokkos::View<const Mirror*, Device> mirrors;

  /// Calls f(j, r_ij, m) for every neighbour and every image of particle i, in the same order each time. r_ij points
  /// from i to the neighbour or image [m]; m is the mirror of an image, null for a neighbour.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each(int i, F f) const {
    const auto xi = load<Dim>(x, i);
    for (auto k = first(i); k < first(i + 1); ++k) {
      const int j = index(k);
      f(j, narrow(difference(load<Dim>(x, j), xi)), static_cast<const Mirror*>(nullptr));
    }
    if (image_first.extent(0) == 0) return;
    for (auto k = image_first(i); k < image_first(i + 1); ++k) {
      const int j = image_index(k);
      const Mirror* m = &mirrors(image_mirror(k));
      f(j, narrow(difference(image_position(*m, load<Dim>(x, j)), xi)), m);
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION static Vec<Dim> narrow(const Vec<Dim, coord>& r) {
    Vec<Dim> s;
    for (int d = 0; d < Dim; ++d) s[d] = static_cast<real>(r[d]);
    return s;
  }
};

struct RowOptions {
  Weight weight;             // whose values stand beside the entries
  coord radius = 0;          // of the search: the largest of all weights; at most the grid's cell [m]
  bool keep_weights = true;  // false: whoever needs a weight computes it; a third of the memory
};

class NeighborRows {
 public:
  /// Finds all neighbours and images within the search radius of each particle. The particles must have been sorted
  /// into the grid just before. Capacity grows by itself: rows are counted before they are filled.
  void build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls, const RowOptions& options);

  template <int Dim>
  Around<Dim> around(const Particles& particles) const {
    return {particles.position, near.first, images.first, near.index, images.index, images.mirror, mirrors};
  }

  Rows near;
  ImageRows images;  // without walls: never allocated
  Kokkos::View<const Mirror*, Device> mirrors;
};

}  // namespace greenwater
