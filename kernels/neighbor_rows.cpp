#include "kernels/neighbor_rows.hpp"

#include "kernels/row_search.hpp"

namespace greenwater {
namespace {

// total: entries of the operator's rows, neighbours and images but those of i itself.
template <int Dim>
void count_rows_in(const RowSearch<Dim>& search, const Rows& near, const ImageRows& images, const IndexField& total,
                   int count) {
  const bool walls = search.walls.count > 0;
  const int room = padded(count);
  Kokkos::parallel_for(
      "greenwater::count_rows", Range(0, room), KOKKOS_LAMBDA(const int i) {
        int neighbours = 0, mirrored = 0, own = 0;
        if (i < count) search.neighbours(i, [&](int, coord) { ++neighbours; });
        if (i < count && walls)
          search.images(i, [&](const int j, int, coord, real) {
            ++mirrored;
            own += j == i ? 1 : 0;
          });
        near.number(i) = neighbours;
        total(i) = neighbours + mirrored - own;
        if (walls) images.number(i) = mirrored;
      });
}

// Where chunks begin; returns the places that they take.
std::int64_t begin_chunks(const IndexField& number, const IndexField& length, const OffsetField& first, int count) {
  std::int64_t places = 0;
  Kokkos::parallel_scan(
      "greenwater::begin_chunks", Range(0, chunks_of(count)),
      KOKKOS_LAMBDA(const int c, std::int64_t& sum, const bool last) {
        int longest = 0;
        for (int i = c * row_lanes; i < (c + 1) * row_lanes; ++i) longest = larger(longest, number(i));
        if (last) {
          length(c) = longest;
          first(c) = sum;
        }
        sum += static_cast<std::int64_t>(longest) * row_lanes;
      },
      places);
  return places;
}

std::int64_t sum_of(const IndexField& number, int count) {
  std::int64_t total = 0;
  Kokkos::parallel_reduce(
      "greenwater::count_entries", Range(0, count),
      KOKKOS_LAMBDA(const int i, std::int64_t& sum) { sum += number(i); }, total);
  return total;
}

template <int Dim>
void fill_rows_in(const RowSearch<Dim>& search, const Rows& near, const ImageRows& images, const ScalarField& n,
                  int count) {
  const bool walls = search.walls.count > 0, keep = near.weight.extent(0) > 0;
  Kokkos::parallel_for(
      "greenwater::fill_rows", Range(0, chunks_of(count) * row_lanes), KOKKOS_LAMBDA(const int i) {
        const int length = near.length(i / row_lanes);
        int entry = 0, image = 0;
        accum density = 0, sum = 0;
        const auto put = [&](const int j, const float w) {
          const auto place = near.place(i, entry++);
          near.index(place) = j;
          if (keep) near.weight(place) = w;
          sum += static_cast<accum>(w);
        };
        if (i < count) {
          search.neighbours(i, [&](const int j, const coord r2) {
            const real r = static_cast<real>(sqrt(r2)), w = search.laplacian(r);
            put(j, static_cast<float>(w));
            density += search.one_weight ? w : search.density(r);
          });
          if (walls)
            search.images(i, [&](const int j, const int m, const coord r2, const real share) {
              const auto place = images.place(i, image++);
              images.index(place) = j;
              images.mirror(place) = m;
              images.share(place) = share;
              const real r = static_cast<real>(sqrt(r2)), w = search.laplacian(r);
              if (j != i) put(j, static_cast<float>(share * w));
              density += share * (search.one_weight ? w : search.density(r));
            });
          n(i) = static_cast<real>(density);
          near.weight_sum(i) = sum;
        }
        while (entry < length) put(i, 0);
        if (walls)
          for (; image < images.length(i / row_lanes); ++image) images.index(images.place(i, image)) = i;
      });
}

template <class Field>
void grow(Field& field, const std::string& label, std::int64_t size) {
  if (static_cast<std::int64_t>(field.extent(0)) < size) field = uncleared<Field>(label, size);
}

// A quarter more than is needed now, so that a splash does not regrow the rows at each step.
std::int64_t roomy(std::int64_t places) { return places + places / 4 + 64 * row_lanes; }

void grow_heads(NeighborRows& rows, IndexField& total, int count, bool walls) {
  const int room = padded(count), chunks = chunks_of(room);
  grow(rows.near.first, "greenwater::row_first", chunks);
  grow(rows.near.length, "greenwater::row_length", chunks);
  grow(rows.near.number, "greenwater::row_number", room);
  grow(rows.near.weight_sum, "greenwater::row_sum", room);
  grow(total, "greenwater::row_total", room);
  if (!walls) return;
  grow(rows.images.first, "greenwater::image_first", chunks);
  grow(rows.images.length, "greenwater::image_length", chunks);
  grow(rows.images.number, "greenwater::image_number", room);
}

void grow_places(NeighborRows& rows, bool keep, bool walls) {
  if (static_cast<std::int64_t>(rows.near.index.extent(0)) < rows.near.stored) {
    const auto room = roomy(rows.near.stored);
    rows.near.index = uncleared<IndexField>("greenwater::row_index", room);
    if (keep) rows.near.weight = uncleared<FloatField>("greenwater::row_weight", room);
  }
  if (!walls || static_cast<std::int64_t>(rows.images.index.extent(0)) >= rows.images.stored) return;
  const auto room = roomy(rows.images.stored);
  rows.images.index = uncleared<IndexField>("greenwater::image_index", room);
  rows.images.mirror = uncleared<IndexField>("greenwater::image_mirror", room);
  rows.images.share = uncleared<ScalarField>("greenwater::image_share", room);
}

}  // namespace

void NeighborRows::build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls,
                         const RowOptions& options) {
  far_ = static_cast<real>(2 * options.radius);
  const int count = particles.count;
  const bool images_too = walls.count > 0;
  grow_heads(*this, total_, count, images_too);
  const auto build_in = [&](const auto& search) {
    count_rows_in(search, near, images, total_, count);
    near.entries = sum_of(near.number, count);
    near.stored = begin_chunks(total_, near.length, near.first, count);
    if (images_too) {
      images.entries = sum_of(images.number, count);
      images.stored = begin_chunks(images.number, images.length, images.first, count);
    }
    grow_places(*this, options.keep_weights, images_too);
    fill_rows_in(search, near, images, particles.number_density, count);
  };
  const bool one_weight = options.density == options.laplacian;
  if (particles.dim == 2)
    build_in(RowSearch<2>{particles.position, grid.first(), grid.shape(), walls, options.density, options.laplacian,
                          options.radius, one_weight});
  else
    build_in(RowSearch<3>{particles.position, grid.first(), grid.shape(), walls, options.density, options.laplacian,
                          options.radius, one_weight});
}

}  // namespace greenwater
