#include "kernels/split_nodes.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "kernels/dense_inverse.hpp"

namespace greenwater {

static_assert(2 * coarsest_nodes <= largest_dense);  // each of the last level's nodes may be split

namespace {

using Team = Kokkos::TeamPolicy<Space>;
using Member = Team::member_type;

KOKKOS_INLINE_FUNCTION float hat(float distance) { return larger(0.0f, 1 - fabs(distance)); }

/// Device view of the particles around nodes that may be split.
struct Sides {
  Seats seats;
  Rows rows;
  Read<FloatField> diagonal;
  IndexField side;

  KOKKOS_INLINE_FUNCTION bool active(int p) const { return seats.place[0](p) < far_away; }
};

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

// Where the particles around a node are not all connected, marks those that are not in the cluster that has at least half
// of the node: the split stands for them, so that it is the smaller part.
template <int Dim>
void find_sides(const Sides& sides, const Level& level, const Splits& splits) {
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

// Rows of the first level's matrix that belong to splits: sums over the particles on their side.
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
        const auto add = [&](const int j, const float value) {
          if (!sides.active(j)) return;
          const int bits = sides.side(j);
          const int i0 = static_cast<int>(seats.place[0](j)), j0 = static_cast<int>(seats.place[1](j));
          const int k0 = Dim == 3 ? static_cast<int>(seats.place[2](j)) : 0;
          for (int c = 0; c < corners; ++c) {
            const Node m = {i0 + (c & 1), j0 + (c >> 1 & 1), k0 + (c >> 2)};
            const int dx = m.i - n.i + reach, dy = m.j - n.j + reach, dz = Dim == 3 ? m.k - n.k + reach : 0;
            const float part = value * share_of<Dim>(seats, m, j);
            const int entry = (dz * across + dy) * across + dx;
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

// As that of the nodes, for both sides of each node that is split. The two have nothing to do with each other.
template <int Dim>
void weigh_smoother(const Level& level, const Splits& s) {
  Kokkos::parallel_for(
      "greenwater::split_weigh_smoother", Range(1, s.count + 1), KOKKOS_LAMBDA(const int number) {
        constexpr int size = stencil_size(Dim), middle = size / 2;
        const int at = s.at[number], value = value_of(level, node_at<Dim>(level, at));
        const float* whole = level.stencil + value / node_lanes * size * node_lanes + value % node_lanes;
        const float* to_nodes = s.to_nodes + number * size;
        const float* to_splits = s.to_splits + number * size;
        float of_split = 0, of_rest = 0;
        for_stencil<Dim>(level, [&](const int entry, const int way) {
          const int other = s.number[at + way];
          const float back = other > 0 ? s.to_nodes[other * size + size - 1 - entry] : 0.0f;
          of_split += fabs(to_nodes[entry] - to_splits[entry]) + fabs(to_splits[entry]);
          of_rest += fabs(whole[entry * node_lanes] - to_nodes[entry] - back + to_splits[entry]) +
                     fabs(back - to_splits[entry]);
        });
        const float own = to_splits[middle], rest = whole[middle * node_lanes] - 2 * to_nodes[middle] + own;
        const bool split = own > 0 && rest > 0;
        s.relax[number] = split ? 1.9f / (own + of_split) : 0.0f;
        s.relax_rest[number] = split ? 1.9f / (rest + of_rest) : 0.0f;
      });
}

/// Around a coarser node: the finer ones under it, each in one or two halves. Half 1 is what its split stands for, half 0
/// the rest.
template <int Dim>
struct Patch {
  static constexpr int size = stencil_size(Dim), count = 2 * children(Dim);
  const Level& level;
  const Splits& splits;
  int position[children(Dim)], stencil[children(Dim)], number[children(Dim)];
  float weight[count];  // of the halves' diagonals; 0: is not there

  KOKKOS_INLINE_FUNCTION Patch(const Level& fine, const Splits& s, const Level& coarse, const Node& n)
      : level(fine), splits(s) {
    for_children<Dim>(fine, n, [&](const int child, const int at) {
      const int a = child % 3 - 1, b = child / 3 % 3 - 1, c = Dim == 3 ? child / 9 - 1 : 0;
      const Node m = {2 * n.i + a, 2 * n.j + b, 2 * n.k + c};
      const bool there = m.i >= 0 && m.j >= 0 && m.k >= 0 && m.i < fine.nodes[0] && m.j < fine.nodes[1] &&
                         m.k < fine.nodes[2];
      position[child] = at;
      const int value = there ? value_of(fine, m) : 0;
      stencil[child] = value / node_lanes * size * node_lanes + value % node_lanes;
      number[child] = there ? s.number[at] : 0;
      weight[2 * child] = weight[2 * child + 1] = 0;
    });
    (void)coarse;
    for (int u = 0; u < count; ++u) {
      const float own = entry(u, u), whole = fine.stencil[stencil[u / 2] + size / 2 * node_lanes];
      if (whole > 0 && own > 1e-4f * whole) weight[u] = own;
    }
  }

  KOKKOS_INLINE_FUNCTION bool split(int child) const { return weight[2 * child + 1] > 0; }

  /// A between two halves.
  KOKKOS_INLINE_FUNCTION float entry(int u, int v) const {
    const int m = u / 2, n = v / 2;
    int e = 0;
    constexpr int strides[3] = {1, across, across * across};
    for (int d = 0, p = 1; d < Dim; ++d, p *= 3) e += (n / p % 3 - m / p % 3 + reach) * strides[d];
    const int back = size - 1 - e;
    const float whole = level.stencil[stencil[m] + e * node_lanes];
    const float mine = number[m] ? splits.to_nodes[number[m] * size + e] : 0.0f;
    const float others = number[n] ? splits.to_nodes[number[n] * size + back] : 0.0f;
    const float both = number[m] && number[n] ? splits.to_splits[number[m] * size + e] : 0.0f;
    if (u % 2 == 0) return v % 2 == 0 ? whole - mine - others + both : others - both;
    return v % 2 == 0 ? mine - both : both;
  }

  KOKKOS_INLINE_FUNCTION bool connected(int u, int v) const {
    const float a = entry(u, v);
    return a * a > 1e-6f * weight[u] * weight[v];
  }
};

/// Which halves are connected with half `from` within the patch, as bits.
template <int Dim>
KOKKOS_INLINE_FUNCTION std::uint64_t connected_with(const Patch<Dim>& patch, int from) {
  std::uint64_t found = std::uint64_t(1) << from;
  for (bool more = true; more;) {
    more = false;
    for (int u = 0; u < Patch<Dim>::count; ++u) {
      if (!(patch.weight[u] > 0) || found >> u & 1) continue;
      for (int v = 0; v < Patch<Dim>::count && !(found >> u & 1); ++v)
        if (found >> v & 1 && patch.connected(u, v)) {
          found |= std::uint64_t(1) << u;
          more = true;
        }
    }
  }
  return found;
}

/// The halves that are not connected with the largest cluster of them, which has at least half of the weight.
template <int Dim>
KOKKOS_INLINE_FUNCTION std::uint64_t one_side(const Patch<Dim>& patch) {
  float all = 0;
  std::uint64_t left = 0;
  for (int u = 0; u < Patch<Dim>::count; ++u) {
    all += patch.weight[u];
    if (patch.weight[u] > 0) left |= std::uint64_t(1) << u;
  }
  const auto there = left;
  for (int from = 0; from < Patch<Dim>::count; ++from) {
    if (!(left >> from & 1)) continue;
    const auto found = connected_with(patch, from);
    float weight = 0;
    for (int u = 0; u < Patch<Dim>::count; ++u)
      if (found >> u & 1) weight += patch.weight[u];
    if (2 * weight >= all) return there & ~found;
    left &= ~found;
  }
  return 0;
}

// What the functions of a level's splits are made of.
template <int Dim>
void find_coarse_sides(const Level& fine, const Splits& from, const Level& coarse, const Splits& s) {
  Kokkos::parallel_for(
      "greenwater::split_find_coarse_sides", Range(1, s.count + 1), KOKKOS_LAMBDA(const int number) {
        const Node n = node_at<Dim>(coarse, s.at[number]);
        const Patch<Dim> patch(fine, from, coarse, n);
        const auto side = one_side(patch);
        for (int child = 0; child < children(Dim); ++child) {
          float hat = 1;
          for (int d = 0, p = 1; d < Dim; ++d, p *= 3)
            if (child / p % 3 != 1) hat *= 0.5f;
          const bool split = patch.split(child);
          const bool rest = side >> (2 * child) & 1, part = split ? side >> (2 * child + 1) & 1 : rest;
          const int place = number * children(Dim) + child;
          s.from_nodes[place] = rest ? hat : 0.0f;
          s.from_splits[place] = part == rest ? 0.0f : part ? hat : -hat;
        }
      });
}

/// Calls f(node of the coarser level, weight) for those that the finer node at n + (a, b, c) is interpolated from.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_parents(const Node& n, F f) {
  for (int k = n.k >> 1; k <= (n.k + 1) >> 1; ++k)
    for (int j = n.j >> 1; j <= (n.j + 1) >> 1; ++j)
      for (int i = n.i >> 1; i <= (n.i + 1) >> 1; ++i)
        f(Node{i, j, k}, (n.i & 1 ? 0.5f : 1.0f) * (n.j & 1 ? 0.5f : 1.0f) * (n.k & 1 ? 0.5f : 1.0f));
}

// P^T A P for the rows of a coarser level's splits.
template <int Dim>
void make_coarse_rows(const Level& fine, const Splits& from, const Level& coarse, const Splits& s) {
  constexpr int size = stencil_size(Dim);
  Kokkos::parallel_for(
      "greenwater::split_coarse_rows", Range(1, s.count + 1), KOKKOS_LAMBDA(const int number) {
        float* to_nodes = s.to_nodes + number * size;
        float* to_splits = s.to_splits + number * size;
        for (int e = 0; e < size; ++e) to_nodes[e] = to_splits[e] = 0;
        const Node n = node_at<Dim>(coarse, s.at[number]);
        // What the row has at a finer node and its split goes to the coarser ones that these are made from.
        const auto spread = [&](const Node& m, const float node, const float split) {
          for_parents<Dim>(m, [&](const Node& q, const float weight) {
            const int dx = q.i - n.i + reach, dy = q.j - n.j + reach, dz = Dim == 3 ? q.k - n.k + reach : 0;
            const int entry = (dz * across + dy) * across + dx;
            to_nodes[entry] += weight * node;
            const int other = s.number[coarse.position(q.i, q.j, q.k)];
            if (other == 0) return;
            const int a = m.i - 2 * q.i + 1, b = m.j - 2 * q.j + 1, c = Dim == 3 ? m.k - 2 * q.k + 1 : 0;
            const int place = other * children(Dim) + (c * 3 + b) * 3 + a;
            to_splits[entry] += s.from_nodes[place] * node + s.from_splits[place] * split;
          });
        };
        for_children<Dim>(fine, n, [&](const int child, const int position) {
          const float node = s.from_nodes[number * children(Dim) + child];
          const float split = s.from_splits[number * children(Dim) + child];
          if (node == 0 && split == 0) return;
          const Node m = {2 * n.i + child % 3 - 1, 2 * n.j + child / 3 % 3 - 1, Dim == 3 ? 2 * n.k + child / 9 - 1 : 0};
          const int value = value_of(fine, m), own = from.number[position];
          const float* whole = fine.stencil + value / node_lanes * size * node_lanes + value % node_lanes;
          for_stencil<Dim>(fine, [&](const int e, const int way) {
            const int other = from.number[position + way];
            const float at_node = node * whole[e * node_lanes] + split * from.to_nodes[own * size + e];
            const float at_split = (other ? node * from.to_nodes[other * size + size - 1 - e] : 0.0f) +
                                   split * from.to_splits[own * size + e];
            if (at_node == 0 && at_split == 0) return;
            const Node q = {m.i + e % across - reach, m.j + e / across % across - reach,
                            Dim == 3 ? m.k + e / (across * across) - reach : 0};
            spread(q, at_node, at_split);
          });
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

template <class F>
KOKKOS_INLINE_FUNCTION void for_each(const Member& team, int begin, int end, const F& f) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, begin, end), f);
  team.team_barrier();
}

/// Values at the nodes of the last level and of its splits from their right sides.
template <int Dim>
KOKKOS_INLINE_FUNCTION void solve_last(const Member& team, const LevelStack& stack, const SplitStack& splits) {
  const Level& last = stack.level[stack.count - 1];
  const Splits& s = splits.level[stack.count - 1];
  const int nodes = stack.unknowns, count = nodes + s.count;
  for_each(team, 0, count, [&](const int row) {
    const float* inverse = splits.inverse + row * count;
    float sum = 0;
    for (int c = 0; c < nodes; ++c) sum += inverse[c] * last.b[stack.value[c]];
    for (int c = nodes; c < count; ++c) sum += inverse[c] * s.b[c - nodes + 1];
    if (row < nodes)
      last.y[stack.position[row]] = sum;
    else
      s.e[row - nodes + 1] = sum;
  });
}

// The matrix of the last level with its splits, on the device.
template <int Dim>
void fill_last(const LevelStack& stack, const SplitStack& splits, const FloatField& matrix) {
  const Level last = stack.level[stack.count - 1];
  const Splits s = splits.level[stack.count - 1];
  const int nodes = stack.unknowns, count = nodes + s.count;
  const int* position = stack.position;
  Kokkos::parallel_for(
      "greenwater::split_last_matrix", Range(0, count * count), KOKKOS_LAMBDA(const int place) {
        constexpr int size = stencil_size(Dim);
        const int row = place / count, column = place % count, m = row - nodes + 1, n = column - nodes + 1;
        const Node a = node_at<Dim>(last, m > 0 ? s.at[m] : position[row]);
        const Node b = node_at<Dim>(last, n > 0 ? s.at[n] : position[column]);
        const int dx = b.i - a.i + reach, dy = b.j - a.j + reach, dz = Dim == 3 ? b.k - a.k + reach : 0;
        float value = 0;
        if (dx >= 0 && dx < across && dy >= 0 && dy < across && dz >= 0 && dz < across) {
          const int entry = (dz * across + dy) * across + dx, at = value_of(last, a);
          if (m > 0)
            value = n > 0 ? s.to_splits[m * size + entry] : s.to_nodes[m * size + entry];
          else if (n > 0)
            value = s.to_nodes[n * size + size - 1 - entry];
          else
            value = last.stencil[(at / node_lanes * size + entry) * node_lanes + at % node_lanes];
        }
        matrix(place) = value;
      });
}

template <int Dim>
KOKKOS_INLINE_FUNCTION int value_of_split(const Level& level, const Splits& s, int number) {
  return value_of(level, node_at<Dim>(level, s.at[number]));
}

template <int Dim>
void launch_down(const Level& fine, const Splits& from, const Level& coarse, const Splits& s) {
  Kokkos::parallel_for(
      "greenwater::split_smooth_first", Range(1, from.count + 1),
      KOKKOS_LAMBDA(const int m) { smooth_first(fine, from, m, value_of_split<Dim>(fine, from, m)); });
  Kokkos::parallel_for(
      "greenwater::split_residual_of_nodes", Range(0, items(fine)),
      KOKKOS_LAMBDA(const int number) { residual<Dim>(fine, number); });
  Kokkos::parallel_for(
      "greenwater::split_mend_residual", Range(0, from.near),
      KOKKOS_LAMBDA(const int k) { mend_residual<Dim>(fine, from, from.near_at[k]); });
  Kokkos::parallel_for(
      "greenwater::split_residual", Range(1, from.count + 1),
      KOKKOS_LAMBDA(const int m) { split_residual<Dim>(fine, from, m); });
  Kokkos::parallel_for(
      "greenwater::split_restrict_nodes", Range(0, items(coarse)),
      KOKKOS_LAMBDA(const int number) { restrict_from<Dim>(fine, coarse, number); });
  Kokkos::parallel_for(
      "greenwater::split_restrict", Range(1, s.count + 1),
      KOKKOS_LAMBDA(const int m) { restrict_split<Dim>(fine, from, coarse, s, m); });
}

template <int Dim>
void launch_up(const Level& fine, const Splits& to, const Level& coarse, const Splits& s) {
  Kokkos::parallel_for(
      "greenwater::split_prolong_nodes", Range(0, items(fine)),
      KOKKOS_LAMBDA(const int number) { prolong_to<Dim>(fine, coarse, number); });
  Kokkos::parallel_for(
      "greenwater::split_prolong", Range(0, to.under),
      KOKKOS_LAMBDA(const int k) { prolong_splits<Dim>(fine, to, coarse, s, to.under_at[k]); });
  Kokkos::parallel_for(
      "greenwater::split_residual", Range(1, to.count + 1),
      KOKKOS_LAMBDA(const int m) { split_residual<Dim>(fine, to, m); });
  Kokkos::parallel_for(
      "greenwater::split_smooth_nodes", Range(0, items(fine)),
      KOKKOS_LAMBDA(const int number) { smooth<Dim>(fine, number); });
  Kokkos::parallel_for(
      "greenwater::split_mend_smoothed", Range(0, to.near),
      KOKKOS_LAMBDA(const int k) { mend_smoothed<Dim>(fine, to, to.near_at[k]); });
  Kokkos::parallel_for(
      "greenwater::split_smooth", Range(1, to.count + 1),
      KOKKOS_LAMBDA(const int m) { smooth_split(fine, to, m, value_of_split<Dim>(fine, to, m)); });
}

template <int Dim>
KOKKOS_INLINE_FUNCTION void go_down(const Member& team, const Level& fine, const Splits& from, const Level& coarse,
                                    const Splits& s) {
  for_each(team, 1, from.count + 1,
           [&](const int m) { smooth_first(fine, from, m, value_of_split<Dim>(fine, from, m)); });
  for_each(team, 0, items(fine), [&](const int number) { residual<Dim>(fine, number); });
  for_each(team, 0, from.near, [&](const int k) { mend_residual<Dim>(fine, from, from.near_at[k]); });
  for_each(team, 1, from.count + 1, [&](const int m) { split_residual<Dim>(fine, from, m); });
  for_each(team, 0, items(coarse), [&](const int number) { restrict_from<Dim>(fine, coarse, number); });
  for_each(team, 1, s.count + 1, [&](const int m) { restrict_split<Dim>(fine, from, coarse, s, m); });
}

template <int Dim>
KOKKOS_INLINE_FUNCTION void go_up(const Member& team, const Level& fine, const Splits& to, const Level& coarse,
                                  const Splits& s) {
  for_each(team, 0, items(fine), [&](const int number) { prolong_to<Dim>(fine, coarse, number); });
  for_each(team, 0, to.under, [&](const int k) { prolong_splits<Dim>(fine, to, coarse, s, to.under_at[k]); });
  for_each(team, 1, to.count + 1, [&](const int m) { split_residual<Dim>(fine, to, m); });
  for_each(team, 0, items(fine), [&](const int number) { smooth<Dim>(fine, number); });
  for_each(team, 0, to.near, [&](const int k) { mend_smoothed<Dim>(fine, to, to.near_at[k]); });
  for_each(team, 1, to.count + 1,
           [&](const int m) { smooth_split(fine, to, m, value_of_split<Dim>(fine, to, m)); });
}

template <int Dim>
void launch_small_levels(const LevelStack& stack, const SplitStack& splits, int from) {
  Kokkos::parallel_for(
      "greenwater::split_small_levels", Team(1, Kokkos::AUTO), KOKKOS_LAMBDA(const Member& team) {
        const int last = stack.count - 1;
        for (int l = from; l < last; ++l)
          go_down<Dim>(team, stack.level[l], splits.level[l], stack.level[l + 1], splits.level[l + 1]);
        solve_last<Dim>(team, stack, splits);
        for (int l = last - 1; l >= from; --l)
          go_up<Dim>(team, stack.level[l], splits.level[l], stack.level[l + 1], splits.level[l + 1]);
      });
}

template <int Dim>
void cycle_in(const LevelStack& stack, const SplitStack& splits, int small) {
  for (int l = 0; l < small; ++l)
    launch_down<Dim>(stack.level[l], splits.level[l], stack.level[l + 1], splits.level[l + 1]);
  launch_small_levels<Dim>(stack, splits, small);
  for (int l = small - 1; l >= 0; --l)
    launch_up<Dim>(stack.level[l], splits.level[l], stack.level[l + 1], splits.level[l + 1]);
}

template <int Dim>
void make_rows(const Sides& sides, const LevelStack& stack, const SplitStack& splits) {
  find_sides<Dim>(sides, stack.level[0], splits.level[0]);
  make_first_rows<Dim>(sides, stack.level[0], splits.level[0]);
  weigh_smoother<Dim>(stack.level[0], splits.level[0]);
  for (int l = 1; l < stack.count; ++l) {
    const Level &fine = stack.level[l - 1], &coarse = stack.level[l];
    const Splits &from = splits.level[l - 1], &s = splits.level[l];
    find_coarse_sides<Dim>(fine, from, coarse, s);
    make_coarse_rows<Dim>(fine, from, coarse, s);
    weigh_smoother<Dim>(coarse, s);
  }
}

// All nodes up to `steps` away from those given.
std::vector<std::array<int, 3>> around(const std::vector<std::array<int, 3>>& nodes, int steps, const Level& level,
                                       int dim) {
  std::vector<std::array<int, 3>> found;
  const int high = dim == 3 ? steps : 0;
  for (const auto& n : nodes)
    for (int c = -high; c <= high; ++c)
      for (int b = -steps; b <= steps; ++b)
        for (int a = -steps; a <= steps; ++a) {
          const std::array<int, 3> m = {n[0] + a, n[1] + b, n[2] + c};
          if (m[0] >= 0 && m[1] >= 0 && m[2] >= 0 && m[0] < level.nodes[0] && m[1] < level.nodes[1] &&
              m[2] < level.nodes[2])
            found.push_back(m);
        }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::array<int, 3>> parents_of(const std::vector<std::array<int, 3>>& nodes) {
  std::vector<std::array<int, 3>> found;
  for (const auto& n : nodes)
    for (int k = n[2] / 2; k <= (n[2] + 1) / 2; ++k)
      for (int j = n[1] / 2; j <= (n[1] + 1) / 2; ++j)
        for (int i = n[0] / 2; i <= (n[0] + 1) / 2; ++i) found.push_back({i, j, k});
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::array<int, 3>> twice(std::vector<std::array<int, 3>> nodes) {
  for (auto& n : nodes)
    for (int& i : n) i *= 2;
  return nodes;
}

// Splits of which next to nothing is there are left out, as nodes are: rounding is not small beside their rows.
void invert_without_slivers(std::vector<double>& A, int count, int nodes) {
  constexpr double hardly = 1e-4;
  double most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, A[i * count + i]);
  std::vector<int> out;
  for (int i = nodes; i < count; ++i)
    if (!(A[i * count + i] > hardly * most)) out.push_back(i);
  for (const int i : out) {
    for (int j = 0; j < count; ++j) A[i * count + j] = A[j * count + i] = 0;
    A[i * count + i] = 1;
  }
  invert_in_place(A.data(), count);
  for (const int i : out) A[i * count + i] = 0;
}

template <class Field>
void grow(Field& field, const std::string& label, std::int64_t size) {
  if (static_cast<std::int64_t>(field.extent(0)) < size) field = Field(label, size + size / 4);
}

void upload(IndexField& to, const std::string& label, const std::vector<int>& from) {
  grow(to, label, static_cast<std::int64_t>(from.size()));
  if (from.empty()) return;
  Kokkos::deep_copy(Kokkos::subview(to, std::pair<std::size_t, std::size_t>(0, from.size())),
                    Kokkos::View<const int*, Kokkos::HostSpace>(from.data(), from.size()));
}

std::vector<int> positions_of(const std::vector<std::array<int, 3>>& nodes, const Level& level) {
  std::vector<int> positions;
  for (const auto& n : nodes) positions.push_back(level.position(n[0], n[1], n[2]));
  return positions;
}

void set_numbers(const Splits& s, bool there) {
  Kokkos::parallel_for(
      "greenwater::split_set_numbers", Range(1, s.count + 1),
      KOKKOS_LAMBDA(const int number) { s.number[s.at[number]] = there ? number : 0; });
}

}  // namespace

// The lists of a level: which nodes may be split, and which these have to do with.
void SplitNodes::place(int l, const Level& level, const Nodes& nodes, int dim) {
  Fields& f = fields_[l];
  Splits& s = stack_.level[l];
  if (f.number.extent(0) == 0) f.number = IndexField("greenwater::split_number", level.positions);
  s.number = f.number.data();
  std::vector<int> at = positions_of(nodes, level);
  at.insert(at.begin(), 0);
  upload(f.at, "greenwater::split_at", at);
  const Nodes near = around(nodes, reach, level, dim);
  upload(f.near_at, "greenwater::split_near", positions_of(near, level));
  s.count = static_cast<int>(nodes.size());
  s.near = static_cast<int>(near.size());
  s.at = f.at.data();
  s.near_at = f.near_at.data();
  const std::int64_t values = s.count + 1;
  const auto give = [&](FloatField& field, float*& to, const char* label, int each) {
    grow(field, label, values * each);
    to = field.data();
  };
  give(f.to_nodes, s.to_nodes, "greenwater::split_to_nodes", stencil_size(dim));
  give(f.to_splits, s.to_splits, "greenwater::split_to_splits", stencil_size(dim));
  give(f.from_nodes, s.from_nodes, "greenwater::split_from_nodes", children(dim));
  give(f.from_splits, s.from_splits, "greenwater::split_from_splits", children(dim));
  give(f.relax, s.relax, "greenwater::split_relax", 1);
  give(f.relax_rest, s.relax_rest, "greenwater::split_relax_rest", 1);
  give(f.b, s.b, "greenwater::split_b", 1);
  give(f.e, s.e, "greenwater::split_e", 1);
  give(f.left, s.left, "greenwater::split_left", 1);
  set_numbers(s, true);
}

void SplitNodes::arrange(const GridLevels& levels) {
  const LevelStack& stack = levels.stack();
  const int dim = levels.dim();
  Nodes nodes = nodes_;
  for (int l = 0; l < stack.count; ++l) {
    const Level& level = stack.level[l];
    if (stack_.level[l].number) set_numbers(stack_.level[l], false);
    place(l, level, nodes, dim);
    if (l + 1 == stack.count) break;
    nodes = parents_of(nodes);
    const Nodes under = around(twice(nodes), 1, level, dim);
    upload(fields_[l].under_at, "greenwater::split_under", positions_of(under, level));
    stack_.level[l].under = static_cast<int>(under.size());
    stack_.level[l].under_at = fields_[l].under_at.data();
  }
  std::vector<int> cells;
  for (const auto& n : nodes_)
    for (int c = 0; c < (1 << dim); ++c) {
      const int i = n[0] - (c & 1), j = n[1] - (c >> 1 & 1), k = n[2] - (c >> 2);
      if (i >= 0 && j >= 0 && k >= 0 && i < grid_.cells[0] && j < grid_.cells[1] && k < grid_.cells[2])
        cells.push_back((k * grid_.cells[1] + j) * grid_.cells[0] + i);
    }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  upload(cells_, "greenwater::split_cells", cells);
  cells_count_ = static_cast<int>(cells.size());
}

void SplitNodes::update(const Fluid& fluid, const Seats& seats, const FloatSystem& system, const GridLevels& levels) {
  const Nodes& nodes = cut_.nodes(fluid.faces, fluid.grid);
  const bool same_grid = dim_ == levels.dim() && std::equal(grid_.cells, grid_.cells + 3, seats.grid.cells);
  if (!same_grid) {
    fields_.clear();
    stack_ = {};
    inverse_ = {};
    nodes_.clear();
  }
  if (nodes.empty()) {
    nodes_.clear();
    return;
  }
  dim_ = levels.dim();
  grid_ = seats.grid;
  fields_.resize(most_levels);
  if (nodes != nodes_) {
    nodes_ = nodes;
    arrange(levels);
  }
  grow(side_, "greenwater::split_side", system.count);
  clear(side_, system.count);
  const Sides sides = {seats, system.rows, system.diagonal, side_};
  dim_ == 2 ? make_rows<2>(sides, levels.stack(), stack_) : make_rows<3>(sides, levels.stack(), stack_);
  invert_last(levels.stack());
}

void SplitNodes::invert_last(const LevelStack& stack) {
  const int count = stack.unknowns + stack_.level[stack.count - 1].count;
  if (inverse_.extent(0) == 0) {
    inverse_ = uncleared<FloatField>("greenwater::split_inverse", largest_dense * largest_dense);
    host_inverse_ = Kokkos::create_mirror_view(inverse_);
    stack_.inverse = inverse_.data();
  }
  dim_ == 2 ? fill_last<2>(stack, stack_, inverse_) : fill_last<3>(stack, stack_, inverse_);
  Kokkos::deep_copy(host_inverse_, inverse_);
  dense_.assign(host_inverse_.data(), host_inverse_.data() + count * count);
  invert_without_slivers(dense_, count, stack.unknowns);
  std::copy(dense_.begin(), dense_.end(), host_inverse_.data());
  Kokkos::deep_copy(inverse_, host_inverse_);
}

void SplitNodes::restrict_particles(const Seats& seats, const GridLevels& levels, const FloatField& t) const {
  if (!any()) return;
  dim_ == 2 ? restrict_to_splits<2>(seats, side_, levels.first(), stack_.level[0], t)
            : restrict_to_splits<3>(seats, side_, levels.first(), stack_.level[0], t);
}

void SplitNodes::prolong_to_particles(const Seats& seats, const GridLevels& levels, const FloatField& z) const {
  if (!any()) return;
  dim_ == 2 ? prolong_from_splits<2>(seats, side_, cells_, cells_count_, levels.first(), stack_.level[0], z)
            : prolong_from_splits<3>(seats, side_, cells_, cells_count_, levels.first(), stack_.level[0], z);
}

void SplitNodes::cycle(const GridLevels& levels) const {
  dim_ == 2 ? cycle_in<2>(levels.stack(), stack_, levels.small()) : cycle_in<3>(levels.stack(), stack_, levels.small());
}

}  // namespace greenwater
