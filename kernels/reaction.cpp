#include "kernels/reaction.hpp"

#include <cmath>

#include "kernels/small_matrix.hpp"

namespace greenwater {
namespace {

template <int Dim>
std::array<double, 3> wall_reaction_in(const Fluid& fluid, const Survey& survey, int body) {
  const auto w = fluid.gradient.weight;
  const auto near = around_unmoved<Dim>(fluid, w);
  const auto p = Read<ScalarField>(fluid.particles.pressure);
  const auto correction = Read<VectorField>(survey.divergence_correction);
  const auto fixed = Read<FlagField>(survey.fixed);
  const coord touching = 1e-12 * fluid.spacing * fluid.spacing;
  const accum scale = 2 * std::pow(fluid.spacing, Dim) / fluid.gradient.reference.n0;
  accum fx = 0, fy = 0, fz = 0;
  Kokkos::parallel_reduce(
      "greenwater::wall_reaction", Range(0, fluid.particles.count),
      KOKKOS_LAMBDA(const int i, accum& sum_x, accum& sum_y, accum& sum_z) {
        const int number = near.images.number(i);
        if (number == 0 || fixed(i)) return;
        const auto xi = load<Dim>(near.x, i);
        Symmetric<Dim, coord> C;
        for (int k = 0; k < Symmetric<Dim, coord>::size; ++k) C.c[k] = correction(i, k);
        Vec<Dim, coord> force{};
        for (int k = 0; k < number; ++k) {
          const auto place = near.images.place(i, k);
          const Mirror& mirror = near.mirrors(near.images.mirror(place));
          const auto xj = load<Dim>(near.x, near.images.index(place));
          const auto r = difference(image_position(mirror, xj), xi);
          const coord r2 = dot(r, r);
          if (!(r2 > touching)) continue;
          real weight = near.images.share(place) * w(static_cast<real>(sqrt(r2)));
          if (near.kept) weight = static_cast<float>(weight);  // as the divergence had it
          const Image<Dim> image{&mirror, near.panels.data(), near.joints.data(), {}};
          auto pull = product(C, r);
          image.for_each_wall_backwards([&](const Panel& wall) {
            const auto n = Sight<Dim>::as_vec(wall.normal);
            const coord along_n = dot(pull, n);
            if (wall.body == body) force = along(force, weight / r2 * along_n, n);
            pull = along(pull, -2 * along_n, n);
          });
        }
        sum_x += p(i) * force[0];
        sum_y += p(i) * force[1];
        if (Dim == 3) sum_z += p(i) * force[Dim - 1];
      },
      fx, fy, fz);
  return {scale * fx, scale * fy, scale * fz};
}

}  // namespace

std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body) {
  if (fluid.rows.images.number.extent(0) == 0) return {};
  return fluid.particles.dim == 2 ? wall_reaction_in<2>(fluid, survey, body) : wall_reaction_in<3>(fluid, survey, body);
}

}  // namespace greenwater
