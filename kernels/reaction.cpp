#include "kernels/reaction.hpp"

#include <cmath>

#include "kernels/small_matrix.hpp"

namespace greenwater {
namespace {

// How the pressure of a particle pushes a body, by way of each image that it sees.
template <int Dim>
struct Pusher {
  Around<Dim> near;
  Fits<Dim> fits;
  Weight w;
  Read<VectorField> correction;
  Read<FlagField> fixed;
  coord touching, nearest2, n0, twice_volume;
  int body;

  // What the velocity of an image at r counts in the divergence of particle i by least squares.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> fitted_pull(int i, const Vec<Dim, coord>& r, real share) const {
    const int first = i / pack_lanes * pack_lanes;
    Vec<Dim, Pack> r_of_all;
    for (int d = 0; d < Dim; ++d) r_of_all[d] = all_lanes<Pack>(static_cast<real>(r[d]));
    return lane_of<Dim, coord>(fits.of(first).slope(r_of_all, share), i - first);
  }

  // Calls f(face, place, force per pressure) for every wall of the body on the path of every image of particle i.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each(int i, F f) const {
    const int number = near.images.number(i);
    if (number == 0 || fixed(i)) return;
    const auto xi = load<Dim>(near.x, i);
    Symmetric<Dim, coord> C;
    for (int k = 0; k < Symmetric<Dim, coord>::size; ++k) C.c[k] = correction(i, k);
    for (int k = 0; k < number; ++k) {
      const auto entry = near.images.place(i, k);
      const Mirror& mirror = near.mirrors(near.images.mirror(entry));
      const auto xj = near.place_beside(xi, load<Dim>(near.x, near.images.index(entry)));
      const auto r = difference(image_position(mirror, xj), xi);
      const coord r2 = dot(r, r);
      if (!(r2 > touching)) continue;
      const real share = near.images.share(entry);
      real weight = share * w(static_cast<real>(sqrt(r2)));
      if (near.kept) weight = static_cast<float>(weight);  // as the divergence had it
      const Image<Dim> image{&mirror, near.panels.data(), near.joints.data(), xj, xi};
      auto pull = along(Vec<Dim, coord>{}, weight / (n0 * larger(r2, nearest2)), product(C, r));
      if (fits.any) pull = along(pull, fits.share(i), difference(fitted_pull(i, r, share), pull));
      image.for_each_wall([&](const Panel& wall, const Vec<Dim, coord>& place) {
        const auto n = Sight<Dim>::as_vec(wall.normal);
        const coord along_n = dot(pull, n);
        if (wall.body == body) f(wall.face, place, along(Vec<Dim, coord>{}, twice_volume * along_n, n));
        pull = along(pull, -2 * along_n, n);
      });
    }
  }
};

template <int Dim>
Pusher<Dim> pusher_of(const Fluid& fluid, const Survey& survey, int body) {
  const auto w = fluid.gradient.weight;
  return {around_unmoved<Dim>(fluid, w),
          Fits<Dim>(fluid.fits),
          w,
          survey.divergence_correction,
          survey.fixed,
          1e-12 * fluid.spacing * fluid.spacing,
          std::pow(nearest_quotient * fluid.spacing, 2),
          fluid.gradient.reference.n0,
          2 * std::pow(fluid.spacing, Dim),
          body};
}

template <int Dim>
std::array<double, 3> wall_reaction_in(const Fluid& fluid, const Survey& survey, int body) {
  const auto pusher = pusher_of<Dim>(fluid, survey, body);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  accum fx = 0, fy = 0, fz = 0;
  Kokkos::parallel_reduce(
      "greenwater::wall_reaction", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, accum& sum_x, accum& sum_y, accum& sum_z) {
        Vec<Dim, coord> force{};
        pusher.for_each(
            i, [&](int, const Vec<Dim, coord>&, const Vec<Dim, coord>& push) { force = along(force, coord(1), push); });
        sum_x += p(i) * force[0];
        sum_y += p(i) * force[1];
        if (Dim == 3) sum_z += p(i) * force[Dim - 1];
      },
      fx, fy, fz);
  return {fx, fy, fz};
}

template <int Dim>
std::vector<WallPush> wall_pushes_in(const Fluid& fluid, const Survey& survey, int body) {
  const auto pusher = pusher_of<Dim>(fluid, survey, body);
  const int count = fluid.particles.count;
  const IndexField first("greenwater::wall_push_first", count + 1);
  Kokkos::parallel_scan(
      "greenwater::wall_push_count", Range(0, count + 1), KOKKOS_LAMBDA(const int i, int& sum, const bool final) {
        if (final) first(i) = sum;
        if (i == count) return;
        pusher.for_each(i, [&](int, const Vec<Dim, coord>&, const Vec<Dim, coord>&) { ++sum; });
      });
  int number = 0;
  Kokkos::deep_copy(number, Kokkos::subview(first, count));
  Kokkos::View<WallPush*, Device> pushes("greenwater::wall_pushes", number);
  Kokkos::parallel_for(
      "greenwater::wall_pushes", Range(0, count), KOKKOS_LAMBDA(const int i) {
        int at = first(i);
        pusher.for_each(i, [&](int face, const Vec<Dim, coord>& place, const Vec<Dim, coord>& push) {
          WallPush& made = pushes(at++);
          made.particle = i;
          made.face = face;
          for (int d = 0; d < Dim; ++d) {
            made.place[d] = place[d];
            made.push[d] = push[d];
          }
        });
      });
  std::vector<WallPush> host(number);
  Kokkos::deep_copy(Kokkos::View<WallPush*, Kokkos::HostSpace>(host.data(), number), pushes);
  return host;
}

}  // namespace

std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body) {
  if (fluid.rows.images.number.extent(0) == 0) return {};
  return fluid.particles.dim == 2 ? wall_reaction_in<2>(fluid, survey, body) : wall_reaction_in<3>(fluid, survey, body);
}

std::vector<WallPush> wall_pushes(const Fluid& fluid, const Survey& survey, int body) {
  if (fluid.rows.images.number.extent(0) == 0) return {};
  return fluid.particles.dim == 2 ? wall_pushes_in<2>(fluid, survey, body) : wall_pushes_in<3>(fluid, survey, body);
}

}  // namespace greenwater
