#include "kernels/split_rows.hpp"

namespace greenwater {
namespace {

/// Around a coarser node: the finer ones under it, each in one or two halves. Half 1 is what its split stands for, half 0
/// the rest.
template <int Dim>
struct Patch {
  static constexpr int size = stencil_size(Dim), count = 2 * children(Dim);
  const Level& level;
  const Splits& splits;
  int position[children(Dim)], stencil[children(Dim)], number[children(Dim)];
  float weight[count];  // of the halves' diagonals; 0: is not there

  KOKKOS_INLINE_FUNCTION Patch(const Level& fine, const Splits& s, const Node& n) : level(fine), splits(s) {
    for_children<Dim>(fine, n, [&](const int child, const int at) {
      const int a = child % 3 - 1, b = child / 3 % 3 - 1, c = Dim == 3 ? child / 9 - 1 : 0;
      const Node m = {2 * n.i + a, 2 * n.j + b, 2 * n.k + c};
      const bool there =
          m.i >= 0 && m.j >= 0 && m.k >= 0 && m.i < fine.nodes[0] && m.j < fine.nodes[1] && m.k < fine.nodes[2];
      position[child] = at;
      const int value = there ? value_of(fine, m) : 0;
      stencil[child] = value / node_lanes * size * node_lanes + value % node_lanes;
      number[child] = there ? s.number[at] : 0;
      weight[2 * child] = weight[2 * child + 1] = 0;
    });
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

/// Calls f(node of the coarser level, weight) for those that the finer node at n + (a, b, c) is interpolated from.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_parents(const Node& n, F f) {
  for (int k = n.k >> 1; k <= (n.k + 1) >> 1; ++k)
    for (int j = n.j >> 1; j <= (n.j + 1) >> 1; ++j)
      for (int i = n.i >> 1; i <= (n.i + 1) >> 1; ++i)
        f(Node{i, j, k}, (n.i & 1 ? 0.5f : 1.0f) * (n.j & 1 ? 0.5f : 1.0f) * (n.k & 1 ? 0.5f : 1.0f));
}

}  // namespace

template <int Dim>
void find_coarse_sides(const Level& fine, const Splits& from, const Level& coarse, const Splits& s) {
  Kokkos::parallel_for(
      "greenwater::split_find_coarse_sides", Range(1, s.count + 1), KOKKOS_LAMBDA(const int number) {
        const Node n = node_at<Dim>(coarse, s.at[number]);
        const Patch<Dim> patch(fine, from, n);
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

template void find_coarse_sides<2>(const Level&, const Splits&, const Level&, const Splits&);
template void make_coarse_rows<2>(const Level&, const Splits&, const Level&, const Splits&);
template void weigh_smoother<2>(const Level&, const Splits&);
template void find_coarse_sides<3>(const Level&, const Splits&, const Level&, const Splits&);
template void make_coarse_rows<3>(const Level&, const Splits&, const Level&, const Splits&);
template void weigh_smoother<3>(const Level&, const Splits&);

}  // namespace greenwater
