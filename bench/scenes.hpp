#pragma once
// The scene of all measurements: a column of water that collapses in a tank; in 2-D that of the paper.

#include <string>
#include <vector>

#include "app/scene.hpp"

namespace greenwater::bench {

/// A scene of one size.
struct Size {
  int dim = 2;
  int across = 50;     // particles across the column's width
  double spacing = 0;  // l0 [m]
  double dt = 0;       // [s], in proportion to l0
  int particles = 0;   // of the column
};

/// The size whose column has nearly `particles` of them.
Size size_near(int dim, int particles);

/// Sizes when none are asked for: those of `step` and `pressure`, or all that `scaling` goes over.
std::vector<int> usual_sizes(int dim, bool scaling);

/// Name of the scene in results.
std::string scene_name(int dim);

/// When a state is taken [s]: rest 0.002, early 0.05, collapse 0.15, splash 0.3. Throws CaseError for another name.
double time_of_state(const std::string& name);

/// The case as TOML. `plate` is cut into it: none; plate, low and wet on both sides; barrier, from the bottom to above the
/// water and across the whole tank. Neither has a thickness, and both stand where no lattice and no grid line is.
/// Throws CaseError for another name.
std::string scene_text(const Size& size, const std::string& plate = "none");

/// The same, read; with KEY=VALUE changes. Throws CaseError when a change makes it another size.
Scene bench_scene(const Size& size, const std::vector<std::string>& sets = {}, const std::string& plate = "none");

}  // namespace greenwater::bench
