#include "kernels/neighbor_rows.hpp"

#include "kernels/row_build.hpp"

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
      "greenwater::count_entries", Range(0, count), KOKKOS_LAMBDA(const int i, std::int64_t& sum) { sum += number(i); },
      total);
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

void grow_heads(NeighborRows& rows, int count, bool walls) {
  const int room = padded(count), chunks = chunks_of(room);
  grow(rows.near.first, "greenwater::row_first", chunks);
  grow(rows.near.length, "greenwater::row_length", chunks);
  grow(rows.near.number, "greenwater::row_number", room);
  grow(rows.near.weight_sum, "greenwater::row_sum", room);
  if (!walls) return;
  grow(rows.images.first, "greenwater::image_first", chunks);
  grow(rows.images.length, "greenwater::image_length", chunks);
  grow(rows.images.number, "greenwater::image_number", room);
}

void grow_places(NeighborRows& rows, bool keep) {
  if (static_cast<std::int64_t>(rows.near.index.extent(0)) < rows.near.stored) {
    const auto room = roomy(rows.near.stored);
    rows.near.index = uncleared<IndexField>("greenwater::row_index", room);
    if (keep) rows.near.weight = uncleared<FloatField>("greenwater::row_weight", room);
  }
  if (static_cast<std::int64_t>(rows.images.index.extent(0)) >= rows.images.stored) return;
  const auto room = roomy(rows.images.stored);
  rows.images.index = uncleared<IndexField>("greenwater::image_index", room);
  rows.images.mirror = uncleared<IndexField>("greenwater::image_mirror", room);
  rows.images.share = uncleared<ScalarField>("greenwater::image_share", room);
}

// Counts, makes room, and fills: on any device.
template <int Dim>
void build_in_two_passes(NeighborRows& rows, const RowSearch<Dim>& search, const IndexField& total,
                         const ScalarField& n, int count, bool keep) {
  count_rows_in(search, rows.near, rows.images, total, count);
  rows.near.entries = sum_of(rows.near.number, count);
  rows.near.stored = begin_chunks(total, rows.near.length, rows.near.first, count);
  if (search.walls.count > 0) {
    rows.images.entries = sum_of(rows.images.number, count);
    rows.images.stored = begin_chunks(rows.images.number, rows.images.length, rows.images.first, count);
  }
  grow_places(rows, keep);
  fill_rows_in(search, rows.near, rows.images, n, count);
}

#ifdef GREENWATER_HOST_ONLY
// Fills at once, and once more where there was too little room.
template <int Dim>
void build_in_one_pass(NeighborRows& rows, const RowSearch<Dim>& search, Kokkos::View<std::int64_t[4], Device>& taken,
                       const ScalarField& n, int count, bool keep) {
  if (taken.data() == nullptr) taken = Kokkos::View<std::int64_t[4], Device>("greenwater::row_taken");
  for (bool again = true; again;) {
    Kokkos::deep_copy(taken, std::int64_t{0});
    build_rows_on_host(search, {rows.near, rows.images, taken}, n, count);
    rows.near.stored = taken(0);
    rows.images.stored = taken(1);
    rows.near.entries = taken(2);
    rows.images.entries = taken(3);
    again = rows.near.stored > static_cast<std::int64_t>(rows.near.index.extent(0)) ||
            rows.images.stored > static_cast<std::int64_t>(rows.images.index.extent(0));
    grow_places(rows, keep);
  }
}
#endif

}  // namespace

void NeighborRows::build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls,
                         const RowOptions& options) {
  grid_ = grid.shape();
  far_ = static_cast<real>(2 * options.radius);
  kept_ = options.laplacian;
  const int count = particles.count;
  grow_heads(*this, count, walls.count > 0);
  const auto build_in = [&](const auto& search) {
#ifdef GREENWATER_HOST_ONLY
    if (!options.portable)
      return build_in_one_pass(*this, search, taken_, particles.number_density, count, options.keep_weights);
#endif
    grow(total_, "greenwater::row_total", padded(count));
    build_in_two_passes(*this, search, total_, particles.number_density, count, options.keep_weights);
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
