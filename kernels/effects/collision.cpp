#include <cmath>

#include "kernels/effects/effect.hpp"

namespace greenwater {
namespace {

constexpr int most_close = 8;  // neighbours in a particle's list; with more of them its whole row is looked at

using NeighbourLists = Kokkos::View<int**, Kokkos::LayoutLeft, Device>;

/// Device view of who is so close that collisions are possible: short lists, as every sweep goes through them.
template <int Dim>
struct Close {
  Around<Dim> near;
  IndexField number;         // (i) of neighbours
  NeighbourLists neighbour;  // (i, k)
  FlagField images;          // (pack) whether any image is that close
  ScalarField way;           // (i) how far it has gone since lists with it were made, at most [m]
  IndexField stale;          // (pack) whether its lists are to be made anew

  /// Lists neighbours and images of a pack of particles that are closer than `distance`. Returns the square of the distance
  /// of the nearest neighbour that it has listed, or else of `distance` [m^2].
  KOKKOS_INLINE_FUNCTION real find(int i, real distance) const {
    int found[pack_lanes] = {};
    real nearest2 = distance * distance;
    near.for_each_neighbour(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto&) {
      const Pack r2 = dot(r, r);
      const unsigned bits = lane_bits(r2 < distance * distance);
      if (bits == 0) return;
      for (int l = 0; l < pack_lanes; ++l) {
        if (!(bits >> l & 1)) continue;
        nearest2 = smaller(nearest2, lane(r2, l));
        if (found[l] < most_close) neighbour(i + l, found[l]) = lane(j, l);
        ++found[l];
      }
    });
    for (int l = 0; l < pack_lanes; ++l) number(i + l) = found[l];
    bool any = false;
    near.for_each_image(i, [&](const IndexPack&, const Vec<Dim, Pack>& r, const auto&) {
      any = any || any_lane(dot(r, r) < distance * distance);
    });
    images(i / pack_lanes) = any;
    return nearest2;
  }

  /// Tells everybody around those of a pack of particles that have gone too far.
  KOKKOS_INLINE_FUNCTION void tell(int i, real too_far) const {
    const Pack gone = load_pack(way, i);
    const unsigned bits = lane_bits(gone > too_far);
    if (bits == 0) return;
    store_lanes(&way(i), zero_unless(gone <= too_far, gone));
    Kokkos::atomic_fetch_or(&stale(i / pack_lanes), 1);
    near.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>&, const auto&) {
      for (int l = 0; l < pack_lanes; ++l)
        if (bits >> l & 1) Kokkos::atomic_fetch_or(&stale(lane(j, l) / pack_lanes), 1);
    });
  }

  /// As Around::for_each(), for these.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each(int i, F f) const {
    int most = 0;
    for (int l = 0; l < pack_lanes; ++l) most = larger(most, number(i + l));
    if (most > most_close) {
      near.for_each_neighbour(i, f);
    } else if (most > 0) {
      const auto xi = load_pack<Dim>(near.x, i);
      const auto all = load_pack(number, i), self = counted_lanes<IndexPack>() + i;
      for (int k = 0; k < most; ++k) {
        const auto j = select(all > k, load_lanes<IndexPack>(&neighbour(i, k)), self);  // at no distance from itself
        f(j, convert_lanes_of<Pack>(way_between(near.grid, xi, gather_pack<Dim>(near.x, j))), Itself<Dim>{});
      }
    }
    if (images(i / pack_lanes)) near.for_each_image(i, f);
  }
};

// Calls f(j, n, speed, so) for particles or images j that a pack of particles collides with, in those lanes where it is so:
// n points from the one to the other, speed is that of approach.
template <int Dim, class F>
KOKKOS_INLINE_FUNCTION void for_each_collision(const Close<Dim>& close, const Read<VectorField>& u, real distance,
                                               int i, F f) {
  const auto ui = load_pack<Dim>(u, i);
  close.for_each(i, [&](const IndexPack& j, const Vec<Dim, Pack>& r, const auto& image) {
    const Pack r2 = dot(r, r), share = Pack{} + image.share;
    // Of two images at the edge of a corner the nearer one.
    const auto near = (r2 < distance * distance) & (r2 > 0) & (share >= real(0.5));
    if (!any_lane(near)) return;
    const auto uj = image.velocity(gather_pack<Dim>(u, j));
    const Pack scale = inverse(sqrt(select(near, r2, all_lanes<Pack>(real(1)))));
    const auto n = along(Vec<Dim, Pack>{}, scale, r);
    const Pack approach = dot(difference(ui, uj), n);
    const auto so = near & (approach > 0);
    if (any_lane(so)) f(j, n, approach, so);
  });
}

// Returns the square of the distance of the nearest two, or of `distance` [m^2].
template <int Dim>
real find_close_in(const Close<Dim>& close, real distance, int count) {
  real nearest2 = 0;
  Kokkos::parallel_reduce(
      "greenwater::collision_find_close", packs(count),
      KOKKOS_LAMBDA(const int pack, real& least) {
        least = smaller(least, close.find(pack * pack_lanes, distance));
        store_lanes(&close.way(pack * pack_lanes), Pack{});
        close.stale(pack) = 0;
      },
      Kokkos::Min<real>(nearest2));
  return nearest2;
}

// The same where somebody came or went farther than `too_far`.
template <int Dim>
void find_close_again_in(const Close<Dim>& close, real distance, real too_far, int count) {
  Kokkos::parallel_for(
      "greenwater::collision_tell", packs(count),
      KOKKOS_LAMBDA(const int pack) { close.tell(pack * pack_lanes, too_far); });
  Kokkos::parallel_for(
      "greenwater::collision_find_again", packs(count), KOKKOS_LAMBDA(const int pack) {
        if (!close.stale(pack)) return;
        close.find(pack * pack_lanes, distance);
        close.stale(pack) = 0;
      });
}

template <int Dim>
int count_collisions_in(const Close<Dim>& close, const Fluid& fluid, real distance, const IndexField& number) {
  const auto u = Read<VectorField>(fluid.particles.velocity);
  const int count = fluid.particles.count;
  int total = 0;
  Kokkos::parallel_reduce(
      "greenwater::count_collisions", packs(count),
      KOKKOS_LAMBDA(const int pack, int& sum) {
        const int i = pack * pack_lanes;
        Pack collisions{};
        for_each_collision(close, u, distance, i,
                           [&](const IndexPack&, const Vec<Dim, Pack>&, const Pack&, const auto& so) {
                             collisions += zero_unless(so, all_lanes<Pack>(real(1)));
                           });
        collisions = first_lanes(count - i, collisions);
        store_lanes(&number(i), convert_lanes<IndexPack>(collisions));
        sum += static_cast<int>(sum_lanes(collisions));
      },
      total);
  return total;
}

// The share of a pair is that of the busier of the two: momentum is kept to the last bit of each pair, and the sum over
// pairs has no eigenvalue above 2, so that kinetic energy never grows.
template <int Dim>
void collide_in(const Close<Dim>& close, const Fluid& fluid, real distance, real restitution, const IndexField& number,
                const VectorField& du) {
  const auto u = Read<VectorField>(fluid.particles.velocity);
  Kokkos::parallel_for(
      "greenwater::collision", packs(fluid.particles.count), KOKKOS_LAMBDA(const int pack) {
        const int i = pack * pack_lanes;
        const auto mine = convert_lanes<Pack>(load_pack(number, i));
        Vec<Dim, Pack> change{};
        if (any_lane(mine > 0))
          for_each_collision(close, u, distance, i,
                             [&](const IndexPack& j, const Vec<Dim, Pack>& n, const Pack& approach, const auto& so) {
                               const auto busier = larger(mine, convert_lanes<Pack>(gather_pack(number, j)));
                               const Pack share = larger(busier, all_lanes<Pack>(real(1)));
                               change = along(change, zero_unless(so, -(1 + restitution) / 2 * approach / share), n);
                             });
        store_pack(du, i, change);
      });
}

// Returns the longest way that anybody has gone [m].
template <int Dim>
real move_on_in(const Fluid& fluid, const VectorField& du, real dt, const ScalarField& way) {
  const auto x = fluid.particles.position;
  const auto u = fluid.particles.velocity;
  real longest = 0;
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
        way(i) += dt * sqrt(change2);
        most = larger(most, way(i));
      },
      Kokkos::Max<real>(longest));
  return longest;
}

class Bouncing : public Collision {
 public:
  explicit Bouncing(const CollisionOptions& options) : options_(options) {}
  std::string_view name() const override { return "collision"; }
  Stage stage() const override { return Stage::after_move; }
  void apply(Fluid& fluid, real dt) override {
    const Particles& p = fluid.particles;
    if (number_.extent(0) < p.id.extent(0)) {
      number_ = uncleared<IndexField>("greenwater::collision_number", p.id.extent(0));
      du_ = uncleared<VectorField>("greenwater::collision_change", p.id.extent(0), p.dim);
      close_ = uncleared<IndexField>("greenwater::collision_close", p.id.extent(0));
      neighbour_ = uncleared<NeighbourLists>("greenwater::collision_neighbour", p.id.extent(0), most_close);
      images_ = uncleared<FlagField>("greenwater::collision_images", p.id.extent(0) / pack_lanes);
      way_ = uncleared<ScalarField>("greenwater::collision_way", p.id.extent(0));
      stale_ = uncleared<IndexField>("greenwater::collision_stale", p.id.extent(0) / pack_lanes);
    }
    p.dim == 2 ? apply_in<2>(fluid, dt) : apply_in<3>(fluid, dt);
  }
  real nearest() const override { return nearest_; }

 private:
  template <int Dim>
  void apply_in(Fluid& fluid, real dt) {
    // Two can only collide unlisted after one of them has gone half the margin.
    const real distance = options_.distance * static_cast<real>(fluid.spacing), margin = distance / 10;
    const int count = fluid.particles.count;
    const Close<Dim> close = {around<Dim>(fluid), close_, neighbour_, images_, way_, stale_};
    nearest_ = std::sqrt(find_close_in(close, distance + margin, count));
    for (int sweep = 1; count_collisions_in(close, fluid, distance, number_) > 0; ++sweep) {
      collide_in(close, fluid, distance, options_.restitution, number_, du_);
      const real longest = move_on_in<Dim>(fluid, du_, dt, way_);
      if (sweep == options_.sweeps) return;
      if (longest > margin / 2) find_close_again_in(close, distance + margin, margin / 2, count);
    }
  }

  CollisionOptions options_;
  real nearest_ = 0;   // [m]
  IndexField number_;  // (i) of collisions
  IndexField close_;
  NeighbourLists neighbour_;
  FlagField images_;
  ScalarField way_;
  IndexField stale_;
  VectorField du_;
};

}  // namespace

std::unique_ptr<Collision> make_collision(const CollisionOptions& options) {
  return std::make_unique<Bouncing>(options);
}

}  // namespace greenwater
