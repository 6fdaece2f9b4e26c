#include "kernels/point_sampler.hpp"

#include "kernels/sight.hpp"

namespace greenwater {
namespace {

// Directions: first those off the walls that a point is on, then the others, at right angles to them.
template <int Dim>
struct Frame {
  Vec<Dim, coord> axis[Dim];
  coord push[Dim];  // what drives the fluid off the wall there beside gravity: -a_w . n
  int walls = 0;

  KOKKOS_INLINE_FUNCTION void add(const Vec<Dim, coord>& n, coord push_of_wall) {
    for (int k = 0; k < walls; ++k)
      if (fabs(dot(axis[k], n)) > coord(1e-3)) return;  // the same wall again, or one that is not at right angles
    if (walls == Dim) return;
    axis[walls] = n;
    push[walls++] = push_of_wall;
  }

  KOKKOS_INLINE_FUNCTION void complete() {
    for (int k = walls; k < Dim; ++k) {
      coord best = 0;
      for (int e = 0; e < Dim; ++e) {  // of the axes of space, what is most at right angles to those before
        Vec<Dim, coord> a{};
        a[e] = 1;
        for (int l = 0; l < k; ++l) a = along(a, -dot(a, axis[l]), axis[l]);
        const coord length2 = dot(a, a);
        if (length2 <= best * coord(1.0001)) continue;
        best = length2;
        axis[k] = along(Vec<Dim, coord>{}, 1 / sqrt(length2), a);
      }
    }
  }
};

template <int Dim>
KOKKOS_INLINE_FUNCTION Frame<Dim> frame_at(const Sight<Dim>& sight, const Vec<Dim, coord>& q, coord near) {
  Frame<Dim> frame;
  for (int k = sight.begin; k < sight.end; ++k) {
    if (sight.reach[k] >= sight.panels) break;
    const Panel& w = sight.panel[sight.reach[k]];
    const coord side = sight.side(w, q);
    const auto n = sight.as_vec(w.normal), foot = along(q, -side, n);
    if (fabs(side) > near || !sight.on_panel(w, foot)) continue;
    frame.add(n, w.moves ? -dot(w.acceleration.at(difference(foot, sight.as_vec(w.point))), n) : coord(0));
  }
  frame.complete();
  return frame;
}

// A weighted fit of a constant and slopes along some directions.
template <int Most>
struct Fit {
  accum matrix[Most][Most] = {}, right[Most] = {};

  KOKKOS_INLINE_FUNCTION void add(const accum (&basis)[Most], int size, accum weight, accum value) {
    for (int a = 0; a < size; ++a) {
      for (int b = 0; b < size; ++b) matrix[a][b] += weight * basis[a] * basis[b];
      right[a] += weight * basis[a] * value;
    }
  }

  /// The constant; the mean where particles do not tell the slopes.
  KOKKOS_INLINE_FUNCTION accum constant(int size) {
    const accum mean_value = right[0] / matrix[0][0], least = accum(0.02) * matrix[0][0];
    for (int k = size - 1; k > 0; --k) {  // eliminates slopes, the last one first
      if (!(matrix[k][k] > least)) return mean_value;
      for (int a = 0; a < k; ++a) {
        const accum part = matrix[a][k] / matrix[k][k];
        for (int b = 0; b < k; ++b) matrix[a][b] -= part * matrix[k][b];
        right[a] -= part * right[k];
      }
    }
    return matrix[0][0] > least ? right[0] / matrix[0][0] : mean_value;
  }
};

template <int Dim>
void sample_in(const Fluid& fluid, Reading reading, const CoordField& point, const ScalarField& value, int count) {
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto first = Read<IndexField>(fluid.grid.first());
  const auto grid = fluid.grid.shape();
  const auto walls = fluid.walls;
  const auto w = fluid.gradient.weight;
  const auto drive = drive_of<Dim>(fluid);
  const bool fits = reading == Reading::neumann;
  const coord near = fluid.spacing / 20, rho = fluid.rho, per_l0 = 1 / fluid.spacing;
  Kokkos::parallel_for(
      "greenwater::sample_pressure", Range(0, count), KOKKOS_LAMBDA(const int i) {
        const auto q = load<Dim>(point, i);
        const auto sight = sight_from(walls, grid, q);
        const auto frame = frame_at(sight, q, near);
        const int size = fits ? 1 + Dim - frame.walls : 1;
        Fit<Dim + 1> fit;
        for_each_candidate<Dim>(grid, first, q, [&](const int j) {
          const auto r = way_between(grid, q, load<Dim>(x, j));
          const real weight = w(static_cast<real>(sqrt(dot(r, r))));
          if (!(weight > 0) || !sight.sees(q, along(q, coord(1), r))) return;
          accum at_wall = p(j), basis[Dim + 1] = {1};
          for (int k = 0; fits && k < Dim; ++k) {
            const coord off = dot(r, frame.axis[k]);
            if (k < frame.walls)
              at_wall -= rho * (drive.along(frame.axis[k], j) + frame.push[k]) * off;
            else
              basis[1 + k - frame.walls] = off * per_l0;
          }
          fit.add(basis, size, weight, at_wall);
        });
        value(i) = fit.matrix[0][0] > 0 ? static_cast<real>(fit.constant(size)) : real(0);
      });
}

}  // namespace

std::vector<double> PointSampler::pressure(const Fluid& fluid, const std::vector<std::array<coord, 3>>& points,
                                           Reading reading) {
  const int count = static_cast<int>(points.size()), dim = fluid.particles.dim;
  if (static_cast<int>(point_.extent(0)) < count) {
    point_ = CoordField("greenwater::sample_point", count, dim);
    value_ = ScalarField("greenwater::sample_value", count);
    point_host_ = Kokkos::create_mirror(point_);
    value_host_ = Kokkos::create_mirror(value_);
  }
  for (int i = 0; i < count; ++i)
    for (int d = 0; d < dim; ++d) point_host_(i, d) = points[i][d];
  Kokkos::deep_copy(point_, point_host_);
  dim == 2 ? sample_in<2>(fluid, reading, point_, value_, count) : sample_in<3>(fluid, reading, point_, value_, count);
  Kokkos::deep_copy(value_host_, value_);
  std::vector<double> values(count);
  for (int i = 0; i < count; ++i) values[i] = value_host_(i);
  return values;
}

}  // namespace greenwater
