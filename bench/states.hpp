#pragma once
// States that measurements start from: made by the solver itself, once, and kept in a folder.

#include <filesystem>
#include <string>
#include <vector>

#include "bench/scenes.hpp"

namespace greenwater::bench {

/// All particles at the end of a step, in any order.
struct State {
  int dim = 2;
  std::int64_t steps = 0;        // done since the column stood
  double time = 0;               // [s]
  std::string made_by;           // git state of the program that made it
  std::vector<int> id;           // (i)
  std::vector<double> position;  // (i, axis), as all vectors here [m]
  std::vector<double> velocity;  // [m/s]
  std::vector<double> pressure;  // (i) [Pa]

  int particles() const { return static_cast<int>(id.size()); }
};

/// Throws FileError when it cannot be written, cannot be read or is not such a file.
void write_state(const std::filesystem::path& path, const State& state);
State read_state(const std::filesystem::path& path);

/// --cache, or greenwater/bench in $XDG_CACHE_HOME or ~/.cache; that of the system's temporary files without a home.
std::filesystem::path state_folder(const std::string& wished);

/// The file of a state: its name says the scene, the size, the state, and the version of all of them.
std::filesystem::path state_file(const std::filesystem::path& folder, const Size& size, const std::string& name);

/// Makes those states that are not in the folder, marching on from the latest one there is; prints what it does and how
/// long it will take. Kokkos must be initialised. Throws NumericsError when a step fails.
void make_states(const std::filesystem::path& folder, const Size& size, std::vector<std::string> names);

/// The state from the folder, made first when it is not there.
State state_at(const std::filesystem::path& folder, const Size& size, const std::string& name);

}  // namespace greenwater::bench
