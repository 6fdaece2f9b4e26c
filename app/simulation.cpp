#include "app/simulation.hpp"

#include "app/fluid_simulation.hpp"
#include "app/structure_simulation.hpp"

namespace greenwater {

std::unique_ptr<Simulation> make_simulation(const Scene& scene) {
  if (!scene.has_fluid) return std::make_unique<StructureSimulation>(scene);
  return std::make_unique<FluidSimulation>(scene);
}

}  // namespace greenwater
