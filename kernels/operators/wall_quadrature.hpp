#pragma once
// Places all over a surface, at which the pushes of particles (wall_pushes.hpp) become a load. How much of a wall one push
// stands for depends on how the particles lie; so each place of the surface is given to the pushes round it in parts that make
// up the whole of its area (a partition of unity):
//
//   W_kq = P_k psi_kq A_q / max(sum_k' P_k' psi_k'q, least sum_q' A_q' psi_q'q)     psi = (1 - |x_k - x_q|^2 / R^2)^2
//
// over pushes and places that look the same way (n_k . n_q > 0.7), of the area P_k. Distances out of the plane of the place
// count twice, so that no other wall that looks the same way has a part. So a constant pressure p gives the force p A_q at
// every place that is covered, and nowhere more; at the edge of the water, and under spray, the load fades out.

#include <vector>

#include "kernels/operators/wall_pushes.hpp"

namespace greenwater {

/// A part of a face.
struct QuadraturePoint {
  int face = 0;       // among all walls
  Triple shares{};    // of the face's corners
  double part = 0;    // of the face's area
  double area = 0;    // A [m], in 3-D [m^2]
  Triple place{};     // x_q [m]
  Triple normal{};    // n_q, unit, into the wall
  double around = 0;  // sum_q' A_q' psi_q'q at the start
};

enum class WetSide { against_normal, along_normal, both };  // of a face, on which the fluid is

class WallQuadrature {
 public:
  WallQuadrature() = default;
  /// Of these faces, with the fluid on that side of them; `spacing` l0 [m]. Where space repeats itself, faces stand once.
  WallQuadrature(const WallFaces& walls, const std::vector<int>& faces, WetSide wet, const GridShape& grid,
                 double spacing);

  /// The faces have moved.
  void move_to(const WallFaces& walls);
  /// For the pushes as they are now. What each gives to each place is kept until the next call.
  void weigh(const std::vector<WallPush>& pushes);

  const std::vector<QuadraturePoint>& points() const { return points_; }
  /// sum_k P_k psi_kq over that of the surface itself: the place counts as covered from least_cover on.
  double cover(int q) const { return sum_[q] / points_[q].around; }
  static constexpr double least_cover = 0.2;

  /// Calls f(place, x_q - x_i, W_kq) for each place that takes a part of the push with this number in weigh().
  template <class F>
  void for_each(std::size_t push, F f) const {
    for (std::size_t k = first_given_[push]; k < first_given_[push + 1]; ++k)
      f(given_[k].place, given_[k].from_particle, given_[k].weight);
  }

 private:
  template <class F>
  void for_each_near(const Triple& place, const Triple& normal, F f) const;
  void sort_into_cells();
  int cell_along(int axis, double x) const;

  int dim_ = 2;
  double radius_ = 0;  // R [m]
  double turned_ = 1;  // sign of the faces' normals
  bool both_ = false;
  struct Given {
    int place;
    double weight;         // W_kq
    Triple from_particle;  // x_q - x_i
  };

  std::vector<QuadraturePoint> points_;
  std::vector<double> sum_;
  std::vector<Given> given_;  // of all pushes, one after the other
  std::vector<std::size_t> first_given_;
  std::vector<Triple> periods_;  // by which a push is moved to be beside a place; the first one is 0
  Triple low_{}, high_{};        // of the places [m]
  double cell_ = 1;              // [m]
  int cells_[3] = {1, 1, 1};
  std::vector<int> first_, order_;  // of each cell
};

template <class F>
void WallQuadrature::for_each_near(const Triple& place, const Triple& normal, F f) const {
  constexpr double alike = 0.7, off_plane = 3;
  const double per_radius2 = 1 / (radius_ * radius_);
  for (const Triple& period : periods_) {
    const Triple at = sum(place, period);
    int from[3] = {0, 0, 0}, to[3] = {0, 0, 0};
    bool there = true;
    for (int d = 0; d < dim_; ++d) {
      there = there && at[d] > low_[d] - radius_ && at[d] < high_[d] + radius_;
      if (!there) break;
      from[d] = cell_along(d, at[d] - radius_);
      to[d] = cell_along(d, at[d] + radius_);
    }
    if (!there) continue;
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y) {
        const int row = (z * cells_[1] + y) * cells_[0];
        for (int k = first_[row + from[0]]; k < first_[row + to[0] + 1]; ++k) {
          const int q = order_[k];
          const QuadraturePoint& point = points_[q];
          const Triple way = difference(point.place, at);
          const double off = dot(way, point.normal);
          const double rest = 1 - (dot(way, way) + off_plane * off * off) * per_radius2;
          if (rest > 0 && dot(point.normal, normal) > alike) f(q, way, rest * rest);
        }
      }
  }
}

}  // namespace greenwater
