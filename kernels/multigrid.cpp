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
  return larger(v, -v);
}

/// How much a particle has of a node: 1 at it, 0 one cell away.
template <class V>
KOKKOS_INLINE_FUNCTION V hat(const V& distance) {
  return larger(V{}, 1.0f - absolute(distance));
}

template <class V>
KOKKOS_INLINE_FUNCTION V rounded_down(const V& v) {
  return convert_lanes<V>(convert_lanes<NodeIndex>(v));
}

// The particles' float matrix and their places. Rounded to float a place may come to lie on the next cell's corner; it is
// kept in its cell, so that the cell of a particle and that of its place are one.
template <int Dim>
void seat_particles(const PressureSystem& system, const FloatSystem& to, const FloatField (&place)[3]) {
  const auto x = Read<CoordField>(system.fluid().particles.position);
  const auto fixed = Read<FlagField>(system.fixed());
  const auto diagonal = Read<ScalarField>(system.diagonal());
  const GridShape grid = system.fluid().grid.shape();
  const real K = system.factor();
  const int count = system.count();
  const auto put = to;
  const FloatField place0 = place[0], place1 = place[1], place2 = place[2];
  Kokkos::parallel_for(
      "greenwater::seat_particles", Range(0, padded(count)), KOKKOS_LAMBDA(const int i) {
        const bool free = i < count && !fixed(i);
        put.diagonal(i) = free ? static_cast<float>(diagonal(i) / K) : 0.0f;
        put.inverse(i) = free ? static_cast<float>(K / diagonal(i)) : 0.0f;
        for (int d = 0; d < Dim; ++d) {
          const FloatField& to_place = d == 0 ? place0 : d == 1 ? place1 : place2;
          to_place(i) = far_away;
          if (!free) continue;
          const int cell = grid.along(d, x(i, d));
          const float at = static_cast<float>((x(i, d) - grid.origin[d]) / grid.cell);
          const float edge = static_cast<float>(cell + 1) * (1 - 1.2e-7f);
          to_place(i) = larger(smaller(at, edge), static_cast<float>(cell));
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

// Stencils of the first level: P^T (A P) / K. Each node gathers from the particles of the cells around it.
template <int Dim>
void collect_stencils(const Seats& seats, const Level& level, int layer, const FloatField& window) {
  constexpr int size = stencil_size(Dim);
  Kokkos::parallel_for(
      "greenwater::grid_collect_stencils", Range(0, level.active * node_lanes), KOKKOS_LAMBDA(const int number) {
        const Item pack(level, number / node_lanes * items_of_pack, size);
        const int lane = number % node_lanes, i = pack.i + lane;
        float* stencil = level.stencil + pack.stencil + lane;
        if (layer == 0)
          for (int e = 0; e < size; ++e) stencil[e * node_lanes] = 0;
        const GridShape& grid = seats.grid;
        for (int cz = 0; cz < (Dim == 3 ? 2 : 1); ++cz)
          for (int cy = 0; cy < 2; ++cy)
            for (int cx = 0; cx < 2; ++cx) {
              const int ci = i - 1 + cx, cj = pack.j - 1 + cy, ck = Dim == 3 ? pack.k - 1 + cz : 0;
              if (ci < 0 || ci >= grid.cells[0] || cj < 0 || cj >= grid.cells[1] || ck < 0 || ck >= grid.cells[2])
                continue;
              const int cell = (ck * grid.cells[1] + cj) * grid.cells[0] + ci;
              Window sum{};
              for (int p = seats.first(cell); p < seats.first(cell + 1); ++p) {
                float share = hat(seats.place[0](p) - static_cast<float>(i)) *
                              hat(seats.place[1](p) - static_cast<float>(pack.j));
                if constexpr (Dim == 3) share *= hat(seats.place[2](p) - static_cast<float>(pack.k));
                if (share > 0) sum.add(share, &window(p * window_nodes));
              }
              float part[window_nodes];
              sum.store(part);
              float* plane = stencil + (cz + layer) * (Dim == 3 ? across * across * node_lanes : 0);
              for (int m = 0; m < wide; ++m)
                for (int n = 0; n < wide; ++n) plane[((cy + m) * across + cx + n) * node_lanes] += part[m * wide + n];
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

// b = P^T t on the first level, and x = relax b.
template <int Dim>
void restrict_particles(const Seats& seats, const Level& level, const FloatField& t) {
  Kokkos::parallel_for(
      "greenwater::grid_restrict_particles", Range(0, level.active * node_lanes), KOKKOS_LAMBDA(const int number) {
        const Item pack(level, number / node_lanes * items_of_pack, stencil_size(Dim));
        const int lane = number % node_lanes, i = pack.i + lane;
        const GridShape& grid = seats.grid;
        const int low = larger(i - 1, 0), high = smaller(i + 1, grid.cells[0]);
        FloatPack sum{};
        if (i < level.nodes[0])
          for (int ck = larger(pack.k - 1, 0); ck <= smaller(pack.k, grid.cells[2] - 1); ++ck)
            for (int cj = larger(pack.j - 1, 0); cj <= smaller(pack.j, grid.cells[1] - 1); ++cj) {
              const int cells = (ck * grid.cells[1] + cj) * grid.cells[0];
              const int end = seats.first(cells + high);
              for (int p = seats.first(cells + low); p < end; p += float_lanes) {
                FloatPack share = hat(load_lanes<FloatPack>(&seats.place[0](p)) - static_cast<float>(i)) *
                                  hat(load_lanes<FloatPack>(&seats.place[1](p)) - static_cast<float>(pack.j));
                if constexpr (Dim == 3)
                  share *= hat(load_lanes<FloatPack>(&seats.place[2](p)) - static_cast<float>(pack.k));
                const NodeIndex left = end - p - counted_lanes<NodeIndex>();
                sum += zero_unless(left > 0, share * load_lanes<FloatPack>(&t(p)));
              }
            }
        float b = 0;
        for (int l = 0; l < float_lanes; ++l) b += greenwater::lane(sum, l);
        level.b[pack.value + lane] = b;
        level.x[pack.position + lane] = level.relax[pack.value + lane] * b;
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

// to = z + (r - A z) / diagonal; returns r . to.
accum last_sweep(const FloatSystem& system, const FloatField& r, const FloatField& z, const FloatField& to) {
  const auto rows = system.rows;
  const auto inverse = Read<FloatField>(system.inverse);
  accum rz = 0;
  Kokkos::parallel_reduce(
      "greenwater::last_sweep", row_packs(system.count),
      KOKKOS_LAMBDA(const int pack, accum& sum) {
        const int i = pack * float_lanes;
        const FloatPack residual = load_lanes<FloatPack>(&r(i));
        const FloatPack swept =
            load_lanes<FloatPack>(&inverse(i)) * (residual + row_product<FloatPack>(rows, z.data(), i));
        store_lanes(&to(i), swept);
        sum += sum_lanes(residual * swept);
      },
      rz);
  return rz;
}

void first_sweep(const FloatSystem& system, const FloatField& r, const FloatField& z) {
  const auto inverse = Read<FloatField>(system.inverse);
  Kokkos::parallel_for(
      "greenwater::first_sweep", Range(0, system.count), KOKKOS_LAMBDA(const int i) { z(i) = inverse(i) * r(i); });
}

void grow(FloatField& field, const std::string& label, std::int64_t size) {
  if (static_cast<std::int64_t>(field.extent(0)) < size) field = FloatField(label, size + size / 4);
}

template <int Dim>
void make_first_level(const Seats& seats, const FloatSystem& system, const GridLevels& levels,
                      const FloatField& window) {
  for (int layer = 0; layer < (Dim == 3 ? wide : 1); ++layer) {
    row_windows<Dim>(seats, system, layer, window);
    collect_stencils<Dim>(seats, levels.first(), layer, window);
  }
}

template <int Dim>
void correct_from_grid(const Seats& seats, const FloatSystem& system, const GridLevels& levels, const FloatField& t,
                       const SplitNodes& splits, const FloatField& z) {
  restrict_particles<Dim>(seats, levels.first(), t);
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
  system_.rows = fluid.rows.near;
  grid_ = fluid.grid.shape();
  first_ = fluid.grid.first();
  grow_fields(dim);
  levels_.resize(grid_, dim);
  const Seats seats = {system_.count, grid_, first_, {place_[0], place_[1], place_[2]}};
  dim == 2 ? seat_particles<2>(system, system_, place_) : seat_particles<3>(system, system_, place_);
  find_packs(seats, levels_.first(), levels_.wanted());
  levels_.activate();
  dim == 2 ? make_first_level<2>(seats, system_, levels_, window_)
           : make_first_level<3>(seats, system_, levels_, window_);
  levels_.coarsen();
  splits_.update(fluid, seats, system_, levels_);
}

void Multigrid::grow_fields(int dim) {
  // Packs of particles are read from any particle on, hence the room for one more.
  const std::int64_t room = padded(system_.count) + float_lanes;
  grow(system_.diagonal, "greenwater::multigrid_diagonal", room);
  grow(system_.inverse, "greenwater::multigrid_inverse", room);
  grow(window_, "greenwater::multigrid_window", room * window_nodes);
  grow(first_sweep_, "greenwater::multigrid_sweep", room);
  for (int d = 0; d < dim; ++d) grow(place_[d], "greenwater::multigrid_place", room);
}

accum Multigrid::finish(const FloatField& r, const FloatField& first, const FloatField& z) {
  const Seats seats = {system_.count, grid_, first_, {place_[0], place_[1], place_[2]}};
  first_residual(system_, first, z);
  levels_.dim() == 2 ? correct_from_grid<2>(seats, system_, levels_, z, splits_, first)
                     : correct_from_grid<3>(seats, system_, levels_, z, splits_, first);
  return last_sweep(system_, r, first, z);
}

void Multigrid::apply(const FloatField& r, const FloatField& z) {
  first_sweep(system_, r, first_sweep_);
  finish(r, first_sweep_, z);
}

}  // namespace greenwater
