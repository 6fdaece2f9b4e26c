#pragma once
// The one-pass way of building rows on a host (kernels/neighbor_rows_host.cpp); neighbor_rows.cpp has the portable one.

#include "kernels/row_search.hpp"

namespace greenwater {

/// Where chunks take their places, in whatever order they come.
struct RowStore {
  Rows near;
  ImageRows images;
  Kokkos::View<std::int64_t[4], Device> taken;  // places of rows and of images, then neighbours and images

  /// Takes places for a chunk of `longest` entries. Returns the first one, or -1 when there is no room; then the count goes
  /// on, and tells how much would be needed.
  std::int64_t take_near(int chunk, int longest) const { return take(near, 0, chunk, longest); }
  std::int64_t take_images(int chunk, int longest) const { return take(images, 1, chunk, longest); }

  void count(int neighbours, int mirrored) const {
    Kokkos::atomic_fetch_add(&taken(2), neighbours);
    if (mirrored > 0) Kokkos::atomic_fetch_add(&taken(3), mirrored);
  }

 private:
  template <class AnyRows>
  std::int64_t take(const AnyRows& rows, int which, int chunk, int longest) const {
    const std::int64_t size = static_cast<std::int64_t>(longest) * row_lanes;
    const std::int64_t place = size > 0 ? Kokkos::atomic_fetch_add(&taken(which), size) : 0;
    rows.length(chunk) = longest;
    rows.first(chunk) = place;
    return place + size <= static_cast<std::int64_t>(rows.index.extent(0)) ? place : -1;
  }
};

template <int Dim>
void build_rows_on_host(const RowSearch<Dim>& search, const RowStore& store, const ScalarField& n, int count);

}  // namespace greenwater
