#include "kernels/split_sides.hpp"

namespace greenwater {
namespace {

KOKKOS_INLINE_FUNCTION float hat(float distance) { return larger(0.0f, 1 - fabs(distance)); }

/// Calls f(particle, corner) for the active particles in the cells around a node, which is that corner of their cell.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_particles(const Seats& seats, const Node& n, F f) {
  const GridShape& grid = seats.grid;
  for (int cz = Dim == 3 ? 0 : 1; cz < 2; ++cz)
    for (int cy = 0; cy < 2; ++cy)
      for (int cx = 0; cx < 2; ++cx) {
        const int i = n.i - 1 + cx, j = n.j - 1 + cy, k = Dim == 3 ? n.k - 1 + cz : 0;
        if (i < 0 || i >= grid.cells[0] || j < 0 || j >= grid.cells[1] || k < 0 || k >= grid.cells[2]) continue;
        const int cell = (k * grid.cells[1] + j) * grid.cells[0] + i;
        const int corner = (1 - cx) + 2 * (1 - cy) + 4 * (1 - cz);
        for (int p = seats.first(cell); p < seats.first(cell + 1); ++p)
          if (seats.place[0](p) < far_away) f(p, corner);
      }
}

/// Which corner of the cell of particle p the node is, or -1 when it is none; p may be at the surface.
template <int Dim>
KOKKOS_INLINE_FUNCTION int corner_of(const Seats& seats, const Node& n, int p) {
  if (!(seats.place[0](p) < far_away)) return -1;
  const int at[3] = {n.i, n.j, n.k};
  int corner = 0;
  for (int d = 0; d < Dim; ++d) {
    const int step = at[d] - static_cast<int>(seats.place[d](p));
    if (step < 0 || step > 1) return -1;
    corner += step << d;
  }
  return corner;
}

/// What particle p has of a node.
template <int Dim>
KOKKOS_INLINE_FUNCTION float share_of(const Seats& seats, const Node& n, int p) {
  const int at[3] = {n.i, n.j, n.k};
  float share = 1;
  for (int d = 0; d < Dim; ++d) share *= hat(seats.place[d](p) - static_cast<float>(at[d]));
  return share;
}

constexpr int seen = 8;  // bits of a particle's sides from here on: it belongs to a cluster that is not the largest

/// Marks all particles around a node that are connected with `from`; returns what they have of the node.
template <int Dim>
KOKKOS_INLINE_FUNCTION float mark_connected(const Sides& s, const Node& n, int from, int corner_of_from) {
  Kokkos::atomic_fetch_or(&s.side(from), 1 << corner_of_from);
  float share = share_of<Dim>(s.seats, n, from);
  for (bool more = true; more;) {
    more = false;
    for_particles<Dim>(s.seats, n, [&](const int p, const int corner) {
      if (s.side(p) >> corner & 1) return;
      const int length = s.rows.length(p / row_lanes);
      auto place = s.rows.place(p, 0);
      for (int k = 0; k < length; ++k, place += row_lanes) {
        if (!(s.rows.weight(place) > 0)) continue;
        const int j = s.rows.index(place), other = corner_of<Dim>(s.seats, n, j);
        if (other < 0 || !(s.side(j) >> other & 1)) continue;
        Kokkos::atomic_fetch_or(&s.side(p), 1 << corner);
        share += share_of<Dim>(s.seats, n, p);
        more = true;
        return;
      }
    });
  }
  return share;
}

/// Marks those that are not marked instead.
template <int Dim>
KOKKOS_INLINE_FUNCTION void mark_rest(const Sides& s, const Node& n) {
  for_particles<Dim>(s.seats, n, [&](const int p, const int corner) {
    if (s.side(p) >> corner & 1)
      Kokkos::atomic_fetch_and(&s.side(p), ~(1 << corner));
    else
      Kokkos::atomic_fetch_or(&s.side(p), 1 << corner);
  });
}

/// Takes the marks away again.
template <int Dim>
KOKKOS_INLINE_FUNCTION void unmark(const Sides& s, const Node& n) {
  for_particles<Dim>(s.seats, n, [&](const int p, const int corner) {
    if (!(s.side(p) >> corner & 1)) return;
    Kokkos::atomic_fetch_and(&s.side(p), ~(1 << corner));
    Kokkos::atomic_fetch_or(&s.side(p), 1 << (corner + seen));
  });
}

void clear(const IndexField& side, int count) {
  Kokkos::parallel_for(
      "greenwater::split_clear_sides", Range(0, count), KOKKOS_LAMBDA(const int p) { side(p) = 0; });
}

}  // namespace

template <int Dim>
void find_sides(const Sides& sides, const Level& level, const Splits& splits) {
  clear(sides.side, sides.seats.count);
  Kokkos::parallel_for(
      "greenwater::split_find_sides", Range(1, splits.count + 1), KOKKOS_LAMBDA(const int number) {
        const Node n = node_at<Dim>(level, splits.at[number]);
        float all = 0;
        for_particles<Dim>(sides.seats, n, [&](const int p, const int) { all += share_of<Dim>(sides.seats, n, p); });
        bool done = false;
        for_particles<Dim>(sides.seats, n, [&](const int p, const int corner) {
          if (done || sides.side(p) >> (corner + seen) & 1) return;
          done = 2 * mark_connected<Dim>(sides, n, p, corner) >= all;
          done ? mark_rest<Dim>(sides, n) : unmark<Dim>(sides, n);
        });
      });
}

template <int Dim>
void make_first_rows(const Sides& sides, const Level& level, const Splits& splits) {
  constexpr int size = stencil_size(Dim), corners = 1 << Dim;
  Kokkos::parallel_for(
      "greenwater::split_first_rows", Range(1, splits.count + 1), KOKKOS_LAMBDA(const int number) {
        const Seats& seats = sides.seats;
        const Node n = node_at<Dim>(level, splits.at[number]);
        float* to_nodes = splits.to_nodes + number * size;
        float* to_splits = splits.to_splits + number * size;
        for (int e = 0; e < size; ++e) to_nodes[e] = to_splits[e] = 0;
        const int at[3] = {n.i, n.j, n.k};
        // Adds value times what particle j has of the corners of its cell to their entries.
        const auto add = [&](const int j, const float value) {
          if (!(seats.place[0](j) < far_away)) return;
          float share[Dim][2];
          int lowest = 0;  // entry of the cell's corner 0
          constexpr int strides[3] = {1, across, across * across};
          for (int d = 0; d < Dim; ++d) {
            const int cell = static_cast<int>(seats.place[d](j));
            share[d][1] = seats.place[d](j) - static_cast<float>(cell);
            share[d][0] = 1 - share[d][1];
            lowest += (cell - at[d] + reach) * strides[d];
          }
          const int bits = sides.side(j);
          for (int c = 0; c < corners; ++c) {
            float part = value;
            int entry = lowest;
            for (int d = 0; d < Dim; ++d) {
              part *= share[d][c >> d & 1];
              entry += (c >> d & 1) * strides[d];
            }
            to_nodes[entry] += part;
            if (bits >> c & 1) to_splits[entry] += part;
          }
        };
        for_particles<Dim>(seats, n, [&](const int p, const int corner) {
          if (!(sides.side(p) >> corner & 1)) return;
          const float share = share_of<Dim>(seats, n, p);
          add(p, share * sides.diagonal(p));
          const int length = sides.rows.length(p / row_lanes);
          auto place = sides.rows.place(p, 0);
          for (int k = 0; k < length; ++k, place += row_lanes)
            if (sides.rows.weight(place) > 0) add(sides.rows.index(place), -share * sides.rows.weight(place));
        });
      });
}

template <int Dim>
void restrict_to_splits(const Seats& seats, const IndexField& side, const Level& level, const Splits& s,
                        const FloatField& t) {
  Kokkos::parallel_for(
      "greenwater::split_restrict_particles", Range(1, s.count + 1), KOKKOS_LAMBDA(const int number) {
        const Node n = node_at<Dim>(level, s.at[number]);
        float b = 0;
        for_particles<Dim>(seats, n, [&](const int p, const int corner) {
          if (side(p) >> corner & 1) b += share_of<Dim>(seats, n, p) * t(p);
        });
        s.b[number] = b;
      });
}

template <int Dim>
void prolong_from_splits(const Seats& seats, const IndexField& side, const IndexField& cells, int count,
                         const Level& level, const Splits& s, const FloatField& z) {
  Kokkos::parallel_for(
      "greenwater::split_prolong_to_particles", Range(0, count), KOKKOS_LAMBDA(const int item) {
        const int cell = cells(item), line = cell / seats.grid.cells[0];
        const int i = cell % seats.grid.cells[0], j = line % seats.grid.cells[1], k = line / seats.grid.cells[1];
        for (int p = seats.first(cell); p < seats.first(cell + 1); ++p) {
          const int bits = side(p);
          float sum = 0;
          for (int c = 0; c < (1 << Dim); ++c) {
            if (!(bits >> c & 1)) continue;
            const Node m = {i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)};
            sum += share_of<Dim>(seats, m, p) * s.e[s.number[level.position(m.i, m.j, m.k)]];
          }
          z(p) += sum;
        }
      });
}

template void find_sides<2>(const Sides&, const Level&, const Splits&);
template void make_first_rows<2>(const Sides&, const Level&, const Splits&);
template void restrict_to_splits<2>(const Seats&, const IndexField&, const Level&, const Splits&, const FloatField&);
template void prolong_from_splits<2>(const Seats&, const IndexField&, const IndexField&, int, const Level&,
                                     const Splits&, const FloatField&);
template void find_sides<3>(const Sides&, const Level&, const Splits&);
template void make_first_rows<3>(const Sides&, const Level&, const Splits&);
template void restrict_to_splits<3>(const Seats&, const IndexField&, const Level&, const Splits&, const FloatField&);
template void prolong_from_splits<3>(const Seats&, const IndexField&, const IndexField&, int, const Level&,
                                     const Splits&, const FloatField&);

}  // namespace greenwater
