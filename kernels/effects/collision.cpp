#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

// Calls f(j, n, speed) for each particle or image that i collides with: n points from i to it, speed is that of approach.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_collision(const Around<Dim>& near, const Read<VectorField>& u, real distance,
                                               int i, F f) {
  const auto ui = load<Dim>(u, i);
  const real half = real(0.5);  // of two images at the edge of a corner the nearer one
  near.for_each(i, [&](const int j, const Vec<Dim>& r, const Image<Dim>& image) {
    const real r2 = dot(r, r);
    if (r2 >= distance * distance || r2 <= 0 || image.share < half) return;
    const auto uj = image ? image.velocity(load<Dim>(u, j)) : load<Dim>(u, j);
    const real approach = dot(difference(ui, uj), r) / sqrt(r2);
    if (approach > 0) f(j, along(Vec<Dim>{}, 1 / sqrt(r2), r), approach);
  });
}

template <int Dim>
int count_collisions_in(const Fluid& fluid, real distance, const IndexField& number) {
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  int total = 0;
  Kokkos::parallel_reduce(
      "greenwater::count_collisions", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, int& sum) {
        int count = 0;
        for_each_collision(near, u, distance, i, [&](int, const Vec<Dim>&, real) { ++count; });
        number(i) = count;
        sum += count;
      },
      total);
  return total;
}

// The share of a pair is that of the busier of the two: momentum is kept to the last bit of each pair, and the sum over
// pairs has no eigenvalue above 2, so that kinetic energy never grows.
template <int Dim>
void collide_in(const Fluid& fluid, real distance, real restitution, const IndexField& number, const VectorField& du) {
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  Kokkos::parallel_for(
      "greenwater::collision", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        Vec<Dim> change{};
        if (number(i) > 0)
          for_each_collision(near, u, distance, i, [&](const int j, const Vec<Dim>& n, const real approach) {
            const int share = number(i) > number(j) ? number(i) : number(j);
            change = along(change, -(1 + restitution) / 2 * approach / share, n);
          });
        store(du, i, change);
      });
}

template <int Dim>
void move_on_in(const Fluid& fluid, const VectorField& du, real dt) {
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  Kokkos::parallel_for(
      "greenwater::collision_move", Range(0, fluid.particles.count), KOKKOS_LAMBDA(const int i) {
        for (int d = 0; d < Dim; ++d) {
          u(i, d) += du(i, d);
          x(i, d) += dt * du(i, d);
        }
      });
}

class Collision : public Effect {
 public:
  explicit Collision(const CollisionOptions& options) : options_(options) {}
  std::string_view name() const override { return "collision"; }
  Stage stage() const override { return Stage::after_predict; }
  void apply(Fluid& fluid, real dt) override {
    const Particles& p = fluid.particles;
    if (number_.extent(0) < p.id.extent(0)) {
      number_ = uncleared<IndexField>("greenwater::collision_number", p.id.extent(0));
      du_ = uncleared<VectorField>("greenwater::collision_change", p.id.extent(0), p.dim);
    }
    p.dim == 2 ? apply_in<2>(fluid, dt) : apply_in<3>(fluid, dt);
  }

 private:
  template <int Dim>
  void apply_in(Fluid& fluid, real dt) {
    const real distance = options_.distance * static_cast<real>(fluid.spacing);
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      if (count_collisions_in<Dim>(fluid, distance, number_) == 0) return;
      collide_in<Dim>(fluid, distance, options_.restitution, number_, du_);
      move_on_in<Dim>(fluid, du_, dt);
    }
  }

  CollisionOptions options_;
  IndexField number_;
  VectorField du_;
};

}  // namespace

std::unique_ptr<Effect> make_collision(const CollisionOptions& options) { return std::make_unique<Collision>(options); }

}  // namespace greenwater
