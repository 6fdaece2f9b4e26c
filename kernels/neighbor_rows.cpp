#include "kernels/neighbor_rows.hpp"

namespace greenwater {
namespace {

// Everything a row needs: who may be near, who is in sight, and how much it weighs.
template <int Dim>
struct Search {
  Read<CoordField> x;
  Read<IndexField> cell_first;
  GridShape grid;
  MirrorWalls walls;
  Weight weight;
  coord radius;  // of the search [m]

  static constexpr int capacity = 96;  // walls and corners near one particle; with more it goes on, slower

  KOKKOS_INLINE_FUNCTION static coord distance2(const Vec<Dim, coord>& a, const Vec<Dim, coord>& b) {
    const auto r = difference(b, a);
    return dot(r, r);
  }

  KOKKOS_INLINE_FUNCTION bool within_reach(coord r2) const { return r2 < radius * radius; }

  KOKKOS_INLINE_FUNCTION real weight_at(coord r2) const { return weight(static_cast<real>(sqrt(r2))); }

  // Calls f(j, r^2) for every neighbour of i.
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

  // Calls f(j, k, r^2, share) for every image, of particle j in mirror k, that i sees.
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
      // Always from the lower index: the same number for both, to the last bit.
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

template <int Dim>
void count_neighbours_in(const Search<Dim>& search, const OffsetField& number, int count) {
  Kokkos::parallel_for(
      "greenwater::count_neighbours", Range(0, count), KOKKOS_LAMBDA(const int i) {
        std::int64_t n = 0;
        search.neighbours(i, [&](int, coord) { ++n; });
        number(i) = n;
      });
}

template <int Dim>
void fill_neighbours_in(const Search<Dim>& search, const Rows& rows, int count) {
  const bool keep = rows.weight.extent(0) > 0;
  Kokkos::parallel_for(
      "greenwater::fill_neighbours", Range(0, count), KOKKOS_LAMBDA(const int i) {
        auto k = rows.first(i);
        search.neighbours(i, [&](const int j, const coord r2) {
          rows.index(k) = j;
          if (keep) rows.weight(k) = search.weight_at(r2);
          ++k;
        });
      });
}

template <int Dim>
void count_images_in(const Search<Dim>& search, const OffsetField& number, int count) {
  Kokkos::parallel_for(
      "greenwater::count_images", Range(0, count), KOKKOS_LAMBDA(const int i) {
        std::int64_t n = 0;
        search.images(i, [&](int, int, coord, real) { ++n; });
        number(i) = n;
      });
}

template <int Dim>
void fill_images_in(const Search<Dim>& search, const ImageRows& rows, int count) {
  const bool keep = rows.weight.extent(0) > 0;
  Kokkos::parallel_for(
      "greenwater::fill_images", Range(0, count), KOKKOS_LAMBDA(const int i) {
        auto k = rows.first(i);
        search.images(i, [&](const int j, const int m, const coord r2, const real share) {
          rows.index(k) = j;
          rows.mirror(k) = m;
          rows.share(k) = share;
          if (keep) rows.weight(k) = share * search.weight_at(r2);
          ++k;
        });
      });
}

// Numbers become places; returns how many entries there are in all.
std::int64_t begin_rows(const OffsetField& first, int count) {
  std::int64_t total = 0;
  Kokkos::parallel_scan(
      "greenwater::begin_rows", Range(0, count + 1),
      KOKKOS_LAMBDA(const int i, std::int64_t& sum, const bool last) {
        const std::int64_t here = i < count ? first(i) : 0;
        if (last) first(i) = sum;
        sum += here;
      },
      total);
  return total;
}

void grow_first(OffsetField& first, int count) {
  if (static_cast<int>(first.extent(0)) < count + 1) first = uncleared<OffsetField>("greenwater::row_first", count + 1);
}

// A quarter more than is needed now, so that a splash does not regrow the rows at each step.
std::int64_t roomy(std::int64_t entries) { return entries + entries / 4 + 64; }

template <int Dim>
void build_in(NeighborRows& rows, const Search<Dim>& search, bool keep, int count) {
  grow_first(rows.near.first, count);
  count_neighbours_in(search, rows.near.first, count);
  const std::int64_t near = rows.near.entries = begin_rows(rows.near.first, count);
  if (static_cast<std::int64_t>(rows.near.index.extent(0)) < near) {
    rows.near.index = uncleared<IndexField>("greenwater::row_index", roomy(near));
    if (keep) rows.near.weight = uncleared<ScalarField>("greenwater::row_weight", roomy(near));
  }
  fill_neighbours_in(search, rows.near, count);
  if (search.walls.count == 0) return;
  grow_first(rows.images.first, count);
  count_images_in(search, rows.images.first, count);
  const std::int64_t image = rows.images.entries = begin_rows(rows.images.first, count);
  if (static_cast<std::int64_t>(rows.images.index.extent(0)) < image) {
    rows.images.index = uncleared<IndexField>("greenwater::image_index", roomy(image));
    rows.images.mirror = uncleared<IndexField>("greenwater::image_mirror", roomy(image));
    rows.images.share = uncleared<ScalarField>("greenwater::image_share", roomy(image));
    if (keep) rows.images.weight = uncleared<ScalarField>("greenwater::image_weight", roomy(image));
  }
  fill_images_in(search, rows.images, count);
}

}  // namespace

void NeighborRows::build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls,
                         const RowOptions& options) {
  const auto build = [&](const auto& search) { build_in(*this, search, options.keep_weights, particles.count); };
  if (particles.dim == 2)
    build(Search<2>{particles.position, grid.first(), grid.shape(), walls, options.weight, options.radius});
  else
    build(Search<3>{particles.position, grid.first(), grid.shape(), walls, options.weight, options.radius});
}

}  // namespace greenwater
