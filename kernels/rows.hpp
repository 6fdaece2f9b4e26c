#pragma once
// Rows of neighbours, sliced: as many rows as there are lanes lie side by side, entry k of all of them together. So a
// vector register on a CPU, or a warp on a GPU, reads consecutive memory.
//
// Every chunk of rows is as long as its longest row and begins where the one before it ended, or wherever there was room:
// chunks of one fixed length would let the prefetcher stumble at every step from one to the next.

#include "core/lanes.hpp"

namespace greenwater {

inline constexpr int chunks_of(int count) { return (count + row_lanes - 1) / row_lanes; }

/// The rows of the pressure operator. Row i: first its neighbours, then the particles whose images it sees (an image has
/// the pressure of its particle; those of i itself drop out), then fillers: i itself with weight 0.
struct Rows {
  std::int64_t entries = 0;  // neighbours
  std::int64_t stored = 0;   // places in use, with images and fillers
  OffsetField first;         // (chunk) place of the first entry of its first row
  IndexField length;         // (chunk) entries of its longest row
  IndexField number;         // (i) neighbours of i
  IndexField index;          // (place) neighbour j
  FloatField weight;      // (place) w of the Laplacian's radius, times the share of an image, at the positions of the
                          // last build [-]; empty when not kept
  AccumField weight_sum;  // (i) sum of the row's weights as they are stored [-]

  /// Place of entry k of row i.
  KOKKOS_INLINE_FUNCTION std::int64_t place(int i, int k) const {
    return first(i / row_lanes) + static_cast<std::int64_t>(k) * row_lanes + i % row_lanes;
  }
};

/// The images that each particle sees, sliced alike. A particle may see its own image.
struct ImageRows {
  std::int64_t entries = 0;
  std::int64_t stored = 0;
  OffsetField first;  // (chunk)
  IndexField length;  // (chunk), mostly 0
  IndexField number;  // (i) images that i sees
  IndexField index;   // (place) particle j
  IndexField mirror;  // (place) by which its image is made
  ScalarField share;  // (place) with which the image counts [-]: 1 but near the edges of corners

  KOKKOS_INLINE_FUNCTION std::int64_t place(int i, int k) const {
    return first(i / row_lanes) + static_cast<std::int64_t>(k) * row_lanes + i % row_lanes;
  }
};

/// Kernels over packs of float_lanes rows; pack k begins with row float_lanes k.
inline Range row_packs(int count) { return Range(0, (count + float_lanes - 1) / float_lanes); }

// Entries that are fetched before they are needed, about a row of 2-D: two streams and a gather are too much for the CPU's
// own prefetching.
constexpr int entries_ahead = 24;

/// Adds sum_j w_ij x_j of the rows from i on, as many as `sum` has lanes.
/// One work item has a vector of rows on a CPU (one row each is four times slower) and one row on a GPU; the data are the
/// same.
template <class V, int parts, class T>
KOKKOS_INLINE_FUNCTION void add_row_products(const Rows& rows, const T* x, int i, V (&sum)[parts]) {
  constexpr int width = static_cast<int>(sizeof(V) / sizeof(T));
  using Index = Lanes<int, width>;
  using Weights = Lanes<float, width>;
  const int length = rows.length(i / row_lanes);
  const auto begin = rows.place(i, 0);
  const int* index = rows.index.data() + begin;
  const float* weight = rows.weight.data() + begin;
  for (int k = 0; k < length; ++k, index += row_lanes, weight += row_lanes) {
    prefetch(index + entries_ahead * row_lanes);
    prefetch(weight + entries_ahead * row_lanes);
    for (int part = 0; part < parts; ++part)
      sum[part] += convert_lanes<V>(load_lanes<Weights>(weight + part * width)) *
                   gather_lanes<V>(x, load_lanes<Index>(index + part * width));
  }
}

template <class V, class T>
KOKKOS_INLINE_FUNCTION V row_product(const Rows& rows, const T* x, int i) {
  V sum[1] = {};
  add_row_products(rows, x, i, sum);
  return sum[0];
}

}  // namespace greenwater
