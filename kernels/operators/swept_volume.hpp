#pragma once
// What walls sweep of the fluid, a structure's or others, beyond what the survey has seen of them.

#include <algorithm>
#include <vector>

#include "kernels/added_term.hpp"
#include "kernels/operators/wall_quadrature.hpp"

namespace greenwater {

/// Adds to the source of the pressure, -(rho / dt) div, what the places of a surface sweep beyond what its images have told
/// the survey: for each push
///
///   sum_q W_kq n_q . (v(x_q) - u(x_q)) - P_k n_k . (v(x_k) - u(x_k))
///
/// over V, with the velocity u of the fluid there (flow_at()). Where fluid and wall move together, both parts are 0.
/// `speed(face, x)` gives v, the velocity of a wall.
///
/// A row far from its wall brings up several times its own part, as do the few particles that a jet first brings to a wall.
/// The images, with which pressure answers, have P_k: more than that overshoots from step to step. Share::at_most_own makes
/// W_kq smaller where their sum is more than P_k. With Share::whole the power of the walls is that of the pressure, exactly.
class SweptVolume {
 public:
  enum class Share { whole, at_most_own };
  template <class Speed>
  void gather(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature, Speed speed,
              Share share = Share::at_most_own) {
    for (std::size_t k = 0; k < pushes.size(); ++k) {
      const WallPush& push = pushes[k];
      const Triple seen = difference(speed(push.face, push.place), flow_at(push, push.from_particle));
      double swept = 0, part = 0;
      quadrature.for_each(k, [&](int q, const Triple& from_particle, double weight) {
        const QuadraturePoint& point = quadrature.points()[q];
        swept += weight * dot(point.normal, difference(speed(point.face, point.place), flow_at(push, from_particle)));
        part += weight;
      });
      if (share == Share::at_most_own && part > std::max(push.area, 0.0)) swept *= std::max(push.area, 0.0) / part;
      swept -= push.area * dot(push.normal, seen);
      if (swept != 0) entries_.push_back({push.particle, 0, static_cast<real>(swept)});
    }
  }
  /// b += factor (what was gathered) where nothing is fixed; and begins anew.
  void add_to(const ScalarField& b, const FlagField& fixed, real factor);

 private:
  std::vector<AddedEntry> entries_;
  AddedTerm term_;
  ScalarField one_;
};

/// div(u) per swept volume, in the source: -(rho / dt) / V, V = l0^d.
real source_per_volume(const Fluid& fluid, double dt);

}  // namespace greenwater
