#include "kernels/grid_levels.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "core/check.hpp"

namespace greenwater {

static_assert(dense_stride(coarsest_nodes) == coarsest_nodes);

namespace {

using Team = Kokkos::TeamPolicy<Space>;
using Member = Team::member_type;

// Levels of fewer nodes than this are done by one team in one launch: waking all threads for each takes longer.
constexpr int small_nodes = 4096;

int packs_of(const Level& level) { return level.packs * level.nodes[1] * level.nodes[2]; }

// What was written where fluid was becomes zero again.
void forget(const Level& level) {
  Kokkos::parallel_for(
      "greenwater::grid_forget", Range(0, items(level)), KOKKOS_LAMBDA(const int number) {
        const Item at(level, number, 0);
        store_lanes(level.x + at.position, FloatPack{});
        store_lanes(level.y + at.position, FloatPack{});
        if (number % items_of_pack == 0) level.slot[level.pack[1 + number / items_of_pack]] = 0;
      });
}

// Slots for the packs that are wanted; returns how many.
int number_wanted(const Level& level, const IndexField& wanted) {
  int active = 0;
  Kokkos::parallel_scan(
      "greenwater::grid_number_packs", Range(0, packs_of(level)),
      KOKKOS_LAMBDA(const int pack, int& sum, const bool last) {
        if (!wanted(pack)) return;
        ++sum;
        if (!last) return;
        level.slot[pack] = sum;
        level.pack[sum] = pack;
      },
      active);
  return active;
}

// A coarse pack is wanted where one of the fine packs is that its nodes reach.
void want_coarse(const Level& fine, const Level& coarse, const IndexField& wanted) {
  Kokkos::parallel_for(
      "greenwater::grid_want_packs", Range(0, packs_of(coarse)), KOKKOS_LAMBDA(const int pack) {
        const int p = pack % coarse.packs, line = pack / coarse.packs;
        const int j = line % coarse.nodes[1], k = line / coarse.nodes[1];
        int found = 0;
        for (int fk = larger(2 * k - 1, 0); fk <= smaller(2 * k + 1, fine.nodes[2] - 1); ++fk)
          for (int fj = larger(2 * j - 1, 0); fj <= smaller(2 * j + 1, fine.nodes[1] - 1); ++fj)
            for (int fp = larger(2 * p - 1, 0); fp <= smaller(2 * p + 1, fine.packs - 1); ++fp)
              found |= fine.slot[(fk * fine.nodes[1] + fj) * fine.packs + fp];
        wanted(pack) = found != 0;
      });
}

// Places in the stencil field of nodes i, i + 2, i + 4 ... of line (j, k): those that are not there have slot 0.
template <int Dim>
KOKKOS_INLINE_FUNCTION NodeIndex stencils_along(const Level& level, int i, int j, int k) {
  NodeIndex place{};
  const bool outside = j < 0 || j >= level.nodes[1] || k < 0 || k >= level.nodes[2];
  for (int l = 0; l < float_lanes; ++l) {
    const int node = i + 2 * l;
    const bool there = !outside && node >= 0 && node < level.packs * node_lanes;
    const int slot = there ? level.slot[(k * level.nodes[1] + j) * level.packs + node / node_lanes] : 0;
    set_lane(place, l, slot * stencil_size(Dim) * node_lanes + (there ? node % node_lanes : 0));
  }
  return place;
}

// Adds `value` to where the fine node at `offset` from a coarse one is interpolated from: one coarse node or two.
template <class Target>
KOKKOS_INLINE_FUNCTION void spread(int offset, const FloatPack& value, Target target) {
  if (offset % 2 == 0) {
    target(offset / 2, value);
  } else {
    target((offset - 1) / 2, 0.5f * value);
    target((offset + 1) / 2, 0.5f * value);
  }
}

// One line of fine stencils in x: sum over nodes 2 i + a and entries dx.
KOKKOS_INLINE_FUNCTION void contract_line(const float* stencil, const NodeIndex (&place)[3], float weight,
                                          FloatPack (&sum)[across]) {
  for (FloatPack& s : sum) s = FloatPack{};
  for (int a = -1; a <= 1; ++a)
    for (int dx = -reach; dx <= reach; ++dx) {
      const float share = a == 0 ? weight : 0.5f * weight;
      const FloatPack value = share * gather_lanes<FloatPack>(stencil + (dx + reach) * node_lanes, place[a + 1]);
      // (a + dx - 1) / 2 must round down, hence the shift by four nodes.
      spread(a + dx + 4, value, [&](const int k, const FloatPack& part) { sum[k - 2 + reach] += part; });
    }
}

// A of the coarser level: P^T A P, a sum over the fine nodes around each coarse one.
template <int Dim>
void contract(const Level& fine, const Level& coarse) {
  constexpr int size = stencil_size(Dim), high = Dim == 3 ? 1 : 0, deep = Dim == 3 ? reach : 0;
  Kokkos::parallel_for(
      "greenwater::grid_coarsen", Range(0, items(coarse)), KOKKOS_LAMBDA(const int number) {
        const Item at(coarse, number, size);
        FloatPack sum[size] = {};
        for (int c = -high; c <= high; ++c)
          for (int b = -1; b <= 1; ++b) {
            NodeIndex place[3];
            for (int a = -1; a <= 1; ++a)
              place[a + 1] = stencils_along<Dim>(fine, 2 * at.i + a, 2 * at.j + b, 2 * at.k + c);
            const float weight = (b == 0 ? 1.0f : 0.5f) * (c == 0 ? 1.0f : 0.5f);
            const float* stencil = fine.stencil;
            for (int dz = -deep; dz <= deep; ++dz)
              for (int dy = -reach; dy <= reach; ++dy, stencil += across * node_lanes) {
                FloatPack line[across];
                contract_line(stencil, place, weight, line);
                for (int x = 0; x < across; ++x)
                  spread(b + dy + 4, line[x], [&](const int y, const FloatPack& part) {
                    if constexpr (Dim == 2)
                      sum[y * across + x] += part;
                    else
                      spread(c + dz + 4, part,
                             [&](const int z, const FloatPack& piece) { sum[(z * across + y) * across + x] += piece; });
                  });
              }
          }
        for (int e = 0; e < size; ++e) store_lanes(coarse.stencil + at.stencil + e * node_lanes, sum[e]);
      });
}

// relax = 0.95 / ((a_ii + sum_k |a_ik|) / 2): between what is good for a matrix with a dominant diagonal and what is safe
// for any. No eigenvalue needs to be known: the smoother always converges.
template <int Dim>
void weigh_smoother(const Level& level) {
  Kokkos::parallel_for(
      "greenwater::grid_weigh_smoother", Range(0, items(level)), KOKKOS_LAMBDA(const int number) {
        constexpr int size = stencil_size(Dim);
        const Item at(level, number, size);
        const float* a = level.stencil + at.stencil;
        FloatPack sum{};
        for (int e = 0; e < size; ++e) {
          const FloatPack entry = load_lanes<FloatPack>(a + e * node_lanes);
          sum += larger(entry, -entry);
        }
        const FloatPack own = load_lanes<FloatPack>(a + size / 2 * node_lanes);
        const FloatPack relax = 1.9f / (own + sum);
        store_lanes(level.relax + at.value, zero_unless(own > 0.0f, relax));
      });
}

template <int Dim>
void launch_residual(const Level& level) {
  Kokkos::parallel_for(
      "greenwater::grid_residual", Range(0, items(level)),
      KOKKOS_LAMBDA(const int number) { residual<Dim>(level, number); });
}

template <int Dim>
void launch_smooth(const Level& level) {
  Kokkos::parallel_for(
      "greenwater::grid_smooth", Range(0, items(level)),
      KOKKOS_LAMBDA(const int number) { smooth<Dim>(level, number); });
}

template <int Dim>
void launch_restrict(const Level& fine, const Level& coarse) {
  Kokkos::parallel_for(
      "greenwater::grid_restrict", Range(0, items(coarse)),
      KOKKOS_LAMBDA(const int number) { restrict_from<Dim>(fine, coarse, number); });
}

template <int Dim>
void launch_prolong(const Level& fine, const Level& coarse) {
  Kokkos::parallel_for(
      "greenwater::grid_prolong", Range(0, items(fine)),
      KOKKOS_LAMBDA(const int number) { prolong_to<Dim>(fine, coarse, number); });
}

Team one_team() { return on_host ? Team(1, 1) : Team(1, Kokkos::AUTO); }

// For every item of a level, by the threads of a team; all are done before it returns.
template <class F>
KOKKOS_INLINE_FUNCTION void for_items(const Member& team, const Level& level, const F& f) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, level.active * items_of_pack), f);
  team.team_barrier();
}

// y = A^-1 b on the last level.
KOKKOS_INLINE_FUNCTION void solve_last(const Member& team, const LevelStack& stack) {
  const Level& last = stack.level[stack.count - 1];
  const int count = stack.unknowns;
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, (count + float_lanes - 1) / float_lanes), [&](const int pack) {
    const int row = pack * float_lanes;
    const auto y = dense_product(stack.inverse, count, row, [&](const int c) { return last.b[stack.value[c]]; });
    for (int l = 0; l < float_lanes && row + l < count; ++l) last.y[stack.position[row + l]] = lane(y, l);
  });
  team.team_barrier();
}

template <int Dim>
void launch_small_levels(const LevelStack& stack, int from) {
  Kokkos::parallel_for(
      "greenwater::grid_small_levels", one_team(), KOKKOS_LAMBDA(const Member& team) {
        const int last = stack.count - 1;
        for (int l = from; l < last; ++l) {
          const Level &fine = stack.level[l], &coarse = stack.level[l + 1];
          for_items(team, fine, [&](const int number) { residual<Dim>(fine, number); });
          for_items(team, coarse, [&](const int number) { restrict_from<Dim>(fine, coarse, number); });
        }
        solve_last(team, stack);
        for (int l = last - 1; l >= from; --l) {
          const Level &fine = stack.level[l], &coarse = stack.level[l + 1];
          for_items(team, fine, [&](const int number) { prolong_to<Dim>(fine, coarse, number); });
          for_items(team, fine, [&](const int number) { smooth<Dim>(fine, number); });
        }
      });
}

template <int Dim>
void cycle_in(const LevelStack& stack, int small) {
  for (int l = 0; l < small; ++l) {
    launch_residual<Dim>(stack.level[l]);
    launch_restrict<Dim>(stack.level[l], stack.level[l + 1]);
  }
  launch_small_levels<Dim>(stack, small);
  for (int l = small - 1; l >= 0; --l) {
    launch_prolong<Dim>(stack.level[l], stack.level[l + 1]);
    launch_smooth<Dim>(stack.level[l]);
  }
}

// The nodes of the last level that have fluid, on the host.
struct Unknowns {
  struct Node {
    int i, j, k, value, position, stencil;
  };
  std::array<Node, coarsest_nodes> node;
  std::vector<int> number;  // (node of the level) of the unknown, or -1
  int count = 0;            // more than there is room for: the level is too large to be the last
};

int node_number(const Level& level, int i, int j, int k) { return (k * level.nodes[1] + j) * level.nodes[0] + i; }

// a_ii of the node that has this place in fields (slot, lane).
float own_entry(const Level& level, int value, int size) {
  return level.stencil[(value / node_lanes * size + size / 2) * node_lanes + value % node_lanes];
}

// Nodes that the fluid hardly touches are left out: their rows are next to nothing, and rounding is not small beside it.
Unknowns unknowns_of(const Level& level, int size) {
  constexpr float hardly = 1e-4f;
  Unknowns found;
  found.number.assign(static_cast<std::size_t>(level.nodes[0]) * level.nodes[1] * level.nodes[2], -1);
  float most = 0;
  for (int value = node_lanes; value < (level.active + 1) * node_lanes; ++value)
    most = std::max(most, own_entry(level, value, size));
  for (int slot = 0; slot < level.active; ++slot) {
    const Item pack(level, slot * items_of_pack, size);
    for (int lane = 0; lane < node_lanes && pack.i + lane < level.nodes[0]; ++lane) {
      const Unknowns::Node node = {pack.i + lane,      pack.j, pack.k, pack.value + lane, pack.position + lane,
                                   pack.stencil + lane};
      if (!(own_entry(level, node.value, size) > hardly * most)) continue;
      if (found.count == coarsest_nodes) return {{}, {}, coarsest_nodes + 1};
      found.number[node_number(level, node.i, node.j, node.k)] = found.count;
      found.node[found.count++] = node;
    }
  }
  return found;
}

// A(row, column)
void fill_matrix(const Level& level, const Unknowns& unknowns, int dim, std::vector<double>& A) {
  A.assign(static_cast<std::size_t>(unknowns.count) * unknowns.count, 0.0);
  const int deep = dim == 3 ? reach : 0;
  const auto outside = [&](int axis, int n) { return n < 0 || n >= level.nodes[axis]; };
  for (int row = 0; row < unknowns.count; ++row) {
    const Unknowns::Node& node = unknowns.node[row];
    const float* entry = level.stencil + node.stencil;
    for (int k = node.k - deep; k <= node.k + deep; ++k)
      for (int j = node.j - reach; j <= node.j + reach; ++j)
        for (int i = node.i - reach; i <= node.i + reach; ++i, entry += node_lanes) {
          if (outside(0, i) || outside(1, j) || outside(2, k)) continue;
          const int column = unknowns.number[node_number(level, i, j, k)];
          if (column >= 0) A[row * unknowns.count + column] = *entry;
        }
  }
}

template <class Field>
void grow(Field& field, const std::string& label, std::int64_t size) {
  if (static_cast<std::int64_t>(field.extent(0)) < size) field = Field(label, size + size / 4);
}

}  // namespace

void GridLevels::make_level(int l, const int (&nodes)[3]) {
  Level& level = stack_.level[l];
  for (int d = 0; d < 3; ++d) level.nodes[d] = nodes[d];
  level.packs = (nodes[0] + node_lanes - 1) / node_lanes;
  level.row = (level.packs + 1) * node_lanes;
  level.layer = (nodes[1] + 2 * reach) * level.row;
  const bool flat = dim_ == 2;
  level.origin = node_lanes + reach * level.row + (flat ? 0 : reach * level.layer);
  level.active = 0;
  // Beyond the last line some more, as packs of the coarser level reach beyond the last node.
  const std::int64_t positions =
      static_cast<std::int64_t>(nodes[2] + (flat ? 0 : 2 * reach)) * level.layer + 4 * node_lanes;
  require<ResourceError>(positions < std::numeric_limits<int>::max() / 2,
                         "the domain has too many cells for the multigrid: make it smaller, or choose "
                         "mps.pressure.preconditioner = \"jacobi\"");
  level.positions = static_cast<int>(positions);
  Fields& fields = fields_[l];
  const int packs = packs_of(level);
  fields.slot = IndexField("greenwater::grid_slot", packs);
  fields.pack = uncleared<IndexField>("greenwater::grid_pack", packs + 1);
  fields.x = FloatField("greenwater::grid_x", positions);
  fields.y = FloatField("greenwater::grid_y", positions);
  level.slot = fields.slot.data();
  level.pack = fields.pack.data();
  level.x = fields.x.data();
  level.y = fields.y.data();
}

void GridLevels::resize(const GridShape& grid, int dim) {
  if (dim == dim_ && std::equal(grid.cells, grid.cells + 3, grid_.cells)) return;
  grid_ = grid;
  dim_ = dim;
  fields_.assign(most_levels, {});
  int nodes[3] = {grid.cells[0] + 1, grid.cells[1] + 1, dim == 3 ? grid.cells[2] + 1 : 1};
  for (levels_ = 0;;) {
    expect(levels_ < most_levels);
    make_level(levels_++, nodes);
    if (static_cast<double>(nodes[0]) * nodes[1] * nodes[2] <= coarsest_nodes) break;
    for (int d = 0; d < dim; ++d) nodes[d] = nodes[d] / 2 + 1;
  }
  wanted_ = uncleared<IndexField>("greenwater::grid_wanted", packs_of(stack_.level[0]));
  make_last();
}

// What the host reads and writes of the last level each step.
void GridLevels::make_last() {
  host_pack_.assign(levels_, {});
  host_stencil_.assign(levels_, {});
  inverse_ = uncleared<FloatField>("greenwater::grid_inverse", coarsest_nodes * coarsest_nodes);
  last_value_ = uncleared<IndexField>("greenwater::grid_last_value", coarsest_nodes);
  last_position_ = uncleared<IndexField>("greenwater::grid_last_position", coarsest_nodes);
  host_inverse_ = Kokkos::create_mirror_view(inverse_);
  host_value_ = Kokkos::create_mirror_view(last_value_);
  host_position_ = Kokkos::create_mirror_view(last_position_);
  stack_.inverse = inverse_.data();
  stack_.value = last_value_.data();
  stack_.position = last_position_.data();
}

void GridLevels::grow_values(int l, int slots) {
  const std::int64_t values = static_cast<std::int64_t>(slots + 1) * node_lanes;
  Fields& fields = fields_[l];
  grow(fields.stencil, "greenwater::grid_stencil", values * stencil_size(dim_));
  grow(fields.relax, "greenwater::grid_relax", values);
  grow(fields.b, "greenwater::grid_b", values);
  Level& level = stack_.level[l];
  level.stencil = fields.stencil.data();
  level.relax = fields.relax.data();
  level.b = fields.b.data();
}

void GridLevels::activate() {
  for (int l = 0; l < levels_; ++l) {
    Level& level = stack_.level[l];
    forget(level);
    if (l > 0) want_coarse(stack_.level[l - 1], level, wanted_);
    level.active = number_wanted(level, wanted_);
    grow_values(l, level.active);
  }
}

// The last level is the first one whose nodes with fluid are few: on coarser ones, whose hats are wider than the fluid, the
// corrections would be worse.
void GridLevels::coarsen() {
  const bool flat = dim_ == 2;
  for (int l = 0; l < levels_; ++l) {
    const Level& level = stack_.level[l];
    if (l > 0) flat ? contract<2>(stack_.level[l - 1], level) : contract<3>(stack_.level[l - 1], level);
    flat ? weigh_smoother<2>(level) : weigh_smoother<3>(level);
    stack_.count = l + 1;
    if (level.active * node_lanes <= small_nodes && invert_last()) break;
  }
  small_ = stack_.count - 1;
  for (int l = stack_.count - 1; l >= 0; --l)
    if (stack_.level[l].active * node_lanes <= small_nodes) small_ = l;
}

// False when the level has more nodes with fluid than can be solved directly.
bool GridLevels::invert_last() {
  const int l = stack_.count - 1;
  Level last = stack_.level[l];
  const Fields& fields = fields_[l];
  if (host_pack_[l].extent(0) != fields.pack.extent(0)) host_pack_[l] = Kokkos::create_mirror_view(fields.pack);
  if (host_stencil_[l].extent(0) != fields.stencil.extent(0))
    host_stencil_[l] = Kokkos::create_mirror_view(fields.stencil);
  Kokkos::deep_copy(host_pack_[l], fields.pack);
  Kokkos::deep_copy(host_stencil_[l], fields.stencil);
  last.pack = host_pack_[l].data();
  last.stencil = host_stencil_[l].data();
  const Unknowns unknowns = unknowns_of(last, stencil_size(dim_));
  if (unknowns.count > coarsest_nodes) return false;
  fill_matrix(last, unknowns, dim_, dense_);
  dense_inverse_.invert(dense_.data(), unknowns.count);
  stack_.unknowns = unknowns.count;
  for (int row = 0; row < unknowns.count; ++row) {
    host_value_(row) = unknowns.node[row].value;
    host_position_(row) = unknowns.node[row].position;
  }
  const int stride = dense_stride(unknowns.count);
  for (int row = 0; row < unknowns.count; ++row)
    std::copy_n(&dense_[row * unknowns.count], unknowns.count, &host_inverse_(row * stride));
  Kokkos::deep_copy(last_value_, host_value_);
  Kokkos::deep_copy(last_position_, host_position_);
  Kokkos::deep_copy(inverse_, host_inverse_);
  return true;
}

void GridLevels::cycle() const { dim_ == 2 ? cycle_in<2>(stack_, small_) : cycle_in<3>(stack_, small_); }

}  // namespace greenwater
