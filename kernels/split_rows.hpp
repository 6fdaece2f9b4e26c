#pragma once
// What the levels' matrices say about splits, from level to level.

#include "kernels/split_level.hpp"

namespace greenwater {

/// What the functions of a level's splits are made of: where the finer nodes and splits under a node are not all connected
/// by their matrix, its split stands for those that are not in the larger cluster.
template <int Dim>
void find_coarse_sides(const Level& fine, const Splits& from, const Level& coarse, const Splits& splits);

/// P^T A P for the rows of a coarser level's splits.
template <int Dim>
void make_coarse_rows(const Level& fine, const Splits& from, const Level& coarse, const Splits& splits);

/// As that of the nodes, for both sides of each node that is split. The two have nothing to do with each other.
template <int Dim>
void weigh_smoother(const Level& level, const Splits& splits);

}  // namespace greenwater
