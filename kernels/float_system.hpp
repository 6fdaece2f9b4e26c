#pragma once
// What the parts of the multigrid share: the pressure system in float, and the particles' places in the grid.

#include "kernels/cell_grid.hpp"
#include "kernels/rows.hpp"

namespace greenwater {

/// The pressure system over K in float. Rows of particles at the surface are left out: zero in and out.
struct FloatSystem {
  int count = 0;
  float per_K = 1;  // 1 / K [m^2]
  Rows rows;
  FloatField diagonal;  // (i) A_ii / K [-]; 0 where the surface is and beyond the last particle
  FloatField inverse;   // (i) 1 over that, and 0
};

constexpr float far_away = 1e6f;  // [cells]

/// Device view of the particles in the grid.
struct Seats {
  int count;
  GridShape grid;
  Read<IndexField> first;
  Read<FloatField> place[3];  // (i) in cells from the grid's origin [-]; far away at the surface
};

}  // namespace greenwater
