#pragma once
// A scene that marches, whatever it holds: step it, and ask it how it is. What a run drives.

#include <memory>
#include <string>
#include <vector>

#include "app/scene.hpp"
#include "core/table.hpp"
#include "core/wall_shape.hpp"
#include "io/step_facts.hpp"
#include "io/vtu.hpp"

namespace greenwater {

/// A structure at one instant.
struct SolidPicture {
  std::string name;
  const SolidMesh* mesh = nullptr;
  SolidFrame frame;
};

/// What a frame shows.
struct Picture {
  std::vector<Table> fluids;     // none or one
  std::vector<WallShape> walls;  // as they stand now
  bool walls_move = false;
  std::vector<SolidPicture> solids;
};

/// What a probe measures: the head of its column.
struct ProbeHead {
  std::string quantity, unit;
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// From t to t + dt. Throws NumericsError when it cannot go on; the state is then that before the step where steps can be
  /// undone, else that of the failed one.
  virtual void step() = 0;
  virtual double time() const = 0;
  virtual std::int64_t steps() const = 0;

  /// The columns of history.csv and of the log's table, and the numbers of the last step for both; notices are handed
  /// out once. The time that a step took comes after them.
  virtual std::vector<std::string> history_header() const = 0;
  virtual std::string thermo_header() const = 0;
  virtual RunFacts run_facts() = 0;

  /// The value of a probe of the scene now; not a number where there is nothing to measure.
  virtual double sample(std::size_t probe) = 0;
  virtual ProbeHead probe_head(std::size_t probe) const = 0;

  virtual Picture picture() const = 0;

  /// What the run will be, for people.
  virtual std::vector<std::string> plan() const = 0;
};

/// The simulation that the scene asks for. Throws CaseError when it cannot be built.
std::unique_ptr<Simulation> make_simulation(const Scene& scene);

}  // namespace greenwater
