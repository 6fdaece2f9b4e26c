// [mps], [effects.NAME], [output]: how the run is done and what it leaves behind.

#include <algorithm>
#include <limits>

#include "app/scene_parts.hpp"

namespace greenwater {
namespace {

constexpr std::int64_t most_iterations = std::numeric_limits<int>::max();
constexpr int most_sweeps = 1000;

int small_count(Section& section, const std::string& key, std::int64_t low, std::int64_t preset) {
  const std::int64_t value = section.count(key, low, preset);
  require_at(section.place(key), value <= most_iterations, key, " = ", value, " must be at most ", most_iterations);
  return static_cast<int>(value);
}

void read_pressure(Section section, bool classic, PressureCase& options) {
  options.weights = section.choice("weights", {"kept", "recomputed"}, options.weights);
  const bool kept = options.weights == "kept";
  if (!kept) options.preconditioner = "jacobi";
  options.preconditioner = section.choice("preconditioner", {"multigrid", "jacobi", "none"}, options.preconditioner);
  require_at(section.place("preconditioner"), kept || options.preconditioner != "multigrid",
             "preconditioner = \"multigrid\" needs weights = \"kept\"; with \"recomputed\" take \"jacobi\"");
  options.tolerance = section.number("tolerance", "-", between(0, 1), options.tolerance);
  options.absolute_tolerance = section.number("absolute_tolerance", "Pa/m^2", at_least(0), options.absolute_tolerance);
  require_at(section.place("tolerance"), options.tolerance > 0 || options.absolute_tolerance > 0,
             "tolerance = 0 needs an absolute_tolerance above 0, or the solve never ends");
  options.max_iterations = small_count(section, "max_iterations", 1, options.max_iterations);
  options.on_stall = section.choice("on_stall", {"fail", "warn"}, options.on_stall);
  if (classic) options.source = section.choice("source", {"density", "divergence"}, options.source);
}

double not_zero(Section& section, const std::string& key, double value) {
  require_at(section.place(key), value != 0, key, " = 0 is no effect: leave the table ", section.header(), " out");
  return value;
}

/// Names of walls, each once; "all" stands for every one.
Words read_no_slip(Section& section, const Words& walls) {
  Words known = walls;
  known.emplace_back("all");
  const Words given = section.choices("no_slip", known, Words{});
  if (std::find(given.begin(), given.end(), "all") != given.end()) return walls;
  Words names;
  for (const std::string& name : given) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

void read_time_step(Section& mps, MpsCase& options) {
  constexpr Bounds up_to_one{0, 1, false}, above_one{1, std::numeric_limits<double>::infinity(), false};
  options.time_step = mps.number("time_step", "s", positive, example(0.00046));
  options.time_step_place = mps.place("time_step");
  options.adaptive = mps.flag("adaptive", options.adaptive);
  for (const char* key : {"courant", "growth"}) {
    require_at(mps.place(key), !mps.offers(key) || options.adaptive, key,
               " belongs to time steps that adapt; add adaptive = true, or delete it");
  }
  if (!options.adaptive) return;
  options.courant = mps.number("courant", "-", up_to_one, options.courant);
  options.growth = mps.number("growth", "-", above_one, options.growth);
}

/// Keys of one scheme in a case of another one say nothing about it.
void refuse_keys(Section& mps, const Words& keys, const std::string& scheme, const std::string& mending) {
  for (const std::string& key : keys)
    require_at(mps.place(key), !mps.offers(key), key, " belongs to scheme = \"", scheme, "\"; ", mending);
}

const Words classic_keys{"kernel",
                         "kernel_shift",
                         "radius_density",
                         "radius_gradient",
                         "radius_laplacian",
                         "multiplication_coefficient",
                         "relaxation_factor",
                         "compressibility",
                         "free_surface_ratio"};

constexpr double most_radius = 10;       // x spacing: memory
constexpr double usual_radius_3d = 2.1;  // of the literature; some 40 neighbours, where 3.1 means 125

void set_radii(MpsCase& options, double radius) {
  options.radius_density = options.radius_gradient = options.radius_laplacian = radius;
}

void read_default_scheme(Section& mps, int dimension, MpsCase& options) {
  constexpr double least_radius = 2.05;  // x spacing: a second row tells where the surface is
  constexpr double smoothing_of_high = 0.1;
  refuse_keys(mps, classic_keys, "classic", "delete it, or take that scheme");
  options.kernel = "standard";
  const double usual = dimension == 3 ? usual_radius_3d : options.radius_laplacian;
  set_radii(options, mps.number("radius", "x spacing", between(least_radius, most_radius), usual));
  const bool high = options.scheme == "high";
  Section section = mps.table("default");
  DefaultSchemeCase& parts = options.parts;
  parts.reference_speed = section.number("reference_speed", "m/s", at_least(0), parts.reference_speed);
  parts.drift = section.number("drift", "-", at_least(0), parts.drift);
  parts.shifting = section.number("shifting", "-", at_least(0), parts.shifting);
  if (high) parts.smoothing = smoothing_of_high;
  parts.smoothing = section.number("smoothing", "-", at_least(0), parts.smoothing);
  parts.surface_smoothing = section.number("surface_smoothing", "-", at_least(0), parts.surface_smoothing);
  parts.diagonal_factor = section.number("diagonal_factor", "-", at_least(1), parts.diagonal_factor);
  parts.separation = section.number("separation", "x spacing", between(0, 1), parts.separation);
}

void read_classic_scheme(Section& mps, int dimension, MpsCase& options) {
  constexpr double least_radius = 1.1;  // x spacing: neighbours at all
  refuse_keys(mps, {"radius", "default"}, "default", "classic has a radius for each of its sums: radius_density, ...");
  if (dimension == 3) set_radii(options, usual_radius_3d);
  options.kernel = mps.choice("kernel", {"koshizuka_shifted", "standard"}, options.kernel);
  options.kernel_shift = mps.number("kernel_shift", "-", positive, options.kernel_shift);
  for (auto [key, radius] :
       {std::pair{"radius_density", &options.radius_density}, std::pair{"radius_gradient", &options.radius_gradient},
        std::pair{"radius_laplacian", &options.radius_laplacian}}) {
    *radius = mps.number(key, "x spacing", between(least_radius, most_radius), *radius);
  }
  options.multiplication_coefficient =
      mps.number("multiplication_coefficient", "-", at_least(1), options.multiplication_coefficient);
  options.relaxation_factor = mps.number("relaxation_factor", "-", positive, options.relaxation_factor);
  options.compressibility = mps.number("compressibility", "1/Pa", at_least(0), options.compressibility);
  options.free_surface_ratio = mps.number("free_surface_ratio", "-", between(0, 1), options.free_surface_ratio);
}

}  // namespace

void read_mps(Section mps, Scene& scene) {
  MpsCase& options = scene.mps;
  options.scheme = mps.choice("scheme", {"default", "high", "classic"}, options.scheme);
  options.spacing = mps.number("spacing", "m", positive, example(0.004));
  options.spacing_place = mps.place("spacing");
  options.expected_particles = mps.count("expected_particles", 0, options.expected_particles);
  options.expected_place = mps.place("expected_particles");
  read_time_step(mps, options);
  options.cfl_warn = mps.number("cfl_warn", "-", positive, options.cfl_warn);
  const bool classic = options.scheme == "classic";
  (classic ? read_classic_scheme : read_default_scheme)(mps, scene.dimension, options);
  Section pressure = mps.table("pressure");
  read_pressure(pressure, classic, options.pressure);
  require_at(pressure.place("weights"), options.scheme != "high" || options.pressure.weights == "kept",
             "weights = \"recomputed\" are those of symmetric rows, which scheme = \"high\" has not; delete it");
}

void read_undo(Section section, Scene& scene) {
  constexpr std::int64_t most_halvings = 50;
  constexpr double most_displacement = 2;  // x spacing: rows would not see who runs together beyond it
  const MpsCase& mps = scene.mps;
  UndoCase& options = scene.mps.undo;
  // The paper's step is what it is, and a march that staggering makes unstable is so in every step, however short.
  const bool staggered = !scene.structures.empty() && scene.coupling.scheme == "staggered";
  if (mps.scheme == "classic" || staggered) options.halvings = 0;
  options.halvings = small_count(section, "halvings", 0, options.halvings);
  require_at(section.place("halvings"), options.halvings <= most_halvings, "halvings = ", options.halvings,
             " leaves nothing of a step: at most ", most_halvings);
  for (const char* key : {"displacement", "distance"}) {
    require_at(section.place(key), !section.offers(key) || options.halvings > 0, key,
               " says when a step is undone, and with halvings = 0 none is; give halvings, or delete it");
  }
  if (options.halvings == 0) return;
  // The bulk goes courant, and what is faster than it some twice as far.
  if (mps.adaptive) options.displacement = std::max(options.displacement, 2 * mps.courant);
  options.displacement =
      section.number("displacement", "x spacing", Bounds{0, most_displacement, false}, options.displacement);
  require_at(section.place("displacement"), !mps.adaptive || options.displacement > mps.courant,
             "displacement = ", options.displacement, " would undo every step of courant = ", mps.courant,
             "; it has to be more than that, and is best some four times as much");
  options.distance = section.number("distance", "x spacing", between(0, 0.5), options.distance);
}

void read_effects(Section effects, Scene& scene) {
  if (auto section = effects.table_if_present("viscosity")) {
    ViscosityCase viscosity;
    const double kinematic = section->number("kinematic", "m^2/s", at_least(0), example(1e-6));
    viscosity.kinematic = not_zero(*section, "kinematic", kinematic);
    viscosity.no_slip = read_no_slip(*section, wall_names(scene));
    scene.viscosity.push_back(viscosity);
  }
  if (auto section = effects.table_if_present("collision")) {
    CollisionCase collision;
    const double distance = section->number("distance", "x spacing", between(0, 1), collision.distance);
    collision.distance = not_zero(*section, "distance", distance);
    collision.restitution = section->number("restitution", "-", between(0, 1), collision.restitution);
    collision.sweeps = small_count(*section, "sweeps", 1, collision.sweeps);
    require_at(section->place("sweeps"), collision.sweeps <= most_sweeps, "sweeps = ", collision.sweeps,
               " rounds a step is beyond all use: at most ", most_sweeps);
    scene.collision.push_back(collision);
  }
  if (auto section = effects.table_if_present("body_force")) {
    BodyForceCase force;
    const Preset<Formulas> shown = example(Formulas{"0.5*sin(2*pi*t)", "0", "0"});
    force.acceleration =
        read_formulas(*section, {"acceleration", "m/s^2", shown, Variables::place_time_velocity}, scene.dimension);
    const auto compiled = compile(force.acceleration.text, force.acceleration.place, Variables::place_time_velocity);
    require_at(force.acceleration.place, !is_zero(compiled), "acceleration = 0 is no effect: leave the table ",
               section->header(), " out");
    scene.body_force.push_back(force);
  }
}

void read_output(Section output, OutputCase& options) {
  options.directory = output.text("directory", options.directory);
  options.directory_place = output.place("directory");
  require_at(options.directory_place, !options.directory.empty(), "directory is empty; the default is \"runs/{name}\"");
  options.every_time = output.number("every_time", "s", at_least(0), options.every_time);
  options.history_every_steps = small_count(output, "history_every_steps", 1, options.history_every_steps);
  options.precision = output.choice("precision", {"float32", "float64"}, options.precision);
  options.paraview = output.choices("paraview", {"vtp"}, options.paraview);
}

}  // namespace greenwater
