// Whether a scene without fluid makes sense.

#include <algorithm>
#include <cmath>

#include "app/motion.hpp"
#include "app/scene_shape.hpp"

namespace greenwater {
namespace {

/// Whether the structure moves with this geometry, or may touch it.
bool names(const StructureCase& structure, const std::string& name) {
  if (structure.contact) {
    const auto& walls = structure.contact->walls;
    if (std::find(walls.begin(), walls.end(), name) != walls.end()) return true;
  }
  return std::any_of(structure.supports.begin(), structure.supports.end(),
                     [&](const SupportCase& support) { return support.with == name; });
}

}  // namespace

void check_scene_alone(const Scene& scene) {
  for (const Shape& shape : shapes_of(scene)) {
    const GeometryCase& geometry = *shape.geometry;
    const bool used = std::any_of(scene.structures.begin(), scene.structures.end(),
                                  [&](const StructureCase& s) { return names(s, geometry.name); });
    require_at(
        geometry.place, used, "[geometry.", geometry.name,
        "] is about fluid, and there is no [[fluid]]: delete it, or name it where it has to do with a structure: "
        "walls of [structure.contact], with of [[structure.support]]");
    if (!geometry.motion) continue;
    require_motion(geometry);
    const LongestStep longest = longest_step(Motion(*geometry.motion), scene.end, scene.step, reach_of(shape));
    require_at(geometry.motion->place, std::isfinite(longest.way), "the motion of \"", geometry.name,
               "\" is no finite number after t = ", longest.time, " s; mend the formula, or end the run before");
  }
}

}  // namespace greenwater
