#pragma once
// Who is near whom: rows of neighbours and of images, rebuilt every step, as everything has moved (a list that lives
// longer must reach further, and pays for it in every sum). What follows from the distances is summed in the same pass.

#include "kernels/cell_grid.hpp"
#include "kernels/image.hpp"
#include "kernels/rows.hpp"
#include "kernels/weight.hpp"

namespace greenwater {

/// Device view of who is around whom, at the positions that the particles have now.
template <int Dim>
struct Around {
  Read<CoordField> x;
  Rows near;
  ImageRows images;
  Kokkos::View<const Mirror*, Device> mirrors;
  Kokkos::View<const Panel*, Device> panels;
  Kokkos::View<const Joint*, Device> joints;
  GridShape grid;
  real far;   // beyond every radius [m]
  bool kept;  // Itself::weight() may take the weights that stand beside the rows

  using CoordPack = Lanes<coord, pack_lanes>;

  /// Calls f(j, r_ij, image) for every neighbour and every image of the pack of particles from i on, in the same order each
  /// time. r_ij points from each particle to its neighbour or image [m]; `image` is an Itself or an Images. A particle
  /// with fewer neighbours than others of its pack sees some that are too far away to weigh anything.
  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each(int i, F f) const {
    for_each_neighbour(i, f);
    for_each_image(i, f);
  }

  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_neighbour(int i, F f) const {
    const auto xi = load_pack<Dim>(x, i);
    for_each_place(near, i, [&](const int k, const std::int64_t place, const Pack& number) {
      const auto j = load_lanes<IndexPack>(near.index.data() + place);
      auto r = convert_lanes_of<Pack>(way_between(grid, xi, gather_pack<Dim>(x, j)));
      const auto there = number > static_cast<real>(k);
      for (int d = 0; d < Dim; ++d) r[d] = select(there, r[d], all_lanes<Pack>(far));
      Itself<Dim> itself;
      itself.kept = kept;
      if (kept) {
        const auto weight = load_lanes<Lanes<float, pack_lanes>>(near.weight.data() + place);
        itself.weight_kept = zero_unless(there, convert_lanes<Pack>(weight));
      }
      f(j, r, itself);
    });
  }

  /// Where a particle at xj is, or its repetition beside xi.
  KOKKOS_INLINE_FUNCTION Vec<Dim, coord> place_beside(const Vec<Dim, coord>& xi, const Vec<Dim, coord>& xj) const {
    return grid.repeats() ? along(xi, coord(1), way_between(grid, xi, xj)) : xj;
  }

  template <class F>
  KOKKOS_INLINE_FUNCTION void for_each_image(int i, F f) const {
    if (images.number.extent(0) == 0) return;
    const auto xi = load_pack<Dim>(x, i);
    for_each_place(images, i, [&](const int k, const std::int64_t place, const Pack& number) {
      const auto j = load_lanes<IndexPack>(images.index.data() + place);
      const auto xj = gather_pack<Dim>(x, j);
      Images<Dim> image;
      image.kept = kept;
      Vec<Dim, Pack> r;
      for (int d = 0; d < Dim; ++d) r[d] = all_lanes<Pack>(far);
      for (int l = 0; l < pack_lanes; ++l) {
        if (!(k < lane(number, l))) continue;
        const Mirror* m = &mirrors(images.mirror(place + l));
        const auto from = lane_of<Dim, coord>(xi, l), to = place_beside(from, lane_of<Dim, coord>(xj, l));
        const auto way = difference(image_position(*m, to), from);
        for (int d = 0; d < Dim; ++d) set_lane(r[d], l, static_cast<real>(way[d]));
        set_lane(image.share, l, images.share(place + l));
        image.image[l] = {m, panels.data(), joints.data(), to, from};
      }
      f(j, r, image);
    });
  }

 private:
  // Calls f(k, place of entry k, entries that each row has) as long as any row of the pack has an entry.
  template <class AnyRows, class F>
  KOKKOS_INLINE_FUNCTION static void for_each_place(const AnyRows& rows, int i, F f) {
    const auto number = load_lanes<IndexPack>(rows.number.data() + i);
    int most = 0;
    for (int l = 0; l < pack_lanes; ++l) most = larger(most, lane(number, l));
    if (most == 0) return;
    const auto wanted = convert_lanes<Pack>(number);
    auto place = rows.place(i, 0);
    for (int k = 0; k < most; ++k, place += row_lanes) f(k, place, wanted);
  }
};

struct RowOptions {
  Weight density;            // of n
  Weight laplacian;          // whose values stand beside the entries
  coord radius = 0;          // of the search: the largest of all weights; at most the grid's cell [m]
  bool keep_weights = true;  // false: whoever needs a weight computes it; half of the memory
  bool portable = false;     // as on a GPU, also on a host: for comparison
};

class NeighborRows {
 public:
  /// Finds all neighbours and images within the search radius of each particle; on the way n into
  /// particles.number_density. The particles must have been sorted into the grid just before. Capacity grows by itself.
  void build(const Particles& particles, const CellGrid& grid, const MirrorWalls& walls, const RowOptions& options);

  template <int Dim>
  Around<Dim> around(const Particles& particles, const MirrorWalls& walls) const {
    return {particles.position, near, images, walls.mirror, walls.panel, walls.joint, grid_, far_, false};
  }

  /// As around(), where particles are still where they were when the rows were built: then sums with the weight whose
  /// values were kept need not compute it again.
  template <int Dim>
  Around<Dim> around_unmoved(const Particles& particles, const MirrorWalls& walls, const Weight& weight) const {
    auto view = around<Dim>(particles, walls);
    view.kept = near.weight.extent(0) > 0 && weight == kept_;
    return view;
  }

  Rows near;
  ImageRows images;  // without walls: never allocated

 private:
  IndexField total_;
  Kokkos::View<std::int64_t[4], Device> taken_;
  GridShape grid_;
  real far_ = 0;
  Weight kept_;
};

}  // namespace greenwater
