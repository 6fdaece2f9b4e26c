// Building rows on a CPU in one pass, chunk by chunk: everything of a chunk stays in the first cache until it is written.
//
//   find      who is within reach, into a list: squares of distances of a vector of candidates at a time, compressed
//   weigh     the whole list, a vector at a time: what was compressed is read again only now, because reading at once what
//             was just written in other pieces stalls
//   write     the chunk, where there is room: its rows side by side
//
// Particles that see nothing but one wall without ends, or none, are told by distances alone; the few others go the long
// way of row_search.hpp.
#include <vector>

#include "kernels/neighbor_rows.hpp"
#include "kernels/row_build.hpp"
#include "kernels/row_search.hpp"

#ifdef GREENWATER_HOST_ONLY

namespace greenwater {
namespace {

constexpr int width = 8;  // doubles in a vector
using Doubles = Lanes<double, width>;
using Ints = Lanes<int, width>;
static_assert(std::is_same<coord, double>::value);

// What a thread works with.
struct Workbench {
  // Entries of the operator's rows, one row after the other: neighbours, then images of others.
  std::vector<int> index;
  std::vector<double> r2, weight, density;
  std::vector<float> rounded;
  // Images, row by row, with their places in the lists above (-1: of the particle itself).
  struct Seen {
    int lane, j, mirror, entry;
    real share;
    coord r2;
  };
  std::vector<Seen> images;
  int count = 0;

  void make_room(int more) {
    const std::size_t wanted = count + more + 2 * width;
    if (index.size() >= wanted) return;
    index.resize(2 * wanted);
    r2.resize(2 * wanted);
    weight.resize(2 * wanted);
    density.resize(2 * wanted);
    rounded.resize(2 * wanted);
  }

  void put(int j, coord distance2) {
    make_room(1);
    index[count] = j;
    r2[count++] = distance2;
  }
};

Workbench& workbench() {
  static thread_local Workbench bench;
  return bench;
}

// Which of the candidates first ... last - 1 are within reach of particle i, seen from x_i. `keep(r2, x)` tells what is to be
// kept of a vector of them, with what distance.
template <int Dim, class Keep>
void find_among(const double* const* x, const Vec<Dim, coord>& xi, int i, int first, int last, Workbench& bench,
                Keep keep) {
  const auto steps = counted_lanes<Ints>();
  Vec<Dim, Doubles> from;
  for (int d = 0; d < Dim; ++d) from[d] = all_lanes<Doubles>(xi[d]);
  int count = bench.count;
  int* const index = bench.index.data();
  double* const distance2 = bench.r2.data();
  for (int j = first; j < last; j += width) {
    Vec<Dim, Doubles> xj;  // beyond the last candidate there are others, or padding: left out below
    for (int d = 0; d < Dim; ++d) xj[d] = load_lanes<Doubles>(x[d] + j);
    const auto way = difference(xj, from);
    Doubles r2 = dot(way, way);
    unsigned bits = keep(xj, r2);
    if (last - j < width) bits &= (1u << (last - j)) - 1;
    if (static_cast<unsigned>(i - j) < width) bits &= ~(1u << (i - j));
    compress_lanes(bits, r2, distance2 + count);
    compress_lanes(bits, steps + j, index + count);
    count += __builtin_popcount(bits);
  }
  bench.count = count;
}

// One chunk of rows, from finding to writing.
template <int Dim>
class ChunkBuilder {
 public:
  ChunkBuilder(const RowSearch<Dim>& search, int chunk, int count)
      : search_(search), bench_(workbench()), begin_(chunk * row_lanes), rows_(smaller(row_lanes, count - begin_)) {
    for (int d = 0; d < Dim; ++d) x_[d] = &search.x(0, d);
  }

  void find() {
    bench_.count = 0;
    bench_.images.clear();
    for (int lane = 0; lane < rows_; ++lane) {
      start_[lane] = bench_.count;
      find_row(lane);
      total_[lane] = bench_.count - start_[lane];
    }
    for (int lane = rows_; lane < row_lanes; ++lane) start_[lane] = bench_.count;
  }

  void weigh() {
    const Weight laplacian = search_.laplacian, of_density = search_.density;
    const bool one_weight = search_.one_weight;
    const double* const r2 = bench_.r2.data();
    double* const weight = bench_.weight.data();
    double* const other = bench_.density.data();
    float* const rounded = bench_.rounded.data();
    for (int k = 0, count = bench_.count; k < count; k += width) {
      const Doubles r = sqrt(load_lanes<Doubles>(r2 + k));
      const Doubles w = laplacian(r);
      store_lanes(weight + k, w);
      store_lanes(rounded + k, convert_lanes<Lanes<float, width>>(w));
      if (!one_weight) store_lanes(other + k, of_density(r));
    }
    std::vector<double>& density = search_.one_weight ? bench_.weight : bench_.density;
    for (const auto& seen : bench_.images) {
      if (seen.entry < 0) continue;
      bench_.rounded[seen.entry] = static_cast<float>(seen.share * bench_.weight[seen.entry]);
      if (!search_.one_weight) bench_.weight[seen.entry] *= seen.share;
      density[seen.entry] *= seen.share;
    }
    for (int lane = 0; lane < rows_; ++lane) {
      density_[lane] = sum(density.data() + start_[lane], total_[lane]);
      sum_[lane] = sum(bench_.rounded.data() + start_[lane], total_[lane]);
    }
    for (const auto& seen : bench_.images)
      if (seen.entry < 0) density_[seen.lane] += seen.share * search_.density(std::sqrt(seen.r2));
  }

  void write(const RowStore& store, const ScalarField& n, int more, Reserve& reserve) const {
    const int chunk = begin_ / row_lanes;
    int longest = 0, most_images = 0, neighbours = 0, mirrored = 0;
    for (int lane = 0; lane < row_lanes; ++lane) {
      longest = larger(longest, total_[lane]);
      most_images = larger(most_images, images_[lane]);
      const int i = begin_ + lane;
      store.near.number(i) = total_[lane] - (images_[lane] - own_[lane]);
      neighbours += store.near.number(i);
      mirrored += images_[lane];
      store.near.weight_sum(i) = sum_[lane];
      if (search_.walls.count > 0) store.images.number(i) = images_[lane];
      if (lane < rows_) n(i) = static_cast<real>(density_[lane]);
    }
    store.count(neighbours, mirrored);
    const auto place = store.take_near(chunk, longest, more, reserve);
    if (place >= 0) write_entries(store.near, place, longest);
    if (search_.walls.count == 0) return;
    const auto image_place = store.take_images(chunk, most_images);
    if (image_place >= 0 && most_images > 0) write_images(store.images, image_place, most_images);
  }

 private:
  void find_row(int lane) {
    const int i = begin_ + lane;
    const auto xi = load<Dim>(search_.x, i);
    const coord reach2 = search_.radius * search_.radius;
    int candidates = 0;
    for_each_stretch<Dim>(search_.grid, search_.cell_first.data(), xi,
                          [&](int first, int last, const auto&) { candidates += last - first; });
    bench_.make_room(2 * candidates);  // each may be there twice: itself, and as an image
    auto sight = sight_from(search_.walls, search_.grid, xi);
    int room[RowSearch<Dim>::capacity];
    if (sight.begin != sight.end) sight.narrow(xi, search_.radius, room, RowSearch<Dim>::capacity);
    if (sight.begin == sight.end) {
      for_each_stretch<Dim>(search_.grid, search_.cell_first.data(), xi, [&](int first, int last, const auto& move) {
        find_among<Dim>(x_, difference(xi, move), i, first, last, bench_,
                        [&](const Vec<Dim, Doubles>&, const Doubles& r2) { return lane_bits(r2 < reach2); });
      });
    } else if (sight.one_endless_wall(xi, search_.radius) && !search_.grid.repeats()) {
      find_beside_wall(lane, i, xi, sight.reach[sight.begin], sight.panel[sight.reach[sight.begin]]);
    } else {
      search_.neighbours(i, [&](int j, coord r2) { bench_.put(j, r2); });
      search_.images(i, [&](int j, int mirror, coord r2, real share) { put_image(lane, i, j, mirror, r2, share); });
    }
  }

  // A wall without ends hides what is behind it and gives an image to everything before it:
  // |x_i - x_j'|^2 = |x_i - x_j|^2 + 4 s_i s_j.
  void find_beside_wall(int lane, int i, const Vec<Dim, coord>& xi, int mirror, const Panel& wall) {
    const coord reach2 = search_.radius * search_.radius;
    const coord si = Sight<Dim>::side(wall, xi);
    const auto side = [&](const Vec<Dim, Doubles>& xj) {
      Doubles s{};
      for (int d = 0; d < Dim; ++d) s += wall.normal[d] * (xj[d] - wall.point[d]);
      return s;
    };
    for_each_stretch<Dim>(search_.grid, search_.cell_first.data(), xi, [&](int first, int last, const auto&) {
      find_among<Dim>(x_, xi, i, first, last, bench_, [&](const Vec<Dim, Doubles>& xj, const Doubles& r2) {
        const Doubles sj = side(xj);
        return lane_bits((r2 < reach2) & ((si * sj > 0) | (sj == si)));
      });
    });
    const int before = bench_.count;
    for_each_stretch<Dim>(search_.grid, search_.cell_first.data(), xi, [&](int first, int last, const auto&) {
      find_among<Dim>(x_, xi, -width, first, last, bench_, [&](const Vec<Dim, Doubles>& xj, Doubles& r2) {
        const Doubles both = si * side(xj);
        r2 += 4 * both;
        return lane_bits((both > 0) & (r2 < reach2));
      });
    });
    // What was found goes the way of all images, over which those of i itself fall out of the list.
    const int found = bench_.count;
    bench_.count = before;
    for (int k = before; k < found; ++k) put_image(lane, i, bench_.index[k], mirror, bench_.r2[k], 1);
  }

  void put_image(int lane, int i, int j, int mirror, coord r2, real share) {
    bench_.images.push_back({lane, j, mirror, j == i ? -1 : bench_.count, share, r2});
    if (j != i) bench_.put(j, r2);
    own_[lane] += j == i ? 1 : 0;
    ++images_[lane];
  }

  template <class T>
  static double sum(const T* values, int count) {
    Doubles sums{};
    int k = 0;
    for (; k + width <= count; k += width) sums += convert_lanes<Doubles>(load_lanes<Lanes<T, width>>(values + k));
    const auto rest = convert_lanes<Doubles>(load_lanes<Lanes<T, width>>(values + k));
    sums += zero_unless(convert_lanes<Doubles>(counted_lanes<Ints>()) < static_cast<double>(count - k), rest);
    double total = 0;
    for (int l = 0; l < width; ++l) total += sums[l];
    return total;
  }

  // Entry k of all rows: taken together from the lists, own index and no weight where a row has ended.
  void write_entries(const Rows& near, std::int64_t place, int longest) const {
    using Index = Lanes<int, row_lanes>;
    using Weights = Lanes<float, row_lanes>;
    const auto start = load_lanes<Index>(start_), total = load_lanes<Index>(total_);
    const Index own = counted_lanes<Index>() + begin_;
    const bool keep = near.weight.extent(0) > 0;
    int* index = near.index.data() + place;
    float* weight = keep ? near.weight.data() + place : nullptr;
    const int* const found = bench_.index.data();
    const float* const rounded = bench_.rounded.data();
    for (int k = 0; k < longest; ++k, index += row_lanes) {
      const auto there = total > k;
      const Index from = there ? start + k : Index{};
      const auto j = gather_lanes<Index>(found, from);
      store_lanes(index, there ? j : own);
      if (!keep) continue;
      const auto w = gather_lanes<Weights>(rounded, from);
      store_lanes(weight, there ? w : Weights{});
      weight += row_lanes;
    }
  }

  void write_images(const ImageRows& images, std::int64_t place, int most) const {
    for (int k = 0; k < most; ++k)
      for (int lane = 0; lane < row_lanes; ++lane) images.index(place + k * row_lanes + lane) = begin_ + lane;
    int entry[row_lanes] = {};
    for (const auto& seen : bench_.images) {
      const auto at = place + entry[seen.lane]++ * row_lanes + seen.lane;
      images.index(at) = seen.j;
      images.mirror(at) = seen.mirror;
      images.share(at) = seen.share;
    }
  }

  const RowSearch<Dim>& search_;
  Workbench& bench_;
  const int begin_, rows_;
  const double* x_[Dim];
  alignas(64) int start_[row_lanes] = {};
  alignas(64) int total_[row_lanes] = {};
  int images_[row_lanes] = {}, own_[row_lanes] = {};
  double density_[row_lanes] = {}, sum_[row_lanes] = {};
};

template <int Dim>
void build_in(const RowSearch<Dim>& search, const RowStore& store, const ScalarField& n, int count) {
  constexpr int together = 16;  // chunks whose rows follow each other
  const int chunks = chunks_of(count);
  Kokkos::parallel_for("greenwater::build_rows", Range(0, (chunks + together - 1) / together), [=](const int block) {
    const int begin = block * together, end = smaller(begin + together, chunks);
    Reserve reserve;
    for (int chunk = begin; chunk < end; ++chunk) {
      ChunkBuilder<Dim> rows(search, chunk, count);
      rows.find();
      rows.weigh();
      rows.write(store, n, end - chunk - 1, reserve);
    }
  });
}

}  // namespace

template <int Dim>
void build_rows_on_host(const RowSearch<Dim>& search, const RowStore& store, const ScalarField& n, int count) {
  build_in(search, store, n, count);
}

template void build_rows_on_host(const RowSearch<2>&, const RowStore&, const ScalarField&, int);
template void build_rows_on_host(const RowSearch<3>&, const RowStore&, const ScalarField&, int);

}  // namespace greenwater

#endif
