#pragma once
// A preconditioner for the pressure whose iterations do not grow with the number of particles: one V cycle with a Jacobi
// sweep on the particles before and after, and between them a correction from the background grid.
//
// A particle's row reaches as far as the largest radius, so a sweep levels all that changes over a cell or less; what is
// left is smooth, and the corners of the cells carry it: P interpolates from them linearly along each axis, P^T A P is
// their matrix, and further levels with every second node each do the rest (kernels/grid_levels.hpp). Everything is
// float, as it only shows the way.

#include "kernels/float_system.hpp"
#include "kernels/grid_levels.hpp"
#include "kernels/preconditioner.hpp"
#include "kernels/split_nodes.hpp"

namespace greenwater {

class Multigrid : public Preconditioner {
 public:
  /// Makes a float copy of the diagonal, and the matrices of all levels. Needs rows with weights.
  void update(const PressureSystem& system) override;
  accum apply(const ScalarField& r, const ScalarField& z) const override;

  const FloatSystem& system() const { return system_; }
  const GridLevels& levels() const { return levels_; }

 private:
  void grow_fields(int dim);

  FloatSystem system_;
  GridLevels levels_;
  SplitNodes splits_;  // where plates are
  GridShape grid_;
  IndexField first_;     // of the grid's cells
  FloatField place_[3];  // (i) of the particles, in cells from the grid's origin [-]; far away at the surface
  FloatField window_;    // (i, node) A P / K at the nodes around the particle's cell
  FloatField cells_;     // (slot, lane, corner, node) of P^T A P / K: what each cell has, corner by corner
  FloatField parts_;     // (slot, corner, lane) of P^T r: what each cell has
  FloatField r_;         // (i) the residual to work on
  FloatField z_;         // (i) what was made of it
  FloatField t_;         // (i) what is left of it
};

}  // namespace greenwater
