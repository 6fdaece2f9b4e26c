#pragma once
// Bodies and meshes for the tests of structures.

#include <Eigen/Dense>
#include <functional>
#include <string>
#include <vector>

#include "core/solid_mesh.hpp"
#include "fem/solid.hpp"

namespace greenwater::test {

using Vector = Eigen::VectorXd;
using Place = std::array<double, 3>;

constexpr ElementKind all_kinds[] = {ElementKind::full, ElementKind::incompatible, ElementKind::mean_dilatation};
constexpr Kinematics all_kinematics[] = {Kinematics::small, Kinematics::corotational, Kinematics::total_lagrangian};

/// A box of 3 x 2 (x 2) elements whose inner nodes are moved by up to `shift` of a spacing.
SolidMesh distorted_box(int dim, double shift);

/// The same with its outer nodes moved too.
SolidMesh crooked_box(int dim, double shift);

/// Displacement of all nodes, from that at a place [m].
Vector displacement_of(const SolidMesh& mesh, const std::function<Place(const Place&)>& u);

/// Numbers between -size and size, the same at every call.
Vector random_vector(int count, double size);

/// Nodes of a part that the mesh must have.
const std::vector<int>& nodes_of_part(const SolidMesh& mesh, const std::string& name);

}  // namespace greenwater::test
