#pragma once
// What must be moved between memory and processor in each region of a step, counted from the fields that its kernels
// read and write. Compulsory traffic: within one kernel every entry of a field is counted once, as if the cache held all
// that is used again; from kernel to kernel nothing is taken to stay.

#include <string>
#include <vector>

namespace greenwater::bench {

/// What a step works on. Numbers are means over the measured steps, so they need not be whole.
struct Counts {
  int dim = 2;
  double particles = 0;
  double cells = 0;          // of the grid
  double entries = 0;        // neighbours
  double places = 0;         // of the operator's rows: neighbours, images and fillers
  double image_entries = 0;  // images
  double image_places = 0;   // with fillers
  bool walls = true;         // there are rows of images, be they empty
  bool keep_weights = true;
  bool multigrid = false;      // the preconditioner of the pressure; else the diagonal
  double iterations = 0;       // of the pressure solve
  double first_nodes = 0;      // of the multigrid's first level, as far as they are in use
  double nodes = 0;            // of all levels
  double collision_finds = 0;  // searches for those that are close
  double collision_looks = 0;  // sweeps that count collisions ...
  double collision_moves = 0;  // ... and those that found some
};

struct Traffic {
  double moved = 0;    // [bytes]
  double touched = 0;  // size of all fields that are used: the working set [bytes]
};

/// A row in the table of a step. `inside` is the region that holds it; empty for the step itself.
struct RegionModel {
  std::string name, inside;
  Traffic (*traffic)(const Counts&);
};

/// The regions that are known, in the order of the step. One line in bytes.cpp for each.
const std::vector<RegionModel>& region_models();

/// A p once, with weights kept beside the rows or computed from the positions.
Traffic product_traffic(const Counts& counts, bool keep_weights);

}  // namespace greenwater::bench
