#pragma once
// What the fluid and walls that are no structures do to each other beyond the survey: the force of the fluid on a body (its
// reaction), and the volume that a body sweeps.

#include <algorithm>
#include <array>
#include <map>
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
/// A row far from its wall brings up several times its own part. The pressure solve knows nothing of that but where the wall is
/// a structure's, and overshoots from step to step: Share::at_most_own makes W_kq smaller where their sum is more than P_k.
class SweptVolume {
 public:
  enum class Share { whole, at_most_own };
  template <class Speed>
  void gather(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature, Share share, Speed speed) {
    for (const WallPush& push : pushes) {
      const Triple seen = difference(speed(push.face, push.place), flow_at(push, push.from_particle));
      double swept = 0, part = 0;
      quadrature.for_each(push, [&](int q, const Triple& from_particle, double weight) {
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

/// Whether a wall moves that is no structure's, or begins to.
bool rigid_walls_move(const WallFaces& walls);

class RigidWalls {
 public:
  /// Asks for the reaction of a body; returns its number among those that were asked for.
  int watch(int body);
  bool any_watched() const { return !watched_.empty(); }

  /// After a survey that has kept its divergence_correction: walls that move go into the source.
  /// With `whole` shares the work of the reactions is that of the fluid's pressure; a run has the others, which are stable.
  void join(const Fluid& fluid, const Survey& survey, const ScalarField& rhs, real dt,
            SweptVolume::Share share = SweptVolume::Share::at_most_own);

  /// After the pressure solve: forces on the bodies that are watched [N/m], in 3-D [N], of the pressure at the wall,
  ///   p_i + rho (g - a_w) . (x_q - x_i)
  /// at every place. In the order of watch().
  std::vector<std::array<double, 3>> reactions(const Fluid& fluid);

 private:
  struct Body {
    WallQuadrature quadrature;
    bool made = false;
  };
  WallQuadrature& quadrature_of(const Fluid& fluid, int body, bool moves);
  void add_rows(const Fluid& fluid, const std::vector<WallPush>& pushes, const WallQuadrature& quadrature, int number);

  std::vector<int> watched_;
  std::map<int, Body> bodies_;
  SweptVolume swept_;
  std::vector<AddedEntry> rows_;              // (particle, dim number + d) force per pressure
  std::vector<std::array<double, 3>> known_;  // part of the forces that does not wait for the pressure
  AddedTerm term_;
  ScalarField felt_;
};

/// The force on one body, at rest or with the velocities that its faces have.
std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body);

}  // namespace greenwater
