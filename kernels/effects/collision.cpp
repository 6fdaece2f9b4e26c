#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

// Calls f(j, n, speed, so) for particles or images j that a pack of particles collides with, in those lanes where it is so:
// n points from the one to the other, speed is that of approach.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_collision(const Around<Dim>& near, const Read<VectorField>& u, real distance,
                                               int i, F f) {
  const auto ui = load_pack<Dim>(u, i);
  near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
    const Pack r2 = dot(r, r), share = Pack{} + image.share;
    // Of two images at the edge of a corner the nearer one.
    const auto close = (r2 < distance * distance) & (r2 > 0) & (share >= real(0.5));
    if (!any_lane(close)) return;
    const auto uj = image.velocity(gather_pack<Dim>(u, j));
    const Pack scale = 1 / sqrt(select(r2 > 0, r2, all_lanes<Pack>(real(1))));
    const auto n = along(Vec<Dim, Pack>{}, scale, r);
    const Pack approach = dot(difference(ui, uj), n);
    const auto so = close & (approach > 0);
    if (any_lane(so)) f(j, n, approach, so);
  });
}

// Marks the packs with anybody closer than `distance`.
template <int Dim>
void find_crowded_in(const Fluid& fluid, real distance, const FlagField& crowded) {
  const auto near = around<Dim>(fluid);
  Kokkos::parallel_for(
      "greenwater::collision_find_crowded", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        bool found = false;
        near.for_each(pack * pack_lanes, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto&) {
          found = found || any_lane(dot(r, r) < distance * distance);
        });
        crowded(pack) = found;
      });
}

template <int Dim>
int count_collisions_in(const Fluid& fluid, real distance, const FlagField& crowded, const IndexField& number) {
  const auto near = around<Dim>(fluid);
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const int count = fluid.particles.count;
  int total = 0;
  Kokkos::parallel_reduce(
      "greenwater::count_collisions", packs(count),
      KOKKOS_LAMBDA(const int pack, int& sum) {
        const int i = pack * pack_lanes;
        Pack collisions{};
        if (crowded(pack))
          for_each_collision(near, u, distance, i,
                             [&](const IndexPack&, const Vec<Dim, Pack>&, const Pack&, const auto& so) {
                               collisions += zero_unless(so, all_lanes<Pack>(real(1)));
                             });
        for (int l = 0; l < pack_lanes && i + l < count; ++l) {
          number(i + l) = static_cast<int>(lane(collisions, l));
          sum += number(i + l);
        }
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
      "greenwater::collision", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto mine = convert_lanes<Pack>(load_pack(number, i));
        Vec<Dim, Pack> change{};
        if (any_lane(mine > 0))
          for_each_collision(near, u, distance, i,
                             [&](const IndexPack& j, const Vec<Dim, Pack>& n, const Pack& approach, const auto& so) {
                               const auto busier = larger(mine, convert_lanes<Pack>(gather_pack(number, j)));
                               const Pack share = larger(busier, all_lanes<Pack>(real(1)));
                               change = along(change, zero_unless(so, -(1 + restitution) / 2 * approach / share), n);
                             });
        store_pack(du, i, change);
      });
}

// Returns how far the one went that went farthest [m].
template <int Dim>
real move_on_in(const Fluid& fluid, const VectorField& du, real dt) {
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  real farthest2 = 0;
  Kokkos::parallel_reduce(
      "greenwater::collision_move", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, real& most) {
        const auto change = load<Dim>(du, i);
        const real change2 = dot(change, change);
        if (change2 == 0) return;
        for (int d = 0; d < Dim; ++d) {
          u(i, d) += change[d];
          x(i, d) += dt * change[d];
        }
        most = larger(most, change2);
      },
      Kokkos::Max<real>(farthest2));
  return dt * sqrt(farthest2);
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
      crowded_ = uncleared<FlagField>("greenwater::collision_crowded", p.id.extent(0));
    }
    p.dim == 2 ? apply_in<2>(fluid, dt) : apply_in<3>(fluid, dt);
  }

 private:
  template <int Dim>
  void apply_in(Fluid& fluid, real dt) {
    const real distance = options_.distance * static_cast<real>(fluid.spacing), margin = distance / 10;
    real left = 0;  // how far particles may still go before others than those in crowded packs can collide [m]
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      if (left <= 0) {
        find_crowded_in<Dim>(fluid, distance + margin, crowded_);
        left = margin / 2;
      }
      if (count_collisions_in<Dim>(fluid, distance, crowded_, number_) == 0) return;
      collide_in<Dim>(fluid, distance, options_.restitution, number_, du_);
      left -= move_on_in<Dim>(fluid, du_, dt);
    }
  }

  CollisionOptions options_;
  IndexField number_;
  FlagField crowded_;  // (pack)
  VectorField du_;
};

}  // namespace

std::unique_ptr<Effect> make_collision(const CollisionOptions& options) { return std::make_unique<Collision>(options); }

}  // namespace greenwater
