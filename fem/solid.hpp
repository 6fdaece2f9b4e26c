#pragma once
// A deformable body of finite elements: its mass, its forces, its tangent. It has no supports and no loads, and does not
// move by itself.
//
// Unknowns are displacements [m], node by node, dim for each node.

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <array>
#include <memory>
#include <vector>

#include "core/solid_mesh.hpp"
#include "fem/material.hpp"

namespace greenwater {

enum class ElementKind {
  full,            // 2 x 2 (x 2) points, nothing else: too stiff in bending with few layers
  incompatible,    // with the modes 1 - xi^2, condensed in the element: bends right with one layer
  mean_dilatation  // the change of volume is that of the whole element: for nu near 0.5, four layers in bending
};

enum class Kinematics {
  small,            // linear
  corotational,     // linear in a frame that turns with each element: large rotation, strain below some 5 %
  total_lagrangian  // Green's strain: any rotation and strain
};

enum class Plane { strain, stress };  // of a 2-D body

struct SolidOptions {
  ElementKind element = ElementKind::incompatible;
  Kinematics kinematics = Kinematics::corotational;
  Plane plane = Plane::strain;
  double thickness = 1;  // of a 2-D body [m]
};

namespace element {
class Elements;
}

class Solid {
 public:
  /// Throws CaseError for bad material, for options that do not go together, for an element that is inverted or
  /// degenerate, and for a node that no element uses.
  Solid(SolidMesh mesh, const Material& material, const SolidOptions& options = {});
  ~Solid();
  Solid(Solid&&) noexcept;
  Solid& operator=(Solid&&) noexcept;

  const SolidMesh& mesh() const { return mesh_; }
  const Material& material() const { return material_; }
  const SolidOptions& options() const { return options_; }
  int dim() const { return mesh_.dim; }
  int unknowns() const { return dim() * static_cast<int>(mesh_.nodes.size()); }
  /// Whether forces are proportional to displacements.
  bool linear() const { return options_.kinematics == Kinematics::small; }

  /// Lumped by row sums, for each unknown [kg].
  const Eigen::VectorXd& mass() const { return mass_; }
  /// f = dW/du [N], the force that holds the body at u. Allocates nothing. Not for two threads at once on one body.
  void internal_force(const Eigen::VectorXd& u, Eigen::VectorXd& f) const;
  /// W(u) [J].
  double strain_energy(const Eigen::VectorXd& u) const;
  /// d2W/du2 at u [N/m], symmetric, all entries.
  Eigen::SparseMatrix<double> tangent(const Eigen::VectorXd& u) const;
  /// Cauchy's stress at the centres of the elements: xx, yy, zz, xy, yz, zx [Pa].
  std::vector<std::array<double, 6>> stress(const Eigen::VectorXd& u) const;
  /// That of one element.
  std::array<double, 6> stress(const Eigen::VectorXd& u, int element) const;
  /// That at natural coordinates in it, each from -1 to 1 (fem/mesh_place.hpp finds them); incompatible modes included,
  /// so that it goes linearly from face to face of a plate that is one element thick and bends.
  std::array<double, 6> stress(const Eigen::VectorXd& u, int element, const std::array<double, 3>& xi) const;

 private:
  void link_nodes();

  SolidMesh mesh_;
  Material material_;
  SolidOptions options_;
  Eigen::VectorXd mass_;
  std::unique_ptr<element::Elements> elements_;
  // Where in the forces of elements the parts of a node begin: those of node i from first_part_[i] on.
  std::vector<int> first_part_, part_;
};

}  // namespace greenwater
