#include "bench/scenes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "io/suggest.hpp"

namespace greenwater::bench {
namespace {

constexpr double seconds_per_metre = 0.115;  // dt / l0 of the paper

// Column: 0.2 x 0.4 m of water in 2-D, 0.3 x 0.3 x 0.33 m in 3-D.
constexpr double width_2d = 0.2, width_3d = 0.3;

int column(int dim, int across) {
  if (dim == 2) return across * 2 * across;
  const int up = static_cast<int>(std::floor(1.1 * across + 1e-6));
  return across * across * up;
}

// {0}: spacing, {1}: time step
constexpr const char* text_2d = R"(format = 1
[case]
name = "dam_break_2d"
dimension = 2
[time]
end = 1.0
[geometry.tank]
type = "box"
min = [0.0, 0.0]
max = [0.8, 0.6]
open = ["top"]
[[fluid]]
region = {{ type = "box", min = [0.0, 0.0], max = [0.2, 0.4] }}
[effects.viscosity]
kinematic = 1.0e-6
[effects.collision]
[mps]
scheme = "classic"
spacing = {0:.17g}
time_step = {1:.17g}
[mps.pressure]
tolerance = 1e-4
)";

constexpr const char* text_3d = R"(format = 1
[case]
name = "dam_break_3d"
dimension = 3
[time]
end = 1.0
[geometry.tank]
type = "box"
min = [0.0, 0.0, 0.0]
max = [1.0, 0.6, 0.6]
open = ["top"]
[[fluid]]
region = {{ type = "box", min = [0.0, 0.0, 0.0], max = [0.3, 0.3, 0.33] }}
[effects.viscosity]
kinematic = 1.0e-6
[effects.collision]
[mps]
scheme = "classic"
spacing = {0:.17g}
time_step = {1:.17g}
[mps.pressure]
tolerance = 1e-4
)";

const std::map<std::string, std::string> plates_2d{{"none", ""},
                                                   {"plate", R"([geometry.cut]
type = "plate"
base = [0.1237, 0.0]
height = 0.06
thickness = 0.0
)"},
                                                   {"barrier", R"([geometry.cut]
type = "plate"
base = [0.1237, 0.0]
height = 0.55
thickness = 0.0
)"}};

const std::map<std::string, std::string> plates_3d{{"none", ""},
                                                   {"plate", R"([geometry.cut]
type = "plate"
base = [0.1471, 0.1519, 0.0]
height = 0.06
width = 0.15
thickness = 0.0
)"},
                                                   {"barrier", R"([geometry.cut]
type = "plate"
base = [0.1471, 0.3, 0.0]
height = 0.55
width = 0.6
thickness = 0.0
)"}};

const std::map<std::string, double> times{{"rest", 0.002}, {"early", 0.05}, {"collapse", 0.15}, {"splash", 0.3}};

template <class Value>
const Value& named(const std::map<std::string, Value>& all, const std::string& name, const std::string& what) {
  const auto found = all.find(name);
  std::vector<std::string> names;
  for (const auto& [known, value] : all) names.push_back(known);
  require(found != all.end(), "bench: error: no ", what, " \"", name, "\"; known: ", listed(names));
  return found->second;
}

}  // namespace

Size size_near(int dim, int particles) {
  Size size;
  size.dim = dim;
  const double wished = dim == 2 ? std::sqrt(particles / 2.0) : std::cbrt(particles / 1.1);
  size.across = static_cast<int>(std::lround(wished));
  size.spacing = (dim == 2 ? width_2d : width_3d) / size.across;
  size.dt = seconds_per_metre * size.spacing;
  size.particles = column(dim, size.across);
  return size;
}

std::vector<int> usual_sizes(int dim, bool scaling) {
  if (dim == 2) return scaling ? std::vector{5000, 20000, 80000, 320000, 1280000} : std::vector{5000, 20000, 80000};
  return scaling ? std::vector{30000, 100000, 300000, 1000000} : std::vector{30000};
}

std::string scene_name(int dim) { return dim == 2 ? "dam_break_2d" : "dam_break_3d"; }

double time_of_state(const std::string& name) { return named(times, name, "state"); }

std::string scene_text(const Size& size, const std::string& plate) {
  const bool flat = size.dim == 2;
  return fmt::format(fmt::runtime(flat ? text_2d : text_3d), size.spacing, size.dt) +
         named(flat ? plates_2d : plates_3d, plate, "plate");
}

Scene bench_scene(const Size& size, const std::vector<std::string>& sets, const std::string& plate) {
  std::vector<CaseOption> options;
  for (const std::string& set : sets) options.push_back(set_option(set));
  CaseFile file(scene_text(size, plate), "the case of bench", options);
  const Scene scene = read_scene(file);
  require(scene.dimension == size.dim && scene.mps.spacing == size.spacing,
          "bench: error: --set must not change the dimension or the spacing; choose them with --dim and --sizes");
  return scene;
}

}  // namespace greenwater::bench
