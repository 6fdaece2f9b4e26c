#pragma once
// The wet surface of a structure as walls of the fluid: where its corners are, how they move, and what the forces on them
// are on the nodes. Forces go back the way displacements came, so that they do the same work on either side.

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <vector>

#include "core/solid_mesh.hpp"
#include "core/wall_faces.hpp"

namespace greenwater {

class WetSurface {
 public:
  /// Facets of the mesh as walls: in a 2-D fluid the sides of quadrilaterals, or those of hexahedra that go through the
  /// width along z, seen along z; in a 3-D fluid the sides of hexahedra, two triangles each. A corner is a node, or of a
  /// width all nodes that share their x and y at rest, in their mean over the width. In a 2-D fluid `depth` [m] is how deep a structure
  /// of quadrilaterals is; that of hexahedra is their width.
  /// Throws CaseError when a facet is not along the width of a 2-D fluid's structure, and when there is none.
  WetSurface(const SolidMesh& mesh, const std::vector<Facet>& facets, int fluid_dim, double depth = 1);

  int corners() const { return static_cast<int>(rest_.size()); }
  int fluid_dim() const { return fluid_dim_; }
  /// The normals of the faces times this point out of the solid.
  static double outward(int fluid_dim) { return fluid_dim == 2 ? -1 : 1; }
  /// How deep a 2-D structure is: what turns forces per metre into forces [m]; 1 in 3-D.
  double depth() const { return depth_; }

  /// Where the corners are at rest [m].
  const std::vector<std::array<double, 3>>& rest() const { return rest_; }
  /// The faces at rest, of that body; corners of faces are in no order of their own.
  std::vector<WallFace> faces(int body) const;
  /// Which corner each corner of each face is.
  const std::vector<std::array<int, 3>>& corner_of_face() const { return faces_; }

  /// Of every corner, fluid_dim numbers each: displacements [m] (or velocities, ...) from those of all nodes.
  Eigen::VectorXd at_corners(const Eigen::VectorXd& at_nodes) const { return mean_ * at_nodes; }
  /// Forces on all nodes [N] from those on corners, per metre of depth in 2-D [N/m].
  Eigen::VectorXd on_nodes(const Eigen::VectorXd& on_corners) const {
    return depth_ * (mean_.transpose() * on_corners);
  }
  /// How the surface has turned at each corner, as a rotation (fluid_dim x fluid_dim), from the corners' displacements: the
  /// one nearest to the mean of the faces that meet there.
  std::vector<Eigen::MatrixXd> turn_of_corners(const Eigen::VectorXd& displacement) const;
  /// The matrix of at_corners(): (fluid_dim corners x unknowns).
  const Eigen::SparseMatrix<double>& mean() const { return mean_; }

 private:
  int fluid_dim_;
  double depth_;
  std::vector<std::array<double, 3>> rest_;  // corners [m]
  std::vector<std::array<int, 3>> faces_;    // 2-D: the first two
  Eigen::SparseMatrix<double> mean_;
};

/// All outer facets but those of these parts (where it is clamped, or its sides in a 2-D fluid).
std::vector<Facet> outer_facets_without(const SolidMesh& mesh, const std::vector<std::string>& parts);

}  // namespace greenwater
