#pragma once
// The multigrid's second values where plates stand between particles (see split_level.hpp), on all levels.

#include "kernels/cut_cells.hpp"
#include "kernels/float_system.hpp"
#include "kernels/fluid.hpp"
#include "kernels/grid_levels.hpp"
#include "kernels/split_level.hpp"

namespace greenwater {

/// Splits as kernels take them, by value.
struct SplitStack {
  Splits level[most_levels];
  // Of the last level: its matrix' inverse, and which splits are in it.
  int last_count = 0;
  const float* inverse = nullptr;  // (row, column) nodes, then splits; rows dense_stride() apart
  const int* last = nullptr;       // numbers
};

class SplitNodes {
 public:
  /// Finds the nodes that walls with water on both sides split, and what the matrices of all levels say about them.
  /// Where there are no such walls: no launch, no memory.
  void update(const Fluid& fluid, const Seats& seats, const FloatSystem& system, const GridLevels& levels);

  /// Whether any node may be split: then cycle() takes the place of that of the levels.
  bool any() const { return !nodes_.empty(); }

  /// b of the first level's splits from the particles' residual t.
  void restrict_particles(const Seats& seats, const GridLevels& levels, const FloatField& t) const;

  /// As GridLevels::cycle(), with the splits.
  void cycle(const GridLevels& levels) const;

  /// Adds to z of the particles what the splits say.
  void prolong_to_particles(const Seats& seats, const GridLevels& levels, const FloatField& z) const;

 private:
  using Nodes = std::vector<std::array<int, 3>>;
  struct Fields {
    IndexField number, at, near_at, under_at;
    FloatField to_nodes, to_splits, from_nodes, from_splits;
    FloatField relax, relax_rest, b, e, left;
  };

  void arrange(const GridLevels& levels);
  void invert_last(const LevelStack& stack);
  void place(int l, const Level& level, const Nodes& nodes, int dim);

  CutCells cut_;
  GridShape grid_;
  int dim_ = 0;
  int levels_ = 0;  // that have their lists
  Nodes nodes_;     // of the first level that may be split
  SplitStack stack_;
  std::vector<Fields> fields_;  // that the stack points to
  IndexField side_;             // (particle) bit c: it is on the split's side of corner c of its cell
  IndexField cells_;            // around the nodes
  int cells_count_ = 0;
  IndexField last_;
  FloatField inverse_;
  FloatField::host_mirror_type host_inverse_;
  std::vector<double> dense_;
  DenseInverse dense_inverse_;
};

}  // namespace greenwater
