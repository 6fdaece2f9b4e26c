#include "kernels/multigrid.hpp"

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr int wide =
    4;  // nodes along each axis that a row of A P can reach: those of its cell and one more to each side
constexpr int window_nodes = wide * wide;  // in x and y; in 3-D four such layers, one after the other

static_assert(window_nodes == node_lanes);  // so that a window is a vector on a host

/// Values at a window's nodes: a vector on a host, an array on a GPU.
struct Window {
  FloatPack part[items_of_pack];

  KOKKOS_INLINE_FUNCTION void add(float factor, const float* values) {
    for (int p = 0; p < items_of_pack; ++p) part[p] += factor * load_lanes<FloatPack>(values + p * float_lanes);
  }
  KOKKOS_INLINE_FUNCTION void store(float* values) const {
    for (int p = 0; p < items_of_pack; ++p) store_lanes(values + p * float_lanes, part[p]);
  }
};

template <class V>
KOKKOS_INLINE_FUNCTION V absolute(const V& v) {
  if constexpr (is_scalar<V>)
    return fabs(v);
  else
    return (V)((NodeIndex)v & 0x7fffffff);  // without the bit of the sign
}

/// How much a particle has of a node: 1 at it, 0 one cell away.
KOKKOS_INLINE_FUNCTION FloatPack hat(const FloatPack& distance) {
  return larger(FloatPack{}, 1.0f - absolute(distance));
}

template <class V>
KOKKOS_INLINE_FUNCTION V rounded_down(const V& v) {
  return convert_lanes<V>(convert_lanes<NodeIndex>(v));
}

// The particles' float matrix and their places. Rounded to float a place may come to lie on the next cell's corner; it is
// kept in its cell, so that the cell of a particle and that of its place are one.
template <int Dim>
void seat_particles(const PressureSystem& system, const FloatSystem& to, const FloatField (&place)[3]) {
  using Floats = Lanes<float, pack_lanes>;
  const auto x = Read<CoordField>(system.fluid().particles.position);
  const auto fixed = Read<FlagField>(system.fixed());
  const auto diagonal = Read<ScalarField>(system.diagonal());
  const GridShape grid = system.fluid().grid.shape();
  const float per_K = static_cast<float>(1 / system.factor());
  const int count = system.count();
  const auto put = to;
  const Vec<3, FloatField> seat = {{place[0], place[1], place[2]}};
  Kokkos::parallel_for(
      "greenwater::seat_particles", Range(0, padded(count) / pack_lanes), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        Floats free{};
        for (int l = 0; l < pack_lanes; ++l) set_lane(free, l, i + l < count && !fixed(i + l) ? 1.0f : 0.0f);
        const Floats own = per_K * convert_lanes<Floats>(load_pack(diagonal, i));
        store_lanes(&put.diagonal(i), zero_unless(free > 0.0f, own));
        store_lanes(&put.inverse(i), zero_unless(free > 0.0f, 1.0f / own));
        const auto at = load_pack<Dim>(x, i);
        for (int d = 0; d < Dim; ++d) {
          const auto exact = (at[d] - grid.origin[d]) / grid.cell;
          const IndexPack cell =
              smaller(larger(convert_lanes<IndexPack>(exact), IndexPack{}), all_lanes<IndexPack>(grid.cells[d] - 1));
          const Floats low = convert_lanes<Floats>(cell), below_next = (low + 1.0f) * (1 - 1.2e-7f);
          const Floats kept = larger(smaller(convert_lanes<Floats>(exact), below_next), low);
          store_lanes(&seat.c[d](i), select(free > 0.0f, kept, all_lanes<Floats>(far_away)));
        }
      });
}

// Which packs of nodes have a particle in the cells around them.
void find_packs(const Seats& seats, const Level& level, const IndexField& wanted) {
  Kokkos::parallel_for(
      "greenwater::grid_find_packs", Range(0, level.packs * level.nodes[1] * level.nodes[2]),
      KOKKOS_LAMBDA(const int pack) {
        const int i = pack % level.packs * node_lanes, line = pack / level.packs;
        const int j = line % level.nodes[1], k = line / level.nodes[1];
        const GridShape& grid = seats.grid;
        const int low = larger(i - 1, 0), high = smaller(i + node_lanes, grid.cells[0]);
        int found = 0;
        for (int cz = larger(k - 1, 0); cz <= smaller(k, grid.cells[2] - 1); ++cz)
          for (int cy = larger(j - 1, 0); cy <= smaller(j, grid.cells[1] - 1); ++cy) {
            const int cells = (cz * grid.cells[1] + cy) * grid.cells[0];
            for (int p = seats.first(cells + low); p < seats.first(cells + high) && !found; ++p)
              found = seats.place[0](p) < far_away;
          }
        wanted(pack) = found;
      });
}

template <int Dim>
KOKKOS_INLINE_FUNCTION void hats_of(const Vec<Dim, FloatPack>& from_corner, FloatPack (&x)[wide],
                                    FloatPack (&y)[wide]) {
  for (int m = 0; m < wide; ++m) {
    x[m] = hat(from_corner[0] - static_cast<float>(m));
    y[m] = hat(from_corner[1] - static_cast<float>(m));
  }
}

// Adds factor times the share that particles at `from_corner` of their windows have of each node of a layer.
template <int Dim>
KOKKOS_INLINE_FUNCTION void add_to_window(const Vec<Dim, FloatPack>& from_corner, int layer, FloatPack factor,
                                          FloatPack (&sum)[window_nodes]) {
  FloatPack x[wide], y[wide];
  hats_of<Dim>(from_corner, x, y);
  if constexpr (Dim == 3) factor = factor * hat(from_corner[2] - static_cast<float>(layer));
  for (int m = 0; m < wide; ++m) {
    const FloatPack line = factor * y[m];
    for (int n = 0; n < wide; ++n) sum[m * wide + n] += line * x[n];
  }
}

// Rows of A P / K: sum_j A_ij P_j / K at the 4 x 4 nodes around the particle's cell, in 3-D those of one layer.
template <int Dim>
void row_windows(const Seats& seats, const FloatSystem& system, int layer, const FloatField& window) {
  const auto rows = system.rows;
  const auto diagonal = Read<FloatField>(system.diagonal);
  Kokkos::parallel_for(
      "greenwater::grid_row_windows", row_packs(seats.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * float_lanes;
        Vec<Dim, FloatPack> corner, own;
        for (int d = 0; d < Dim; ++d) {
          const FloatPack at = load_lanes<FloatPack>(&seats.place[d](i));
          corner[d] = rounded_down(at) - 1.0f;
          own[d] = at - corner[d];
        }
        FloatPack sum[window_nodes] = {};
        add_to_window<Dim>(own, layer, load_lanes<FloatPack>(&diagonal(i)), sum);
        const auto begin = rows.place(i, 0);
        const int* index = rows.index.data() + begin;
        const float* weight = rows.weight.data() + begin;
        for (int e = 0; e < rows.length(i / row_lanes); ++e, index += row_lanes, weight += row_lanes) {
          const auto j = load_lanes<NodeIndex>(index);
          Vec<Dim, FloatPack> from;
          for (int d = 0; d < Dim; ++d) from[d] = gather_lanes<FloatPack>(seats.place[d].data(), j) - corner[d];
          add_to_window<Dim>(from, layer, -load_lanes<FloatPack>(weight), sum);
        }
        float block[window_nodes * float_lanes];
        for (int m = 0; m < window_nodes; ++m) store_lanes(block + m * float_lanes, sum[m]);
        const NodeIndex column = counted_lanes<NodeIndex>() * float_lanes;
        for (int l = 0; l < float_lanes; ++l)
          for (int m = 0; m < window_nodes; m += float_lanes)
            store_lanes(&window((i + l) * window_nodes + m),
                        gather_lanes<FloatPack>(block + l + m * float_lanes, column));
      });
}

// What each cell's particles have of P^T (A P) / K: for each of its corners, their windows weighted with their shares of it.
// A cell has the number of its lowest corner.
template <int Dim>
void collect_cells(const Seats& seats, const Level& level, const FloatField& window, const FloatField& cells) {
  constexpr int corners = 1 << Dim;
  Kokkos::parallel_for(
      "greenwater::grid_collect_cells", Range(0, level.active * node_lanes), KOKKOS_LAMBDA(const int number) {
        const Item pack(level, number / node_lanes * items_of_pack, stencil_size(Dim));
        const int lane = number % node_lanes, node[3] = {pack.i + lane, pack.j, pack.k};
        const GridShape& grid = seats.grid;
        Window sum[corners] = {};
        int begin = 0, end = 0;
        if (node[0] < grid.cells[0] && node[1] < grid.cells[1] && node[2] < grid.cells[2]) {
          const int cell = (node[2] * grid.cells[1] + node[1]) * grid.cells[0] + node[0];
          begin = seats.first(cell);
          end = seats.first(cell + 1);
        }
        for (int p = begin; p < end; ++p) {
          if (seats.place[0](p) == far_away) continue;
          float share[3][2];
          for (int d = 0; d < Dim; ++d) {
            share[d][1] = seats.place[d](p) - static_cast<float>(node[d]);
            share[d][0] = 1 - share[d][1];
          }
          for (int c = 0; c < corners; ++c)
            sum[c].add(share[0][c & 1] * share[1][c / 2 & 1] * (Dim == 3 ? share[2][c / 4] : 1.0f),
                       &window(p * window_nodes));
        }
        for (int c = 0; c < corners; ++c) sum[c].store(&cells(((pack.value + lane) * corners + c) * window_nodes));
      });
}

// Places in fields (slot, lane) of the cells i, i + 1 ... of line (j, k); those that are not there have slot 0.
KOKKOS_INLINE_FUNCTION NodeIndex cells_along(const Level& level, int i, int j, int k) {
  NodeIndex place{};
  if (j < 0 || k < 0) return place;
  const int* slot = level.slot + (k * level.nodes[1] + j) * level.packs;
  for (int l = 0; l < float_lanes; ++l)
    if (i + l >= 0) set_lane(place, l, slot[(i + l) / node_lanes] * node_lanes + (i + l) % node_lanes);
  return place;
}

// Stencils of the first level: each node takes its part of the cells around it.
template <int Dim>
void collect_stencils(const Level& level, int layer, const FloatField& cells) {
  constexpr int size = stencil_size(Dim), plane = across * across;
  const float* parts = cells.data();
  Kokkos::parallel_for(
      "greenwater::grid_collect_stencils", Range(0, items(level)), KOKKOS_LAMBDA(const int number) {
        const Item at(level, number, size);
        // The window of a cell begins one node before the cell.
        for (int cz = 0; cz < (Dim == 3 ? 2 : 1); ++cz) {
          FloatPack sum[plane] = {};
          for (int cy = 0; cy < 2; ++cy)
            for (int cx = 0; cx < 2; ++cx) {
              const NodeIndex cell = cells_along(level, at.i - 1 + cx, at.j - 1 + cy, Dim == 3 ? at.k - 1 + cz : 0);
              const NodeIndex place = cell * (window_nodes << Dim);
              const int corner = (1 - cx) + 2 * (1 - cy) + (Dim == 3 ? 4 * (1 - cz) : 0);
              const float* part = parts + corner * window_nodes;
              for (int m = 0; m < wide; ++m)
                for (int n = 0; n < wide; ++n, ++part)
                  sum[(cy + m) * across + cx + n] += gather_lanes<FloatPack>(part, place);
            }
          float* to = level.stencil + at.stencil + (Dim == 3 ? (cz + layer) * plane * node_lanes : 0);
          const bool first = layer == 0 || cz == 1;  // layer after layer of windows comes to a plane of stencils twice
          for (int e = 0; e < plane; ++e, to += node_lanes)
            store_lanes(to, first ? sum[e] : sum[e] + load_lanes<FloatPack>(to));
        }
      });
}

// t = r - A z for z = r / diagonal: only what the neighbours say is left.
void first_residual(const FloatSystem& system, const FloatField& z, const FloatField& t) {
  const auto rows = system.rows;
  const auto inverse = Read<FloatField>(system.inverse);
  Kokkos::parallel_for(
      "greenwater::first_residual", row_packs(system.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * float_lanes;
        const FloatPack free = load_lanes<FloatPack>(&inverse(i));
        store_lanes(&t(i), zero_unless(free != 0.0f, row_product<FloatPack>(rows, z.data(), i)));
      });
}

// What each cell's particles have of P^T t, corner by corner: (slot, corner, lane).
template <int Dim>
void restrict_cells(const Seats& seats, const Level& level, const FloatField& t, const FloatField& parts) {
  constexpr int corners = 1 << Dim;
  const float* values = t.data();
  Kokkos::parallel_for(
      "greenwater::grid_restrict_cells", Range(0, items(level)), KOKKOS_LAMBDA(const int number) {
        const Item at(level, number, stencil_size(Dim));
        const GridShape& grid = seats.grid;
        NodeIndex begin{}, there{};
        int most = 0;
        if (at.j < grid.cells[1] && at.k < grid.cells[2]) {
          const int cell = (at.k * grid.cells[1] + at.j) * grid.cells[0] + at.i;
          for (int l = 0; l < smaller(float_lanes, grid.cells[0] - at.i); ++l) {
            const int first = seats.first(cell + l), particles = seats.first(cell + l + 1) - first;
            set_lane(begin, l, first);
            set_lane(there, l, particles);
            most = larger(most, particles);
          }
        }
        const FloatPack corner[3] = {convert_lanes<FloatPack>(at.i + counted_lanes<NodeIndex>()),
                                     all_lanes<FloatPack>(at.j), all_lanes<FloatPack>(at.k)};
        FloatPack sum[corners] = {};
        for (int e = 0; e < most; ++e) {
          const NodeIndex p = zero_unless(there > e, begin + e);
          FloatPack part[corners] = {zero_unless(there > e, gather_lanes<FloatPack>(values, p))};
          for (int d = 0; d < Dim; ++d) {
            const FloatPack share = gather_lanes<FloatPack>(seats.place[d].data(), p) - corner[d];
            for (int c = 0; c < 1 << d; ++c) {
              part[c + (1 << d)] = part[c] * share;
              part[c] *= 1.0f - share;
            }
          }
          for (int c = 0; c < corners; ++c) sum[c] += part[c];
        }
        const int slot = at.value / node_lanes, lane = at.value % node_lanes;
        for (int c = 0; c < corners; ++c) store_lanes(&parts((slot * corners + c) * node_lanes + lane), sum[c]);
      });
}

// b = P^T t on the first level, from its cells, and x = relax b.
template <int Dim>
void restrict_to_nodes(const Level& level, const FloatField& parts) {
  constexpr int corners = 1 << Dim;
  const float* part = parts.data();
  Kokkos::parallel_for(
      "greenwater::grid_restrict_to_nodes", Range(0, items(level)), KOKKOS_LAMBDA(const int number) {
        const Item at(level, number, stencil_size(Dim));
        FloatPack b{};
        for (int cz = 0; cz < (Dim == 3 ? 2 : 1); ++cz)
          for (int cy = 0; cy < 2; ++cy)
            for (int cx = 0; cx < 2; ++cx) {
              const NodeIndex cell = cells_along(level, at.i - 1 + cx, at.j - 1 + cy, Dim == 3 ? at.k - 1 + cz : 0);
              const int corner = (1 - cx) + 2 * (1 - cy) + (Dim == 3 ? 4 * (1 - cz) : 0);
              const NodeIndex lane = cell % node_lanes, place = (cell - lane) * corners + lane;
              b += gather_lanes<FloatPack>(part + corner * node_lanes, place);
            }
        const FloatPack relax = load_lanes<FloatPack>(level.relax + at.value);
        b = zero_unless(relax != 0.0f, b);
        store_lanes(level.b + at.value, b);
        store_lanes(level.x + at.position, relax * b);
      });
}

// z += P y
template <int Dim>
void prolong_to_particles(const Seats& seats, const FloatSystem& system, const Level& level, const FloatField& z) {
  const auto inverse = Read<FloatField>(system.inverse);
  Kokkos::parallel_for(
      "greenwater::grid_prolong_to_particles", row_packs(seats.count), KOKKOS_LAMBDA(const int pack) {
        const int p = pack * float_lanes;
        const auto free = load_lanes<FloatPack>(&inverse(p)) != 0.0f;
        FloatPack low[3] = {}, high[3] = {};
        NodeIndex position = NodeIndex{} + level.origin;
        for (int d = 0; d < Dim; ++d) {
          const FloatPack at = zero_unless(free, load_lanes<FloatPack>(&seats.place[d](p)));
          const NodeIndex node = convert_lanes<NodeIndex>(at);
          position += node * (d == 0 ? 1 : d == 1 ? level.row : level.layer);
          high[d] = at - convert_lanes<FloatPack>(node);
          low[d] = 1.0f - high[d];
        }
        const auto along_x = [&](const float* y) {
          return low[0] * gather_lanes<FloatPack>(y, position) + high[0] * gather_lanes<FloatPack>(y + 1, position);
        };
        const auto in_layer = [&](const float* y) { return low[1] * along_x(y) + high[1] * along_x(y + level.row); };
        FloatPack sum = in_layer(level.y);
        if constexpr (Dim == 3) sum = low[2] * sum + high[2] * in_layer(level.y + level.layer);
        store_lanes(&z(p), load_lanes<FloatPack>(&z(p)) + zero_unless(free, sum));
      });
}

// to = (z + (r - A z) / diagonal) / K, as the matrix here is that over K; returns r . to.
accum last_sweep(const FloatSystem& system, const FloatField& r, const FloatField& z, const ScalarField& to) {
  const auto rows = system.rows;
  const auto inverse = Read<FloatField>(system.inverse);
  const float per_K = system.per_K;
  accum rz = 0;
  Kokkos::parallel_reduce(
      "greenwater::last_sweep", row_packs(system.count),
      KOKKOS_LAMBDA(const int pack, accum& sum) {
        const int i = pack * float_lanes;
        const FloatPack residual = load_lanes<FloatPack>(&r(i));
        const FloatPack swept =
            per_K * load_lanes<FloatPack>(&inverse(i)) * (residual + row_product<FloatPack>(rows, z.data(), i));
        store_converted(&to(i), swept);
        sum += sum_lanes(residual * swept);
      },
      rz);
  return rz;
}

// r in float, 0 beyond the last particle, and z = r / diagonal.
void first_sweep(const FloatSystem& system, const ScalarField& exact, const FloatField& r, const FloatField& z) {
  using Floats = Lanes<float, pack_lanes>;
  const auto inverse = Read<FloatField>(system.inverse);
  const int count = system.count;
  Kokkos::parallel_for(
      "greenwater::first_sweep", Range(0, padded(count) / pack_lanes), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto rough = convert_lanes<Floats>(first_lanes(count - i, load_pack(exact, i)));
        store_lanes(&r(i), rough);
        store_lanes(&z(i), load_pack(inverse, i) * rough);
      });
}

void grow(FloatField& field, const std::string& label, std::int64_t size) {
  if (static_cast<std::int64_t>(field.extent(0)) < size) field = FloatField(label, size + size / 4);
}

template <int Dim>
void make_first_level(const Seats& seats, const FloatSystem& system, const Level& level, const FloatField& window,
                      const FloatField& cells) {
  for (int layer = 0; layer < (Dim == 3 ? wide : 1); ++layer) {
    row_windows<Dim>(seats, system, layer, window);
    collect_cells<Dim>(seats, level, window, cells);
    collect_stencils<Dim>(level, layer, cells);
  }
}

template <int Dim>
void correct_from_grid(const Seats& seats, const FloatSystem& system, const GridLevels& levels, const FloatField& t,
                       const FloatField& parts, const SplitNodes& splits, const FloatField& z) {
  restrict_cells<Dim>(seats, levels.first(), t, parts);
  restrict_to_nodes<Dim>(levels.first(), parts);
  splits.restrict_particles(seats, levels, t);
  splits.any() ? splits.cycle(levels) : levels.cycle();
  splits.prolong_to_particles(seats, levels, z);
  prolong_to_particles<Dim>(seats, system, levels.first(), z);
}

}  // namespace

void Multigrid::update(const PressureSystem& system) {
  const Fluid& fluid = system.fluid();
  expect(fluid.keep_weights);
  const int dim = fluid.particles.dim;
  system_.count = system.count();
  system_.per_K = static_cast<float>(1 / system.factor());
  system_.rows = fluid.rows.near;
  grid_ = fluid.grid.shape();
  first_ = fluid.grid.first();
  grow_fields(dim);
  levels_.resize(grid_, dim);
  const Seats seats = {system_.count, grid_, first_, {place_[0], place_[1], place_[2]}};
  dim == 2 ? seat_particles<2>(system, system_, place_) : seat_particles<3>(system, system_, place_);
  find_packs(seats, levels_.first(), levels_.wanted());
  levels_.activate();
  const Level& level = levels_.first();
  const std::int64_t values = static_cast<std::int64_t>(level.active + 1) * node_lanes;
  grow(cells_, "greenwater::multigrid_cells", values * (window_nodes << dim));
  grow(parts_, "greenwater::multigrid_parts", values << dim);
  dim == 2 ? make_first_level<2>(seats, system_, level, window_, cells_)
           : make_first_level<3>(seats, system_, level, window_, cells_);
  levels_.coarsen();
  splits_.update(fluid, seats, system_, levels_);
}

void Multigrid::grow_fields(int dim) {
  // Packs of particles are read from any particle on, hence the room for one more.
  const std::int64_t room = padded(system_.count) + float_lanes;
  grow(system_.diagonal, "greenwater::multigrid_diagonal", room);
  grow(system_.inverse, "greenwater::multigrid_inverse", room);
  grow(window_, "greenwater::multigrid_window", room * window_nodes);
  grow(r_, "greenwater::multigrid_residual", room);
  grow(z_, "greenwater::multigrid_sweep", room);
  grow(t_, "greenwater::multigrid_left", room);
  for (int d = 0; d < dim; ++d) grow(place_[d], "greenwater::multigrid_place", room);
}

accum Multigrid::apply(const ScalarField& r, const ScalarField& z) const {
  const Seats seats = {system_.count, grid_, first_, {place_[0], place_[1], place_[2]}};
  first_sweep(system_, r, r_, z_);
  first_residual(system_, z_, t_);
  levels_.dim() == 2 ? correct_from_grid<2>(seats, system_, levels_, t_, parts_, splits_, z_)
                     : correct_from_grid<3>(seats, system_, levels_, t_, parts_, splits_, z_);
  return last_sweep(system_, r_, z_, z);
}

}  // namespace greenwater
