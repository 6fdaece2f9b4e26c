#pragma once
// The first level's splits: which particles are on their side, and what goes from these to them and back.

#include "kernels/float_system.hpp"
#include "kernels/split_level.hpp"

namespace greenwater {

/// Device view of the particles and of which side they are on.
struct Sides {
  Seats seats;
  Rows rows;
  Read<FloatField> diagonal;
  IndexField side;  // (particle) bit c: it is on the side of the split of corner c of its cell
};

/// Where the particles around a node are not all connected, marks those that are not in the cluster that has at least half
/// of the node: its split stands for them, so that it is the smaller part.
template <int Dim>
void find_sides(const Sides& sides, const Level& level, const Splits& splits);

/// Rows of the first level's matrix that belong to splits: sums over the particles on their side.
template <int Dim>
void make_first_rows(const Sides& sides, const Level& level, const Splits& splits);

/// b of the splits from the particles' residual t.
template <int Dim>
void restrict_to_splits(const Seats& seats, const IndexField& side, const Level& level, const Splits& splits,
                        const FloatField& t);

/// Adds the splits' values to z of the particles in the given cells.
template <int Dim>
void prolong_from_splits(const Seats& seats, const IndexField& side, const IndexField& cells, int count,
                         const Level& level, const Splits& splits, const FloatField& z);

}  // namespace greenwater
