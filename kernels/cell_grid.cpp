#include "kernels/cell_grid.hpp"

#include <cmath>
#include <limits>

#include "core/check.hpp"

namespace greenwater {
namespace {

// The cell of each particle, and how many each cell has; those outside go to one more cell at the end. Returns how many
// positions are no numbers.
template <int Dim>
int find_cells_in(const Particles& particles, const GridShape& grid, IndexField cell, IndexField number) {
  const auto x = Read<CoordField>(particles.position);
  int nowhere = 0;
  Kokkos::parallel_reduce(
      "greenwater::find_cells", Range(0, particles.count),
      KOKKOS_LAMBDA(const int i, int& sum) {
        const auto xi = load<Dim>(x, i);
        const auto zero = difference(xi, xi);  // inf - inf and nan - nan are not
        sum += dot(zero, zero) == 0 ? 0 : 1;
        const int c = grid.holds(xi) ? grid.cell_of(xi) : grid.count();
        cell(i) = c;
        Kokkos::atomic_fetch_add(&number(c), 1);
      },
      nowhere);
  return nowhere;
}

template <int Dim>
void wrap_positions_in(const Particles& particles, const GridShape& grid) {
  const auto x = particles.position;
  Kokkos::parallel_for(
      "greenwater::wrap_positions", Range(0, particles.count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) {
          const coord period = grid.period[d];
          if (period == 0) continue;
          const coord from = x(i, d) - grid.origin[d], rest = from - period * floor(from / period);
          if (from < 0 || from >= period) x(i, d) = grid.origin[d] + (rest < period ? rest : coord(0));
        }
      });
}

void clear(const IndexField& field) {
  Kokkos::parallel_for(
      "greenwater::clear_cells", Range(0, static_cast<int>(field.extent(0))),
      KOKKOS_LAMBDA(const int c) { field(c) = 0; });
}

// Numbers become places: where each cell begins.
void begin_cells(const IndexField& number, const IndexField& first) {
  const int cells = static_cast<int>(number.extent(0));
  Kokkos::parallel_scan(
      "greenwater::begin_cells", Range(0, cells), KOKKOS_LAMBDA(const int c, int& sum, const bool last) {
        const int here = number(c);
        if (last) {
          first(c) = sum;
          number(c) = sum;
          if (c == cells - 1) first(cells) = sum + here;
        }
        sum += here;
      });
}

void fill_cells(const IndexField& cell, const IndexField& next, const IndexField& order, int count) {
  Kokkos::parallel_for(
      "greenwater::fill_cells", Range(0, count),
      KOKKOS_LAMBDA(const int i) { order(Kokkos::atomic_fetch_add(&next(cell(i)), 1)) = i; });
}

KOKKOS_INLINE_FUNCTION void sift_down(const IndexField& order, int begin, int root, int size) {
  while (2 * root + 1 < size) {
    int child = 2 * root + 1;
    if (child + 1 < size && order(begin + child) < order(begin + child + 1)) ++child;
    if (order(begin + root) >= order(begin + child)) return;
    const int kept = order(begin + root);
    order(begin + root) = order(begin + child);
    order(begin + child) = kept;
    root = child;
  }
}

KOKKOS_INLINE_FUNCTION void insertion_sort(const IndexField& order, int begin, int end) {
  for (int k = begin + 1; k < end; ++k) {
    const int value = order(k);
    int m = k;
    for (; m > begin && order(m - 1) > value; --m) order(m) = order(m - 1);
    order(m) = value;
  }
}

KOKKOS_INLINE_FUNCTION void heap_sort(const IndexField& order, int begin, int end) {
  const int size = end - begin;
  for (int root = size / 2 - 1; root >= 0; --root) sift_down(order, begin, root, size);
  for (int last = size - 1; last > 0; --last) {
    const int top = order(begin);
    order(begin) = order(begin + last);
    order(begin + last) = top;
    sift_down(order, begin, 0, last);
  }
}

// Threads filled the cells in any order: the old order within each cell is put back, and with it the same sums and the
// same bits at any number of threads. A cell has about ten particles; a crowd gets a sort that does not grow squarely.
void settle_cells(const IndexField& first, const IndexField& order, int cells) {
  constexpr int crowd = 64;
  Kokkos::parallel_for(
      "greenwater::settle_cells", Range(0, cells), KOKKOS_LAMBDA(const int c) {
        const int begin = first(c), end = first(c + 1);
        if (end - begin > crowd)
          heap_sort(order, begin, end);
        else
          insertion_sort(order, begin, end);
      });
}

int value_at(const IndexField& field, int i) {
  int value = 0;
  Kokkos::deep_copy(value, Kokkos::subview(field, i));
  return value;
}

}  // namespace

GridShape make_grid(int dim, const std::array<coord, 3>& low, const std::array<coord, 3>& high, coord radius,
                    const std::array<bool, 3>& repeats) {
  GridShape grid;
  grid.cell = radius * (1 + 1e-6);
  double total = 1;
  for (int d = 0; d < dim; ++d) {
    grid.origin[d] = low[d];
    if (repeats[d]) grid.period[d] = high[d] - low[d];
    const double along = std::ceil((high[d] - low[d]) / grid.cell) + (repeats[d] ? 0 : 1);
    expect(!repeats[d] || grid.period[d] >= shortest_period * grid.cell);
    total *= along;
    require<ResourceError>(total < std::numeric_limits<int>::max() / 4, "the domain needs more than ", total,
                           " cells of ", grid.cell, " m: make it smaller or the particle distance larger");
    grid.cells[d] = static_cast<int>(along);
  }
  return grid;
}

Departed CellGrid::sort(Particles& particles) {
  const int cells = shape_.count() + 1;
  if (static_cast<int>(first_.extent(0)) != cells + 1) {
    first_ = IndexField("greenwater::cell_first", cells + 1);
    fill_ = IndexField("greenwater::cell_fill", cells);
  }
  if (cell_.extent(0) < particles.id.extent(0)) {
    cell_ = uncleared<IndexField>("greenwater::cell_of_particle", particles.id.extent(0));
    order_ = uncleared<IndexField>("greenwater::cell_order", particles.id.extent(0));
  }
  if (shape_.repeats())
    particles.dim == 2 ? wrap_positions_in<2>(particles, shape_) : wrap_positions_in<3>(particles, shape_);
  clear(fill_);
  const int nowhere = particles.dim == 2 ? find_cells_in<2>(particles, shape_, cell_, fill_)
                                         : find_cells_in<3>(particles, shape_, cell_, fill_);
  begin_cells(fill_, first_);
  fill_cells(cell_, fill_, order_, particles.count);
  settle_cells(first_, order_, cells);
  const int before = particles.count;
  reorder_.apply(particles, order_, value_at(first_, cells - 1));
  return {before - particles.count - nowhere, nowhere};
}

}  // namespace greenwater
