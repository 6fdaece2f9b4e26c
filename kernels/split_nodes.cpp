#include "kernels/split_nodes.hpp"

#include <algorithm>

#include "core/check.hpp"
#include "kernels/split_rows.hpp"
#include "kernels/split_sides.hpp"

namespace greenwater {

namespace {

using Team = Kokkos::TeamPolicy<Space>;
using Member = Team::member_type;

template <class F>
KOKKOS_INLINE_FUNCTION void for_each(const Member& team, int begin, int end, const F& f) {
  Kokkos::parallel_for(Kokkos::TeamThreadRange(team, begin, end), f);
  team.team_barrier();
}

/// Values at the nodes of the last level and of its splits from their right sides.
KOKKOS_INLINE_FUNCTION void solve_last(const Member& team, const LevelStack& stack, const SplitStack& splits) {
  const Level& last = stack.level[stack.count - 1];
  const Splits& s = splits.level[stack.count - 1];
  const int nodes = stack.unknowns, count = nodes + splits.last_count;
  for_each(team, 1, s.count + 1, [&](const int number) { s.e[number] = 0; });
  for_each(team, 0, (count + float_lanes - 1) / float_lanes, [&](const int pack) {
    const int row = pack * float_lanes;
    const auto solution = dense_product(splits.inverse, count, row, [&](const int c) {
      return c < nodes ? last.b[stack.value[c]] : s.b[splits.last[c - nodes]];
    });
    for (int l = 0; l < float_lanes && row + l < count; ++l) {
      if (row + l < nodes)
        last.y[stack.position[row + l]] = lane(solution, l);
      else
        s.e[splits.last[row + l - nodes]] = lane(solution, l);
    }
  });
}

// The matrix of the last level with all that may be splits, on the device.
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
  for_each(team, 1, to.count + 1, [&](const int m) { smooth_split(fine, to, m, value_of_split<Dim>(fine, to, m)); });
}

template <int Dim>
void launch_small_levels(const LevelStack& stack, const SplitStack& splits, int from) {
  Kokkos::parallel_for(
      "greenwater::split_small_levels", Team(1, Kokkos::AUTO), KOKKOS_LAMBDA(const Member& team) {
        const int last = stack.count - 1;
        for (int l = from; l < last; ++l)
          go_down<Dim>(team, stack.level[l], splits.level[l], stack.level[l + 1], splits.level[l + 1]);
        solve_last(team, stack, splits);
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

// Numbers of the splits that are in the last level's matrix. Those of which next to nothing is there are left out, as nodes
// are.
std::vector<int> present_in(const FloatField::host_mirror_type& matrix, int count, int nodes) {
  constexpr float hardly = 1e-4f;
  float most = 0;
  for (int i = 0; i < count; ++i) most = std::max(most, matrix(i * count + i));
  std::vector<int> present;
  for (int i = nodes; i < count; ++i)
    if (matrix(i * count + i) > hardly * most) present.push_back(i - nodes + 1);
  return present;
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
  for (int l = 0; l < levels_; ++l) set_numbers(stack_.level[l], false);
  levels_ = stack.count;
  Nodes nodes = nodes_;
  for (int l = 0; l < levels_; ++l) {
    const Level& level = stack.level[l];
    place(l, level, nodes, dim);
    if (l + 1 == levels_) break;
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
    levels_ = 0;
    nodes_.clear();
  }
  if (nodes.empty()) {
    nodes_.clear();
    return;
  }
  dim_ = levels.dim();
  grid_ = seats.grid;
  fields_.resize(most_levels);
  if (nodes != nodes_ || levels.stack().count != levels_) {
    nodes_ = nodes;
    arrange(levels);
  }
  grow(side_, "greenwater::split_side", system.count);
  const Sides sides = {seats, system.rows, system.diagonal, side_};
  dim_ == 2 ? make_rows<2>(sides, levels.stack(), stack_) : make_rows<3>(sides, levels.stack(), stack_);
  invert_last(levels.stack());
}

void SplitNodes::invert_last(const LevelStack& stack) {
  const int nodes = stack.unknowns, all = nodes + stack_.level[stack.count - 1].count;
  const int room = all * dense_stride(all);
  if (static_cast<int>(inverse_.extent(0)) < room) {
    grow(inverse_, "greenwater::split_inverse", room);
    host_inverse_ = Kokkos::create_mirror_view(inverse_);
    stack_.inverse = inverse_.data();
  }
  dim_ == 2 ? fill_last<2>(stack, stack_, inverse_) : fill_last<3>(stack, stack_, inverse_);
  Kokkos::deep_copy(host_inverse_, inverse_);
  const std::vector<int> present = present_in(host_inverse_, all, nodes);
  const int count = nodes + static_cast<int>(present.size());
  const auto place = [&](int k) { return k < nodes ? k : nodes + present[k - nodes] - 1; };
  dense_.resize(static_cast<std::size_t>(count) * count);
  for (int row = 0; row < count; ++row)
    for (int column = 0; column < count; ++column)
      dense_[row * count + column] = host_inverse_(place(row) * all + place(column));
  dense_inverse_.invert(dense_.data(), count);
  for (int row = 0; row < count; ++row)
    std::copy_n(&dense_[row * count], count, &host_inverse_(row * dense_stride(count)));
  Kokkos::deep_copy(inverse_, host_inverse_);
  upload(last_, "greenwater::split_last", present);
  stack_.last = last_.data();
  stack_.last_count = static_cast<int>(present.size());
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
