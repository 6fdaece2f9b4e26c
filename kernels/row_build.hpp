#pragma once
// The one-pass way of building rows on a host (kernels/neighbor_rows_host.cpp); neighbor_rows.cpp has the portable one.

#include "kernels/row_search.hpp"

namespace greenwater {

/// Places that a thread has taken in advance, so that its chunks follow each other without those of other threads between
/// them: with gaps at every chunk the CPU's prefetching fails, and each product of the operator takes half as long again.
struct Reserve {
  std::int64_t next = 0, end = 0;
};

/// Where chunks take their places, in whatever order they come.
struct RowStore {
  Rows near;
  ImageRows images;
  Kokkos::View<std::int64_t[4], Device> taken;  // places of rows and of images, then neighbours and images

  /// Takes places for a chunk of `longest` entries, of which `more` are to come. Returns the first one, or -1 when there is no
  /// room; then the count goes on, and tells how much would be needed.
  std::int64_t take_near(int chunk, int longest, int more, Reserve& reserve) const {
    return take(near, 0, chunk, longest, more, reserve);
  }
  std::int64_t take_images(int chunk, int longest) const {
    Reserve none;
    return take(images, 1, chunk, longest, 0, none);
  }

  void count(int neighbours, int mirrored) const {
    Kokkos::atomic_fetch_add(&taken(2), neighbours);
    if (mirrored > 0) Kokkos::atomic_fetch_add(&taken(3), mirrored);
  }

 private:
  template <class AnyRows>
  std::int64_t take(const AnyRows& rows, int which, int chunk, int longest, int more, Reserve& reserve) const {
    const std::int64_t size = static_cast<std::int64_t>(longest) * row_lanes;
    if (reserve.next + size > reserve.end) {
      const std::int64_t wanted =
          size + size * more * 15 / 16;  // a little too few: the rest is taken when it is needed
      reserve.next = Kokkos::atomic_fetch_add(&taken(which), wanted);
      reserve.end = reserve.next + wanted;
    }
    const std::int64_t place = reserve.next;
    reserve.next += size;
    rows.length(chunk) = longest;
    rows.first(chunk) = place;
    return place + size <= static_cast<std::int64_t>(rows.index.extent(0)) ? place : -1;
  }
};

template <int Dim>
void build_rows_on_host(const RowSearch<Dim>& search, const RowStore& store, const ScalarField& n, int count);

}  // namespace greenwater
