#include "kernels/operators/wall_pushes.hpp"

#include <cmath>

#include "kernels/small_matrix.hpp"

namespace greenwater {
namespace {

constexpr int capacity = 12;               // panels that one particle pushes; of more, some get several pushes
constexpr coord poor = 0.15, fair = 0.35;  // of a one-sided neighbourhood: 1 when round, 0 when particles are in a line

// What a particle pushes of one panel.
template <int Dim>
struct Group {
  int panel, face;
  coord area;
  Vec<Dim, coord> normal, moment;  // area x place
};

template <int Dim>
struct Gradient {
  coord of[Dim][Dim];
};

// How the pressure of a particle pushes a body, by way of each image that it sees.
template <int Dim>
struct Pusher {
  Around<Dim> near;
  Fits<Dim> fits;
  Weight w;
  Read<VectorField> correction, u;
  Read<FlagField> fixed;
  Drive<Dim> drive;
  coord touching, nearest2, n0, twice_volume;
  int body;

  // What the velocity of an image at r counts in the divergence of particle i by least squares.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> fitted_pull(int i, const Vec<Dim, coord>& r, real share) const {
    const int first = i / pack_lanes * pack_lanes;
    Vec<Dim, Pack> r_of_all;
    for (int d = 0; d < Dim; ++d) r_of_all[d] = all_lanes<Pack>(static_cast<real>(r[d]));
    return lane_of<Dim, coord>(fits.of(first).slope(r_of_all, share), i - first);
  }

  // Calls f(panel, place, normal into the wall, force per pressure along it) for every wall of the body on the path of
  // every image of particle i.
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
      auto way = r;  // of the path, reflected at each wall as it is
      image.for_each_wall([&](const Panel& wall, const Vec<Dim, coord>& place) {
        const auto n = Sight<Dim>::as_vec(wall.normal);
        const coord pull_n = dot(pull, n), way_n = dot(way, n), into = way_n < 0 ? -1 : 1;
        if (wall.body == body) f(wall, place, along(Vec<Dim, coord>{}, into, n), twice_volume * into * pull_n);
        pull = along(pull, -2 * pull_n, n);
        way = along(way, -2 * way_n, n);
      });
    }
  }

  // Calls f(group) for every panel that particle i pushes, and separately for what pulls.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_group(int i, F f) const {
    Group<Dim> group[capacity]{};
    int number = 0;
    const Panel* first = near.panels.data();
    for_each(i, [&](const Panel& wall, const Vec<Dim, coord>& place, const Vec<Dim, coord>& into, coord area) {
      const int panel = static_cast<int>(&wall - first);
      int g = 0;
      while (g < number &&
             !(group[g].panel == panel && dot(group[g].normal, into) > 0 && (group[g].area < 0) == (area < 0)))
        ++g;
      if (area == 0) return;
      if (g == capacity) return f(Group<Dim>{panel, wall.face, area, into, along(Vec<Dim, coord>{}, area, place)});
      if (g == number) group[number++] = {panel, wall.face, 0, into, {}};
      group[g].area += area;
      group[g].moment = along(group[g].moment, area, place);
    });
    for (int g = 0; g < number; ++g) f(group[g]);
  }

  // grad u of the neighbours alone, which no wall has told anything; 0 where they are in a line.
  KOKKOS_INLINE_FUNCTION Gradient<Dim> flow_gradient(int i) const {
    Gradient<Dim> gradient{};
    Symmetric<Dim, coord> M{};
    coord B[Dim][Dim] = {};
    const auto xi = load<Dim>(near.x, i);
    for (int k = 0; k < near.near.number(i); ++k) {
      const int j = near.near.index(near.near.place(i, k));
      const auto r = difference(near.place_beside(xi, load<Dim>(near.x, j)), xi);
      const coord r2 = dot(r, r);
      if (!(r2 > touching)) continue;
      const coord weight = w(static_cast<real>(sqrt(r2))) / larger(r2, nearest2);
      M.add_square(weight, r);
      for (int d = 0; d < Dim; ++d)
        for (int e = 0; e < Dim; ++e) B[d][e] += weight * (u(j, d) - u(i, d)) * r[e];
    }
    const auto C = adjugate(M);
    const coord det = determinant(M, C);
    coord round = det;
    for (int d = 0; d < Dim; ++d) round = round / (M.trace() / Dim);
    if (!(round > poor)) return gradient;
    const coord t = round < fair ? (round - poor) / (fair - poor) : coord(1), good = t * t * (3 - 2 * t);
    for (int d = 0; d < Dim; ++d)
      for (int e = 0; e < Dim; ++e)
        for (int f = 0; f < Dim; ++f) gradient.of[d][e] += good * B[d][f] * C(f, e) / det;
    return gradient;
  }

  KOKKOS_INLINE_FUNCTION WallPush push_of(int i, const Group<Dim>& group, const Gradient<Dim>& gradient) const {
    WallPush made;
    made.particle = i;
    made.face = group.face;
    made.area = group.area;
    for (int d = 0; d < Dim; ++d) {
      made.place[d] = group.moment[d] / group.area;
      made.normal[d] = group.normal[d];
      made.from_particle[d] = made.place[d] - near.x(i, d);
      Vec<Dim, coord> axis{};
      axis[d] = 1;
      made.drive[d] = drive.along(axis, i);
    }
    for (int d = 0; d < Dim; ++d) {
      made.flow[d] = u(i, d);
      for (int e = 0; e < Dim; ++e) made.flow_gradient[d][e] = gradient.of[d][e];
    }
    return made;
  }
};

template <int Dim>
Pusher<Dim> pusher_of(const Fluid& fluid, const Survey& survey, int body) {
  const auto w = fluid.gradient.weight;
  return {around_unmoved<Dim>(fluid, w),
          Fits<Dim>(fluid.fits),
          w,
          survey.divergence_correction,
          fluid.particles.velocity,
          survey.fixed,
          drive_of<Dim>(fluid),
          1e-12 * fluid.spacing * fluid.spacing,
          std::pow(nearest_quotient * fluid.spacing, 2),
          fluid.gradient.reference.n0,
          2 * std::pow(fluid.spacing, Dim),
          body};
}

template <int Dim>
std::vector<WallPush> wall_pushes_in(const Fluid& fluid, const Survey& survey, int body) {
  const auto pusher = pusher_of<Dim>(fluid, survey, body);
  const int count = fluid.particles.count;
  const IndexField first("greenwater::wall_push_first", count + 1);
  Kokkos::parallel_for(
      "greenwater::wall_push_count", Range(0, count), KOKKOS_LAMBDA(const int i) {
        int number = 0;
        pusher.for_each_group(i, [&](const Group<Dim>&) { ++number; });
        first(i) = number;
      });
  Kokkos::parallel_scan(
      "greenwater::wall_push_first", Range(0, count + 1), KOKKOS_LAMBDA(const int i, int& sum, const bool final) {
        const int number = first(i);
        if (final) first(i) = sum;
        sum += number;
      });
  int number = 0;
  Kokkos::deep_copy(number, Kokkos::subview(first, count));
  Kokkos::View<WallPush*, Device> pushes("greenwater::wall_pushes", number);
  Kokkos::parallel_for(
      "greenwater::wall_pushes", Range(0, count), KOKKOS_LAMBDA(const int i) {
        int at = first(i);
        if (at == first(i + 1)) return;
        const auto gradient = pusher.flow_gradient(i);
        pusher.for_each_group(i, [&](const Group<Dim>& group) { pushes(at++) = pusher.push_of(i, group, gradient); });
      });
  std::vector<WallPush> host(number);
  Kokkos::deep_copy(Kokkos::View<WallPush*, Kokkos::HostSpace>(host.data(), number), pushes);
  return host;
}

}  // namespace

std::vector<WallPush> wall_pushes(const Fluid& fluid, const Survey& survey, int body) {
  if (fluid.rows.images.number.extent(0) == 0) return {};
  return fluid.particles.dim == 2 ? wall_pushes_in<2>(fluid, survey, body) : wall_pushes_in<3>(fluid, survey, body);
}

}  // namespace greenwater
