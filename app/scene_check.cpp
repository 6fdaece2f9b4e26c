// How the parts of a scene fit together.

#include <algorithm>
#include <array>
#include <cmath>

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

constexpr std::array axis_name{"x", "y", "z"};

struct Check {
  const Scene& scene;
  std::size_t axes = static_cast<std::size_t>(scene.dimension);
  double slack = 1e-6 * scene.mps.spacing;  // round-off of typed numbers

  bool inside(const Point& point, const Point& min, const Point& max) const {
    for (std::size_t d = 0; d < axes; ++d) {
      if (point[d] < min[d] - slack || point[d] > max[d] + slack) return false;
    }
    return true;
  }
};

void check_fluid_size(const Check& check) {
  const FluidCase& fluid = check.scene.fluid;
  const double spacing = check.scene.mps.spacing;
  for (std::size_t d = 0; d < check.axes; ++d) {
    const double width = fluid.max[d] - fluid.min[d];
    require_at(fluid.place, width >= spacing - check.slack, "the fluid is empty: its region is ", width, " m wide in ",
               axis_name[d], ", less than one mps.spacing = ", spacing,
               " m; enlarge the region or take a smaller spacing");
  }
}

void check_fluid_in_tank(const Check& check) {
  const Scene& scene = check.scene;
  const FluidCase& fluid = scene.fluid;
  if (scene.boxes.empty()) return;
  const bool held = std::any_of(scene.boxes.begin(), scene.boxes.end(), [&](const BoxCase& box) {
    return check.inside(fluid.min, box.min, box.max) && check.inside(fluid.max, box.min, box.max);
  });
  const BoxCase& first = scene.boxes.front();
  require_at(fluid.place, held, "the fluid reaches out of the box \"", first.name, "\" from ",
             toml_point(first.min, scene.dimension), " to ", toml_point(first.max, scene.dimension),
             " m; shrink the region or enlarge the box");
}

/// A plate stands in a box or on its side; its tip may leave through an open side.
bool plate_fits(const Check& check, const PlateCase& plate, const BoxCase& box) {
  if (!check.inside(plate.base, box.min, box.max)) return false;
  const Point tip{plate.base[0] + plate.height * std::sin(plate.angle),
                  plate.base[1] + plate.height * std::cos(plate.angle), 0};
  const auto open = [&](const char* side) {
    return std::find(box.open.begin(), box.open.end(), side) != box.open.end();
  };
  const double slack = check.slack;
  return (tip[0] >= box.min[0] - slack || open("left")) && (tip[0] <= box.max[0] + slack || open("right")) &&
         (tip[1] >= box.min[1] - slack || open("bottom")) && (tip[1] <= box.max[1] + slack || open("top"));
}

void check_plates(const Check& check) {
  const Scene& scene = check.scene;
  if (scene.boxes.empty()) return;
  for (const PlateCase& plate : scene.plates) {
    const bool held = std::any_of(scene.boxes.begin(), scene.boxes.end(),
                                  [&](const BoxCase& box) { return plate_fits(check, plate, box); });
    const BoxCase& first = scene.boxes.front();
    require_at(plate.place, held, "the plate \"", plate.name, "\" from its base ",
               toml_point(plate.base, scene.dimension), " m, ", plate.height, " m high, is not inside the box \"",
               first.name, "\" from ", toml_point(first.min, scene.dimension), " to ",
               toml_point(first.max, scene.dimension), " m");
  }
}

void check_domain(const Check& check) {
  const Scene& scene = check.scene;
  if (!scene.has_domain) return;
  const bool held = check.inside(scene.fluid.min, scene.domain_min, scene.domain_max) &&
                    check.inside(scene.fluid.max, scene.domain_min, scene.domain_max);
  require_at(scene.domain_place, held,
             "the fluid reaches out of [domain]: particles there would be taken out at once; ", "enlarge the domain");
}

}  // namespace

void check_scene(const Scene& scene) {
  const Check check{scene};
  check_fluid_size(check);
  check_fluid_in_tank(check);
  check_plates(check);
  check_domain(check);
}

}  // namespace greenwater
