#pragma once
// Whole runs in tests: a case of cases/, marched with an eye on walls and energy.

#include <cmath>

#include "app/fluid_simulation.hpp"
#include "core/interior.hpp"
#include "tests/support.hpp"

namespace greenwater::test {

inline Scene scene_of(const std::string& path, const std::vector<std::string>& settings = {}) {
  std::vector<CaseOption> options;
  for (const auto& setting : settings) options.push_back(set_option(setting));
  CaseFile file(std::string(GREENWATER_SOURCE_DIR) + "/cases/" + path, options);
  return read_scene(file);
}

/// The same with the default scheme in place of the classic one.
inline Scene with_default_scheme(Scene scene) {
  scene.mps.scheme = "default";
  scene.mps.kernel = "standard";
  scene.collision.clear();
  return scene;
}

/// Places of all particles now.
inline std::vector<Point> places_of(const FluidSimulation& simulation) {
  const auto x = host(simulation.fluid().particles.position);
  std::vector<Point> places(simulation.fluid().particles.count);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (int d = 0; d < simulation.fluid().particles.dim; ++d) places[i][d] = x(i, d);
  return places;
}

inline Point centroid_of(const FluidSimulation& simulation) {
  Point sum{};
  const auto places = places_of(simulation);
  for (const auto& x : places)
    for (int d = 0; d < 3; ++d) sum[d] += x[d] / static_cast<double>(places.size());
  return sum;
}

/// A run with what has to hold in every one: the energy's largest rise over its lowest value so far, and nobody outside.
struct Watched {
  /// `outside` says whether a particle at a place has crossed a wall.
  Watched(const Scene& scene, std::function<bool(const Point&)> is_outside)
      : simulation(scene), crossed(std::move(is_outside)) {
    lowest = simulation.facts().energy_ratio;
  }

  void step() {
    simulation.step();
    if (simulation.steps() % 10 != 0) return;
    const StepFacts facts = simulation.facts();
    for (const Notice& notice : facts.notices)
      if (notice.kind == "crossing") stopped += notice.count;
    energy = facts.energy_ratio;
    lowest = std::min(lowest, energy);
    gain = std::max(gain, energy - lowest);
    fastest = std::max(fastest, facts.max_speed);
    lost = facts.lost;
    const auto places = places_of(simulation);
    outside += std::count_if(places.begin(), places.end(), crossed);
  }

  void march(double end) {
    while (simulation.time() < end * (1 - 1e-9)) step();
  }

  FluidSimulation simulation;
  std::function<bool(const Point&)> crossed;
  double lowest = 0, energy = 0, gain = 0, fastest = 0;
  std::int64_t stopped = 0, outside = 0, lost = 0;
};

/// The level at which the inside has its centroid at `height` when it is filled up to there.
inline coord level_of(const Interior& inside, coord height) {
  const int up = inside.dimension() - 1;
  const coord bottom = inside.bounds().low[up], top = inside.bounds().high[up];
  const auto centroid = [&](coord level) {  // of what is below: level - integral of volume / volume
    constexpr int slices = 400;
    coord sum = 0;
    for (int k = 0; k < slices; ++k) sum += inside.measure_below(bottom + (level - bottom) * (k + 0.5) / slices);
    return level - sum * (level - bottom) / slices / inside.measure_below(level);
  };
  coord low = bottom + 1e-3 * (top - bottom), high = top;
  for (int k = 0; k < 50; ++k) {
    const coord middle = (low + high) / 2;
    (centroid(middle) < height ? low : high) = middle;
  }
  return low;
}

}  // namespace greenwater::test
