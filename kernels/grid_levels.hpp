#pragma once
// The levels of the multigrid over a background grid: each has every second node of the finer one, and the matrix
// P^T A P with P the (bi-, tri-) linear interpolation. Stencils of five nodes along each axis stay so.

#include <vector>

#include "kernels/cell_grid.hpp"
#include "kernels/dense_inverse.hpp"
#include "kernels/grid_level.hpp"

namespace greenwater {

constexpr int most_levels = 16;      // enough for 2^15 nodes along an axis
constexpr int coarsest_nodes = 256;  // with fluid: solved directly from here on

/// Levels as kernels take them, by value.
struct LevelStack {
  Level level[most_levels];
  int count = 0;
  // Of the last level: its matrix' inverse, and where its nodes are.
  int unknowns = 0;
  const float* inverse = nullptr;  // (row, column), rows dense_stride(unknowns) apart
  const int* value = nullptr;      // (node) in fields (slot, lane)
  const int* position = nullptr;   // (node)
};

class GridLevels {
 public:
  /// Makes the levels for a grid's cells, whose corners are the nodes of the first; nothing when it has them.
  void resize(const GridShape& grid, int dim);

  /// Which packs of the first level have fluid: to be filled with 1 and 0 before activate().
  const IndexField& wanted() const { return wanted_; }

  /// Takes the packs that are wanted, and those of the coarser levels under them, into use.
  void activate();

  /// From the stencils of the first level all others, the smoothers, and the inverse of the last.
  void coarsen();

  /// One V cycle: y of the first level, from its b and x = relax b.
  void cycle() const;

  const Level& first() const { return stack_.level[0]; }
  const LevelStack& stack() const { return stack_; }
  int dim() const { return dim_; }
  int small() const { return small_; }  // first of the levels that one launch does together

 private:
  struct Fields {
    IndexField slot, pack;
    FloatField stencil, relax, b, x, y;
  };

  void make_level(int l, const int (&nodes)[3]);
  void make_last();
  void grow_values(int l, int slots);
  bool invert_last();

  GridShape grid_;
  int dim_ = 0;
  LevelStack stack_;
  std::vector<Fields> fields_;  // that the stack points to
  IndexField wanted_;
  FloatField inverse_;
  IndexField last_value_, last_position_;
  std::vector<IndexField::host_mirror_type> host_pack_;  // of each level that is small enough to be the last
  std::vector<FloatField::host_mirror_type> host_stencil_;
  IndexField::host_mirror_type host_value_, host_position_;
  FloatField::host_mirror_type host_inverse_;
  std::vector<double> dense_;
  DenseInverse dense_inverse_;
  int levels_ = 0;  // that there are; those of the stack are in use
  int small_ = 0;   // first of the levels that one launch does together
};

}  // namespace greenwater
