#pragma once
// What the fluid and walls that are no structures do to each other beyond the survey: the force of the fluid on a body (its
// reaction), and the volume that a body sweeps.

#include <array>
#include <map>
#include <vector>

#include "kernels/operators/swept_volume.hpp"

namespace greenwater {

/// Whether a wall moves that is no structure's, or begins to.
bool rigid_walls_move(const WallFaces& walls);

class RigidWalls {
 public:
  /// Asks for the reaction of a body; returns its number among those that were asked for.
  int watch(int body);
  bool any_watched() const { return !watched_.empty(); }

  /// After a survey that has kept its divergence_correction: walls that move go into the source.
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
