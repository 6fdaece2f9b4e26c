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

// A way from x to x + dx that crosses a face is bent: along the face it goes on, towards the face it ends where it
// began, and the speed towards the face becomes the face's own. Returns whether it was.
template <int Dim>
KOKKOS_INLINE_FUNCTION bool stop_at_faces(const MirrorWalls& walls, const GridShape& grid, const Vec<Dim, coord>& x,
                                          Vec<Dim, coord>& dx, Vec<Dim>& u) {
  const auto sight = sight_from(walls, grid, x, dot(dx, dx) > grid.cell * grid.cell);
  bool stopped = false;
  for (int k = sight.begin; k < sight.end; ++k) {
    const Mirror& m = sight.mirror(sight.reach(k));
    if (!sight.is_face(m) || !sight.meets(m, x, along(x, coord(1), dx))) continue;
    coord way = 0;
    real speed = 0;
    for (int d = 0; d < Dim; ++d) {
      way += dx[d] * m.normal[d];
      speed += (u[d] - m.velocity[d] / 2) * static_cast<real>(m.normal[d]);
    }
    for (int d = 0; d < Dim; ++d) {
      dx[d] -= way * m.normal[d];
      u[d] -= speed * static_cast<real>(m.normal[d]);
    }
    stopped = true;
  }
  // Past the end of one face and into another: stay.
  if (stopped && !sight.sees(x, along(x, coord(1), dx)))
    for (int d = 0; d < Dim; ++d) dx[d] = 0;
  return stopped;
}

// Moves particle i by dx, or as far as the walls let it. Returns 1 when they stopped it.
template <int Dim>
KOKKOS_INLINE_FUNCTION int move(const MirrorWalls& walls, const GridShape& grid, const CoordField& x,
                                const VectorField& u, int i, Vec<Dim, coord> dx, Vec<Dim> ui) {
  const auto xi = load<Dim>(x, i);
  const int stopped = stop_at_faces(walls, grid, xi, dx, ui) ? 1 : 0;
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
        sum += move(walls, grid, x, u, i, dx, ui);
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
        sum += move(walls, grid, x, u, i, dx, ui);
      },
      stops);
  return stops;
}

template <int Dim>
void pressure_gradient_in(const Fluid& fluid, const VectorField& a) {
  const auto around = fluid.rows.around<Dim>(fluid.particles);
  const auto x = Read<CoordField>(fluid.particles.position);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto drive = drive_of<Dim>(fluid);
  const auto w = fluid.gradient.weight;
  const real rho = fluid.rho;
  const real factor = -Dim / (fluid.gradient.reference.n0 * rho);
  const real touching = static_cast<real>(1e-12 * fluid.spacing * fluid.spacing);
  Kokkos::parallel_for(
      "greenwater::pressure_gradient", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        real p_min = p(i);
        Vec<Dim> sum_pf{}, sum_f{};  // sum (p_j - p_min) f = sum p_j f - p_min sum f: one pass
        around.for_each(i, [&](const int j, const Vec<Dim>& r, const Mirror* m) {
          const real r2 = dot(r, r);
          const real weight = w(sqrt(r2));
          if (!(weight > 0) || r2 < touching) return;
          real pj = p(j);
          if (m) pj += rho * image_offset(*m, drive.at(j), load<Dim>(x, j));
          p_min = smaller(p_min, pj);
          for (int d = 0; d < Dim; ++d) {
            const real f = r[d] * weight / r2;
            sum_pf[d] += pj * f;
            sum_f[d] += f;
          }
        });
        for (int d = 0; d < Dim; ++d) a(i, d) = factor * (sum_pf[d] - p_min * sum_f[d]);
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
