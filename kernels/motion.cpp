#include "kernels/motion.hpp"

#include "core/region.hpp"

namespace greenwater {
namespace {

template <int Dim>
void clear_acceleration_in(const VectorField& a, int count) {
  Kokkos::parallel_for(
      "greenwater::clear_acceleration", Range(0, count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) a(i, d) = 0;
      });
}

// From when to when walls move while particles do, as seen from where the panels stand [s]; both 0: they do not.
struct Sweep {
  coord begin, end;
  KOKKOS_INLINE_FUNCTION bool with_walls() const { return begin != end; }
};

// Where the corners of a piece are at a time.
template <int Dim>
KOKKOS_INLINE_FUNCTION void corners_at(const Panel& w, const Piece& piece, coord time, Vec<Dim, coord>* corner) {
  for (int e = 0; e < Dim; ++e) {
    corner[e] = Sight<Dim>::as_vec(piece.corner[e]);
    corner[e] = along(corner[e], time, w.velocity.at(difference(corner[e], Sight<Dim>::as_vec(w.point))));
  }
}

// Distance of x from the panel as it stands after a time, with the sign of the side that x is on [m].
template <int Dim>
KOKKOS_INLINE_FUNCTION coord side_after(const Sight<Dim>& sight, const Panel& w, coord time, const Vec<Dim, coord>& x) {
  const coord side = sight.side(w, x);
  if (time == 0) return side;
  const auto n = sight.as_vec(w.normal);
  const auto foot = difference(along(x, -side, n), sight.as_vec(w.point));
  return side - time * dot(w.velocity.at(foot), n);
}

// Distance of x from the plane of a piece [m], with the sign of the side that x is on.
template <int Dim>
KOKKOS_INLINE_FUNCTION coord side_of_piece(const Vec<Dim, coord>* c, const Vec<Dim, coord>& x) {
  const auto a = difference(c[1], c[0]), r = difference(x, c[0]);
  if constexpr (Dim == 2) {
    return (a[0] * r[1] - a[1] * r[0]) / sqrt(dot(a, a));
  } else {
    const auto b = difference(c[2], c[0]);
    const Vec<3, coord> n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return dot(n, r) / sqrt(dot(n, n));
  }
}

// Is q, a point in the plane of the corners, between them? A millionth of the piece's size is let pass.
template <int Dim>
KOKKOS_INLINE_FUNCTION bool between(const Vec<Dim, coord>* c, const Vec<Dim, coord>& q) {
  constexpr coord slack = -1e-6;
  const auto a = difference(c[1], c[0]), r = difference(q, c[0]);
  const coord aa = dot(a, a), ar = dot(a, r);
  if constexpr (Dim == 2) {
    return ar >= slack * aa && ar <= (1 - slack) * aa;
  } else {
    const auto b = difference(c[2], c[0]);
    const coord ab = dot(a, b), bb = dot(b, b), br = dot(b, r), det = aa * bb - ab * ab;
    const coord s = (bb * ar - ab * br) / det, t = (aa * br - ab * ar) / det;
    return s >= slack && t >= slack && s + t <= 1 - slack;
  }
}

// Does a particle on its way from x to x + dx meet a panel on its own way? `side` is then the side of the panel, as it
// stands at the end, on which the particle has to end to keep its distance [m].
template <int Dim>
KOKKOS_INLINE_FUNCTION bool meets_moving(const Sight<Dim>& sight, const Panel& w, const Sweep& sweep,
                                         const Vec<Dim, coord>& x, const Vec<Dim, coord>& dx, coord& side) {
  const auto end = along(x, coord(1), dx);
  for (int k = w.first_piece; k < w.last_piece; ++k) {
    Vec<Dim, coord> before[3], then[3];
    corners_at(w, sight.piece[k], sweep.begin, before);
    corners_at(w, sight.piece[k], sweep.end, then);
    const coord from = side_of_piece(before, x), to = side_of_piece(then, end);
    if (from * to > 0 || from == to) continue;
    const coord s = from / (from - to);
    for (int e = 0; e < Dim; ++e) then[e] = along(before[e], s, difference(then[e], before[e]));
    if (!between(then, along(x, s, dx))) continue;
    side = to * side_after(sight, w, sweep.end, end) < 0 ? -from : from;  // the piece may be turned against its panel
    return true;
  }
  return false;
}

// A way from x to x + dx that crosses a wall is bent: along the wall it goes on, towards the wall it ends where it began
// as seen from the wall, and the speed towards the wall becomes the wall's own. Returns whether it was.
template <int Dim>
KOKKOS_INLINE_FUNCTION bool stop_at_walls(const MirrorWalls& walls, const GridShape& grid, const Sweep& sweep,
                                          const Vec<Dim, coord>& x, Vec<Dim, coord>& dx, Vec<Dim>& u) {
  const auto sight = sight_from(walls, grid, x, dot(dx, dx) > grid.cell * grid.cell);
  bool stopped = false;
  Vec<Dim, coord> carried{};
  for (int k = sight.begin; k < sight.end; ++k) {
    if (sight.reach[k] >= sight.panels) break;
    const Panel& w = sight.panel[sight.reach[k]];
    coord side = sight.side(w, x);
    const bool moving = sweep.with_walls() && w.moves;
    if (!(moving ? meets_moving(sight, w, sweep, x, dx, side) : sight.meets(w, x, along(x, coord(1), dx)))) continue;
    const auto n = sight.as_vec(w.normal);
    const auto u_w = w.velocity.at(difference(x, sight.as_vec(w.point)));
    coord speed = 0;
    for (int d = 0; d < Dim; ++d) speed += (u[d] - u_w[d]) * n[d];
    for (int d = 0; d < Dim; ++d) u[d] -= static_cast<real>(speed * n[d]);
    const coord end = moving ? sweep.end : 0;
    dx = along(dx, side - side_after(sight, w, end, along(x, coord(1), dx)), n);
    if (moving) carried = along(Vec<Dim, coord>{}, side - side_after(sight, w, end, x), n);
    stopped = true;
  }
  // Past the end of one wall and into another: stay, or go with the wall.
  if (stopped && !sight.sees(x, along(x, coord(1), dx))) dx = carried;
  return stopped;
}

// Moves particle i by dx, or as far as the walls let it. Returns 1 when they stopped it.
template <int Dim>
KOKKOS_INLINE_FUNCTION int move(const MirrorWalls& walls, const GridShape& grid, const Sweep& sweep,
                                const CoordField& x, const VectorField& u, int i, Vec<Dim, coord> dx, Vec<Dim> ui) {
  const auto xi = load<Dim>(x, i);
  const int stopped = stop_at_walls(walls, grid, sweep, xi, dx, ui) ? 1 : 0;
  store(u, i, ui);
  store(x, i, along(xi, coord(1), dx));
  return stopped;
}

template <int Dim>
int predict_in(Fluid& fluid, real dt) {
  const auto grid = fluid.grid.shape();
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  const auto a = Read<VectorField>(fluid.particles.acceleration);
  const auto walls = fluid.walls;
  const real g[3] = {fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]};
  const Sweep sweep{-coord(dt), 0};
  int stops = 0;
  Kokkos::parallel_reduce(
      "greenwater::predict", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, int& sum) {
        auto ui = load<Dim>(u, i);
        Vec<Dim, coord> dx;
        for (int d = 0; d < Dim; ++d) {
          ui[d] += dt * (g[d] + a(i, d));
          dx[d] = dt * ui[d];
        }
        sum += move(walls, grid, sweep, x, u, i, dx, ui);
      },
      stops);
  return stops;
}

template <int Dim>
int correct_in(Fluid& fluid, real dt) {
  const auto grid = fluid.grid.shape();
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  const auto a = Read<VectorField>(fluid.particles.acceleration);
  const auto walls = fluid.walls;
  const Sweep sweep{0, 0};
  int stops = 0;
  Kokkos::parallel_reduce(
      "greenwater::correct", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, int& sum) {
        auto ui = load<Dim>(u, i);
        Vec<Dim, coord> dx;
        for (int d = 0; d < Dim; ++d) {
          ui[d] += dt * a(i, d);
          dx[d] = coord(dt) * dt * a(i, d);
        }
        sum += move(walls, grid, sweep, x, u, i, dx, ui);
      },
      stops);
  return stops;
}

template <int Dim>
void kick_in(const VectorField& u, const Read<VectorField>& a, real dt, int count) {
  Kokkos::parallel_for(
      "greenwater::kick", Range(0, count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) u(i, d) += dt * a(i, d);
      });
}

template <int Dim>
int advance_in(Fluid& fluid, const Survey& survey, real dt) {
  const auto grid = fluid.grid.shape();
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  const auto a = Read<VectorField>(fluid.particles.acceleration);
  const auto walls = fluid.walls;
  const auto shift = Read<VectorField>(survey.shift), gradient = Read<VectorField>(survey.velocity_gradient);
  const bool shifts = shift.extent(0) > 0;
  const real g[3] = {fluid.gravity[0], fluid.gravity[1], fluid.gravity[2]};
  const Sweep sweep{0, dt};
  int stops = 0;
  Kokkos::parallel_reduce(
      "greenwater::advance", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, int& sum) {
        auto ui = load<Dim>(u, i);
        Vec<Dim, coord> dx;
        for (int d = 0; d < Dim; ++d) {
          ui[d] += dt * (g[d] + a(i, d));
          dx[d] = coord(dt) * ui[d];
        }
        if (shifts) {
          const auto by = load<Dim>(shift, i);
          for (int d = 0; d < Dim; ++d) {
            dx[d] += by[d];
            for (int e = 0; e < Dim; ++e) ui[d] += gradient(i, d * Dim + e) * by[e];
          }
        }
        sum += move(walls, grid, sweep, x, u, i, dx, ui);
      },
      stops);
  return stops;
}

template <int Dim>
void pressure_gradient_in(const Fluid& fluid, const VectorField& a) {
  const auto near = around_unmoved<Dim>(fluid, fluid.gradient.weight);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto drive = drive_of<Dim>(fluid);
  const auto w = fluid.gradient.weight;
  const real rho = fluid.rho;
  const real factor = -Dim / (fluid.gradient.reference.n0 * rho);
  const real touching = static_cast<real>(1e-12 * fluid.spacing * fluid.spacing);
  Kokkos::parallel_for(
      "greenwater::pressure_gradient", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        Pack p_min = load_pack(p, i);
        Vec<Dim, Pack> sum_pf{}, sum_f{};  // sum (p_j - p_min) f = sum p_j f - p_min sum f: one pass
        near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
          const Pack r2 = dot(r, r);
          const Pack weight = zero_unless(r2 >= touching, image.weight(w, r2));
          const Pack pj = gather_pack(p, j) + rho * image.pressure_offset(drive, j);
          p_min = select(weight > 0, smaller(p_min, pj), p_min);
          const auto f = along(Vec<Dim, Pack>{}, weight * inverse(larger(r2, all_lanes<Pack>(touching))), r);
          sum_pf = along(sum_pf, pj, f);
          sum_f = along(sum_f, all_lanes<Pack>(real(1)), f);
        });
        const auto grad = along(sum_pf, -p_min, sum_f);
        store_pack(a, i, along(Vec<Dim, Pack>{}, all_lanes<Pack>(factor), grad));
      });
}

}  // namespace

void clear_acceleration(Fluid& fluid) {
  const VectorField a = fluid.particles.acceleration;
  const int count = fluid.particles.count;
  fluid.particles.dim == 2 ? clear_acceleration_in<2>(a, count) : clear_acceleration_in<3>(a, count);
}

int predict(Fluid& fluid, real dt) {
  Region region("predict");
  return fluid.particles.dim == 2 ? predict_in<2>(fluid, dt) : predict_in<3>(fluid, dt);
}

void kick(Fluid& fluid, real dt) {
  const Particles& p = fluid.particles;
  p.dim == 2 ? kick_in<2>(p.velocity, p.acceleration, dt, p.count)
             : kick_in<3>(p.velocity, p.acceleration, dt, p.count);
}

int advance(Fluid& fluid, const Survey& survey, real dt) {
  Region region("advance");
  return fluid.particles.dim == 2 ? advance_in<2>(fluid, survey, dt) : advance_in<3>(fluid, survey, dt);
}

void clip_pressure(Fluid& fluid) {
  const ScalarField p = fluid.particles.pressure;
  Kokkos::parallel_for(
      "greenwater::clip_pressure", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i) { p(i) = larger(p(i), real(0)); });
}

void pressure_gradient(Fluid& fluid) {
  Region region("gradient");
  const VectorField a = fluid.particles.acceleration;
  fluid.particles.dim == 2 ? pressure_gradient_in<2>(fluid, a) : pressure_gradient_in<3>(fluid, a);
}

int correct(Fluid& fluid, real dt) {
  Region region("correct");
  return fluid.particles.dim == 2 ? correct_in<2>(fluid, dt) : correct_in<3>(fluid, dt);
}

}  // namespace greenwater
