#pragma once
// Nodes of a level of the multigrid that a plate splits.
//
// A node's value says something about all particles around it. Where a plate stands between them it should say one thing
// on this side and another on that: such a node has a second value, its split, that is added on one side of the plate
// alone. What is a side? Particles around a node that are not connected, row by row, within the cells around it. So a
// plate may be bent, or have an end: nodes at its end are not split, as water goes round it.
//
// Together with the nodes' values those of the splits are a finer space on each level, with its own part of the matrix
// P^T A P. After the nodes were smoothed the splits are, and in the reverse order on the way up. All this is local: a few
// hundred nodes along the plates.

#include "kernels/grid_level.hpp"

namespace greenwater {

/// Device view of the nodes of one level that may be split; number 0 stands for all others. Where a node is not split after
/// all everything is zero.
struct Splits {
  int count = 0;  // numbers 1 ... count
  int near = 0;   // nodes whose rows a split may have an entry in
  int under = 0;  // nodes under those of the coarser level that may be split

  int* number = nullptr;          // (position)
  const int* at = nullptr;        // (number) position
  const int* near_at = nullptr;   // positions
  const int* under_at = nullptr;  // positions

  float* to_nodes = nullptr;     // (number, entry)  rows of A that belong to splits: entries of nodes, and
  float* to_splits = nullptr;    // (number, entry)  of splits
  float* relax = nullptr;        // (number)         what the smoother multiplies residuals with: the split's side, and
  float* relax_rest = nullptr;   // (number)         the rest of its node
  float* from_nodes = nullptr;   // (number, child)  what a split's function is made of on the finer level: nodes, and
  float* from_splits = nullptr;  // (number, child)  splits
  float* b = nullptr;            // (number) right side
  float* e = nullptr;            // (number) solution
  float* left = nullptr;         // (number) residual
};

constexpr int children(int dim) { return dim == 2 ? 9 : 27; }

struct Node {
  int i, j, k;
};

template <int Dim>
KOKKOS_INLINE_FUNCTION Node node_at(const Level& level, int position) {
  const int p = position - level.origin, k = Dim == 3 ? p / level.layer : 0, line = p - k * level.layer;
  return {line % level.row, line / level.row, k};
}

/// Its place in fields (slot, lane); below node_lanes where there is no fluid.
KOKKOS_INLINE_FUNCTION int value_of(const Level& level, const Node& n) {
  const int slot = level.slot[(n.k * level.nodes[1] + n.j) * level.packs + n.i / node_lanes];
  return slot * node_lanes + n.i % node_lanes;
}

/// Calls f(entry, step from the node's position to that of the entry) for all entries of a stencil.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_stencil(const Level& level, F f) {
  constexpr int high = Dim == 3 ? reach : 0;
  int entry = 0;
  for (int dz = -high; dz <= high; ++dz)
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx, ++entry) f(entry, dz * level.layer + dy * level.row + dx);
}

/// left = b - A x - A e of a split.
template <int Dim>
KOKKOS_INLINE_FUNCTION void split_residual(const Level& level, const Splits& s, int number) {
  const float* to_nodes = s.to_nodes + number * stencil_size(Dim);
  const float* to_splits = s.to_splits + number * stencil_size(Dim);
  const int at = s.at[number];
  float sum = 0;
  for_stencil<Dim>(level, [&](const int entry, const int way) {
    sum += to_nodes[entry] * level.x[at + way] + to_splits[entry] * s.e[s.number[at + way]];
  });
  s.left[number] = s.b[number] - sum;
}

/// A e of a node.
template <int Dim>
KOKKOS_INLINE_FUNCTION float product_at_node(const Level& level, const Splits& s, int position) {
  constexpr int size = stencil_size(Dim);
  float sum = 0;
  for_stencil<Dim>(level, [&](const int entry, const int way) {
    const int number = s.number[position + way];
    if (number > 0) sum += s.to_nodes[number * size + size - 1 - entry] * s.e[number];
  });
  return sum;
}

/// The first smoothing from zero at a node that is split: each side of it has its own.
KOKKOS_INLINE_FUNCTION void smooth_first(const Level& level, const Splits& s, int number, int value) {
  s.e[number] = 0;
  if (!(s.relax[number] > 0)) return;
  const float rest = s.relax_rest[number] * (level.b[value] - s.b[number]);
  level.x[s.at[number]] = rest;
  s.e[number] = s.relax[number] * s.b[number] - rest;
}

/// y of a node less what splits make of its residual.
template <int Dim>
KOKKOS_INLINE_FUNCTION void mend_residual(const Level& level, const Splits& s, int position) {
  if (value_of(level, node_at<Dim>(level, position)) >= node_lanes)
    level.y[position] -= product_at_node<Dim>(level, s, position);
}

/// The same of a node that was smoothed.
template <int Dim>
KOKKOS_INLINE_FUNCTION void mend_smoothed(const Level& level, const Splits& s, int position) {
  const int value = value_of(level, node_at<Dim>(level, position));
  if (value >= node_lanes) level.y[position] -= level.relax[value] * product_at_node<Dim>(level, s, position);
}

/// Smoothing of a node that is split, from its residual and that of the split. Its y is that of a smoothed node.
KOKKOS_INLINE_FUNCTION void smooth_split(const Level& level, const Splits& s, int number, int value) {
  if (!(s.relax[number] > 0)) return;
  const int at = s.at[number];
  const float residual = (level.y[at] - level.x[at]) / level.relax[value];
  const float rest = s.relax_rest[number] * (residual - s.left[number]);
  level.y[at] = level.x[at] + rest;
  s.e[number] += s.relax[number] * s.left[number] - rest;
}

/// Calls f(child, position) for the finer nodes that a node's function is made of.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_children(const Level& fine, const Node& n, F f) {
  constexpr int high = Dim == 3 ? 1 : 0;
  int child = 0;
  for (int c = -high; c <= high; ++c)
    for (int b = -1; b <= 1; ++b)
      for (int a = -1; a <= 1; ++a, ++child) f(child, fine.position(2 * n.i + a, 2 * n.j + b, 2 * n.k + c));
}

/// The right side of a split from the finer level's residuals.
template <int Dim>
KOKKOS_INLINE_FUNCTION void restrict_split(const Level& fine, const Splits& from, const Level& coarse, const Splits& s,
                                           int number) {
  constexpr int size = children(Dim);
  float b = 0;
  for_children<Dim>(fine, node_at<Dim>(coarse, s.at[number]), [&](const int child, const int position) {
    const int place = number * size + child;
    b += s.from_nodes[place] * fine.y[position] + s.from_splits[place] * from.left[from.number[position]];
  });
  s.b[number] = b;
}

/// Adds to a finer node, and to its split, what coarser splits say.
template <int Dim>
KOKKOS_INLINE_FUNCTION void prolong_splits(const Level& fine, const Splits& to, const Level& coarse, const Splits& s,
                                           int position) {
  const Node n = node_at<Dim>(fine, position);
  float node = 0, split = 0;
  for (int k = n.k / 2; k <= (n.k + 1) / 2; ++k)
    for (int j = n.j / 2; j <= (n.j + 1) / 2; ++j)
      for (int i = n.i / 2; i <= (n.i + 1) / 2; ++i) {
        const int number = s.number[coarse.position(i, j, k)];
        if (number == 0) continue;
        const int a = n.i - 2 * i + 1, b = n.j - 2 * j + 1, c = Dim == 3 ? n.k - 2 * k + 1 : 0;
        const int place = number * children(Dim) + (c * 3 + b) * 3 + a;
        node += s.from_nodes[place] * s.e[number];
        split += s.from_splits[place] * s.e[number];
      }
  fine.x[position] += node;
  if (to.number[position] > 0) to.e[to.number[position]] += split;
}

}  // namespace greenwater
