#pragma once
// One level of the multigrid: nodes, sixteen along x side by side in memory as rows of neighbours are, and the matrix
// between them.
//
// Only packs of nodes that touch the fluid cost time or hold a stencil: they have numbers 1, 2 ... (slots), and slot 0
// stands for all others, with a stencil of zeros. Vectors are dense, with room all round for the neighbours of the
// outermost nodes, and zero wherever there is no fluid.

#include "core/lanes.hpp"

namespace greenwater {

constexpr int node_lanes = 16;  // nodes of a pack
constexpr int reach = 2;        // a node's stencil goes so many nodes to either side
constexpr int across = 2 * reach + 1;
/// Nodes of a stencil.
constexpr int stencil_size(int dim) { return dim == 2 ? across * across : across * across * across; }

/// Packs of nodes that a kernel body works on are FloatPacks: one whole pack on a host, one node on a GPU.
constexpr int items_of_pack = node_lanes / float_lanes;
using NodeIndex = Lanes<int, float_lanes>;

/// Device view of a level. The matrix A and all vectors are those of the level.
struct Level {
  int nodes[3] = {1, 1, 1};  // along each axis
  int packs = 1;             // along x
  int row = 0, layer = 0;    // from a position to the next in y, in z
  int origin = 0;            // position of node (0, 0, 0)
  int positions = 0;         // in all
  int active = 0;            // slots 1 ... active
  int* slot = nullptr;       // (pack)
  int* pack = nullptr;       // (slot)
  float* stencil = nullptr;  // (slot, entry, lane)  A, x fastest from -2 to 2
  float* relax =
      nullptr;         // (slot, lane)         what the smoother multiplies a residual with; 0 where there is no fluid
  float* b = nullptr;  // (slot, lane)         right side
  float* x = nullptr;  // (position)           A x = b, and
  float* y = nullptr;  // (position)           its residual or the next x

  KOKKOS_INLINE_FUNCTION int position(int i, int j, int k) const { return origin + i + j * row + k * layer; }
};

/// Where an item of a level's work is: node (i, j, k), and i + 1, i + 2 ... in further lanes.
struct Item {
  int i, j, k;
  int position;
  int value;    // in fields (slot, lane)
  int stencil;  // in the field (slot, entry, lane)

  KOKKOS_INLINE_FUNCTION Item(const Level& level, int number, int entries) {
    const int slot = 1 + number / items_of_pack, lane = number % items_of_pack * float_lanes;
    const int pack = level.pack[slot], line = pack / level.packs;
    i = pack % level.packs * node_lanes + lane;
    j = line % level.nodes[1];
    k = line / level.nodes[1];
    position = level.position(i, j, k);
    value = slot * node_lanes + lane;
    stencil = slot * entries * node_lanes + lane;
  }
};

KOKKOS_INLINE_FUNCTION int items(const Level& level) { return level.active * items_of_pack; }

/// How far apart the rows of a dense matrix lie: so that packs of rows can be read from any of them.
constexpr int dense_stride(int size) { return (size + node_lanes - 1) / node_lanes * node_lanes; }

/// Rows from `row` on of a symmetric dense matrix times a vector, whose entry c is value(c).
template <class F>
KOKKOS_INLINE_FUNCTION FloatPack dense_product(const float* matrix, int size, int row, F value) {
  const int stride = dense_stride(size);
  FloatPack sum{};
  for (int c = 0; c < size; ++c) sum += value(c) * load_lanes<FloatPack>(matrix + c * stride + row);
  return sum;
}

/// A x of an item's nodes.
template <int Dim>
KOKKOS_INLINE_FUNCTION FloatPack stencil_product(const Level& level, const Item& at) {
  const float* a = level.stencil + at.stencil;
  const float* x = level.x + at.position;
  constexpr int high = Dim == 3 ? reach : 0;
  FloatPack sum[across] = {};
  for (int dz = -high; dz <= high; ++dz)
    for (int dy = -reach; dy <= reach; ++dy)
      for (int dx = -reach; dx <= reach; ++dx, a += node_lanes)
        sum[dx + reach] += load_lanes<FloatPack>(a) * load_lanes<FloatPack>(x + dz * level.layer + dy * level.row + dx);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]) + sum[4];
}

/// y = b - A x
template <int Dim>
KOKKOS_INLINE_FUNCTION void residual(const Level& level, int number) {
  const Item at(level, number, stencil_size(Dim));
  store_lanes(level.y + at.position, load_lanes<FloatPack>(level.b + at.value) - stencil_product<Dim>(level, at));
}

/// y = x + relax (b - A x)
template <int Dim>
KOKKOS_INLINE_FUNCTION void smooth(const Level& level, int number) {
  const Item at(level, number, stencil_size(Dim));
  const FloatPack left = load_lanes<FloatPack>(level.b + at.value) - stencil_product<Dim>(level, at);
  store_lanes(level.y + at.position,
              load_lanes<FloatPack>(level.x + at.position) + load_lanes<FloatPack>(level.relax + at.value) * left);
}

/// b = P^T y of the finer level, and x = relax b: the first smoothing from zero.
template <int Dim>
KOKKOS_INLINE_FUNCTION void restrict_from(const Level& fine, const Level& coarse, int number) {
  const Item at(coarse, number, stencil_size(Dim));
  const NodeIndex even = 2 * counted_lanes<NodeIndex>();
  const float* y = fine.y + fine.position(2 * at.i, 2 * at.j, 2 * at.k);
  constexpr int high = Dim == 3 ? 1 : 0;
  FloatPack b{};
  for (int dz = -high; dz <= high; ++dz)
    for (int dy = -1; dy <= 1; ++dy) {
      const float* line = y + dz * fine.layer + dy * fine.row;
      const FloatPack sides = gather_lanes<FloatPack>(line - 1, even) + gather_lanes<FloatPack>(line + 1, even);
      const float weight = (dy == 0 ? 1.0f : 0.5f) * (dz == 0 ? 1.0f : 0.5f);
      b += weight * (gather_lanes<FloatPack>(line, even) + 0.5f * sides);
    }
  const FloatPack relax = load_lanes<FloatPack>(coarse.relax + at.value);
  b = zero_unless(relax != 0.0f, b);
  store_lanes(coarse.b + at.value, b);
  store_lanes(coarse.x + at.position, relax * b);
}

/// x = x + P y of the coarser level; not where there is no fluid.
template <int Dim>
KOKKOS_INLINE_FUNCTION void prolong_to(const Level& fine, const Level& coarse, int number) {
  const Item at(fine, number, stencil_size(Dim));
  // A node lies on a coarse one or between two: twice the same, or both neighbours, and half of each.
  const NodeIndex i = at.i + counted_lanes<NodeIndex>(), left = i / 2, right = (i + 1) / 2;
  const int low[2] = {at.j / 2, at.k / 2}, high[2] = {(at.j + 1) / 2, (at.k + 1) / 2};
  FloatPack sum{};
  for (int sz = 0; sz < (Dim == 3 ? 2 : 1); ++sz)
    for (int sy = 0; sy < 2; ++sy) {
      const float* y = coarse.y + coarse.position(0, sy ? high[0] : low[0], sz ? high[1] : low[1]);
      sum += gather_lanes<FloatPack>(y, left) + gather_lanes<FloatPack>(y, right);
    }
  const FloatPack share = (Dim == 3 ? 0.125f : 0.25f) * sum;
  const FloatPack relax = load_lanes<FloatPack>(fine.relax + at.value);
  const FloatPack x = load_lanes<FloatPack>(fine.x + at.position);
  store_lanes(fine.x + at.position, x + zero_unless(relax != 0.0f, share));
}

}  // namespace greenwater
