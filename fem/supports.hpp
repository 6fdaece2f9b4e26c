#pragma once
// Where a structure is held, and how what holds it moves.

#include <Eigen/Geometry>
#include <Eigen/Sparse>
#include <functional>
#include <vector>

#include "core/solid_mesh.hpp"

namespace greenwater {

/// Unknowns whose displacement is given: that at the start, or that of a motion.
struct Supports {
  struct Motion {
    std::vector<int> unknowns;
    /// Writes their displacements [m] at a time [s] among those of all unknowns.
    std::function<void(double, Eigen::VectorXd&)> displacement;
  };

  std::vector<int> held;  // unknowns, ascending, each once, those of the motions too
  std::vector<Motion> motions;
};

/// Holds nodes along all axes.
void clamp(Supports& supports, int dim, const std::vector<int>& nodes);

/// Holds nodes along one axis: a plane of symmetry, or plane strain.
void hold(Supports& supports, int dim, const std::vector<int>& nodes, int axis);

/// Moves nodes along one axis.
void move(Supports& supports, int dim, const std::vector<int>& nodes, int axis,
          std::function<double(double)> displacement);

/// Moves nodes along all axes as parts of a rigid body, which `motion` takes from its place at rest to that at a time [s]:
/// x(t) = motion(t) x(0) [m].
void follow(Supports& supports, const SolidMesh& mesh, const std::vector<int>& nodes,
            std::function<Eigen::Affine3d(double)> motion);

/// The unknowns among `count` that are not held, ascending.
std::vector<int> free_unknowns(const Supports& supports, int count);

/// The rows and columns of `chosen`, ascending.
Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& matrix, const std::vector<int>& chosen);

}  // namespace greenwater
