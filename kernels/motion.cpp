#include "kernels/motion.hpp"

#include "core/region.hpp"
#include "kernels/wall_stop.hpp"

namespace greenwater {
namespace {

template <int Dim>
void clear_acceleration_in(const VectorField& a, int count) {
  Kokkos::parallel_for(
      "greenwater::clear_acceleration", Range(0, count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) a(i, d) = 0;
      });
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
