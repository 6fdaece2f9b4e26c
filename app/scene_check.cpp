// How the parts of a scene fit together, and whether its numbers make sense beside each other.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/motion.hpp"
#include "app/plan.hpp"
#include "app/scene_shape.hpp"
#include "kernels/cell_grid.hpp"

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
  bool holds(const Corners& room) const {
    return inside(scene.fluid.min, room.min, room.max) && inside(scene.fluid.max, room.min, room.max);
  }
};

void check_times(const Check& check) {
  constexpr double most_steps = 1e12;
  const Scene& scene = check.scene;
  const MpsCase& mps = scene.mps;
  require_at(mps.time_step_place, mps.time_step <= scene.end, "mps.time_step = ", mps.time_step,
             " s is longer than the run, time.end = ", scene.end, " s; take a shorter step");
  require_at(mps.time_step_place, scene.end / mps.time_step < most_steps, "mps.time_step = ", mps.time_step,
             " s makes more than 1e12 steps of time.end = ", scene.end, " s; take a longer step or an earlier end");
}

// The scheme is lost long before; this is for slips of the unit.
constexpr double most_cfl = 5;

void check_time_step(const Check& check) {
  const MpsCase& mps = check.scene.mps;
  const double cfl = front_cfl(check.scene);
  require_at(mps.time_step_place, cfl <= most_cfl, "mps.time_step = ", mps.time_step,
             " s makes no sense here: the front of this water would run ", cfl,
             " particle distances in one step; take less than ", 0.5 * mps.time_step / cfl, " s");
}

void require_wider(const Check& check, const GeometryCase& geometry, const char* kind, const std::string& how_wide,
                   double width) {
  const double spacing = check.scene.mps.spacing;
  require_at(check.scene.mps.spacing_place, width >= spacing - check.slack, "mps.spacing = ", spacing,
             " m is larger than the ", kind, " \"", geometry.name, "\", which is ", width, " m ", how_wide,
             "; take a smaller spacing");
}

void check_spacing(const Check& check) {
  const Scene& scene = check.scene;
  for (const BoxCase& box : scene.boxes) {
    for (std::size_t d = 0; d < check.axes; ++d)
      require_wider(check, box, "box", text_of("wide in ", axis_name[d]), box.max[d] - box.min[d]);
  }
  for (const PlateCase& plate : scene.plates) {
    require_wider(check, plate, "plate", "high", plate.height);
    if (scene.dimension == 3) require_wider(check, plate, "plate", "wide", plate.width);
  }
  for (const Shape& shape : shapes_of(scene)) {
    double longest = 0;
    for (std::size_t d = 0; d < check.axes; ++d) longest = std::max(longest, shape.bounds.max[d] - shape.bounds.min[d]);
    require_wider(check, *shape.geometry, shape.kind, "long", longest);
  }
}

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

void check_fluid_in_boxes(const Check& check) {
  const Scene& scene = check.scene;
  if (scene.boxes.empty()) return;
  bool held = false;
  for (const BoxCase& box : scene.boxes) held = held || check.holds({box.min, box.max});
  for (const PolylineCase& line : scene.polylines)
    held =
        held || (line.closed && inside_polyline(line, scene.fluid.ball ? scene.fluid.ball->centre : scene.fluid.min));
  for (const Shape& shape : shapes_of(scene)) {
    const auto is_it = [&](const MeshCase& mesh) { return &mesh == shape.geometry && mesh.closed; };
    held = held || (std::any_of(scene.meshes.begin(), scene.meshes.end(), is_it) && check.holds(shape.bounds));
  }
  const BoxCase& first = scene.boxes.front();
  require_at(scene.fluid.place, held, "the fluid reaches out of the box \"", first.name, "\" from ",
             shown_point(first.min, scene.dimension), " to ", shown_point(first.max, scene.dimension),
             " m; shrink the region or enlarge the box");
}

/// Points along the rim of the fluid in 2-D, a little inwards, because walls belong to neither side.
std::vector<Point> rim_points(const Check& check) {
  constexpr int round = 32;
  const FluidCase& fluid = check.scene.fluid;
  const double inwards = 1e-3 * check.scene.mps.spacing;
  const Point &a = fluid.min, &b = fluid.max;
  if (!fluid.ball) {
    return {{a[0] + inwards, a[1] + inwards, 0},
            {b[0] - inwards, a[1] + inwards, 0},
            {b[0] - inwards, b[1] - inwards, 0},
            {a[0] + inwards, b[1] - inwards, 0}};
  }
  std::vector<Point> points;
  for (int k = 0; k < round; ++k) {
    const double turn = 2 * std::numbers::pi * k / round, r = fluid.ball->radius - inwards;
    points.push_back({fluid.ball->centre[0] + r * std::cos(turn), fluid.ball->centre[1] + r * std::sin(turn), 0});
  }
  return points;
}

/// Where one closed wall is all there is, water that is half in it was meant to be in it.
void check_fluid_in_only_wall(const Check& check) {
  const Scene& scene = check.scene;
  const auto shapes = shapes_of(scene);
  if (!scene.fluid.without.empty() || shapes.size() != 1 || !scene.boxes.empty() || !scene.plates.empty()) return;
  const Point &a = scene.fluid.min, &b = scene.fluid.max;
  const Point centre{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
  const Corners& bounds = shapes.front().bounds;
  bool astride = false;
  for (const PolylineCase& line : scene.polylines) {
    bool all = true;
    for (const Point& x : rim_points(check)) all = all && inside_polyline(line, x);
    astride = line.closed && !all && inside_polyline(line, centre);
  }
  for (const MeshCase& mesh : scene.meshes)
    astride = mesh.closed && !check.holds(bounds) && check.inside(centre, bounds.min, bounds.max);
  const std::string& name = shapes.front().geometry->name;
  require_at(scene.fluid.place, !astride, "the fluid reaches out of \"", name,
             "\"; shrink the region, or fill the inside: region = { type = \"inside\", wall = \"", name,
             "\", level = ", scene.fluid.max[check.axes - 1], " }");
}

std::string at_point(const Point& x, double t, int dimension) {
  return text_of(" at ", shown_point(x, dimension), " m, t = ", t, " s");
}

/// Some of the places where particles will be.
std::vector<Point> samples(const Check& check) {
  constexpr double along = 9;  // an odd number: the centre is one of them
  const FluidCase& fluid = check.scene.fluid;
  std::vector<Point> points;
  const double deep = check.axes == 3 ? along : 1;
  for (double k = 0.5; k < deep; ++k)
    for (double j = 0.5; j < along; ++j)
      for (double i = 0.5; i < along; ++i) {
        const Point s{i / along, j / along, k / deep};
        Point x{};
        for (std::size_t d = 0; d < check.axes; ++d) x[d] = fluid.min[d] + s[d] * (fluid.max[d] - fluid.min[d]);
        if (!fluid.ball || inside_ball(*fluid.ball, x)) points.push_back(x);
      }
  return points;
}

void check_velocity(const Check& check) {
  const Scene& scene = check.scene;
  const VectorFormula& velocity = scene.fluid.velocity;
  const auto compiled = compile(velocity.text, velocity.place);
  for (const Point& x : samples(check)) {
    const double u = compiled[0](x[0], x[1], x[2], 0), v = compiled[1](x[0], x[1], x[2], 0);
    const double speed = std::hypot(u, v, compiled[2](x[0], x[1], x[2], 0));
    require_at(velocity.place, std::isfinite(speed), "velocity is no finite number", at_point(x, 0, scene.dimension),
               "; mend the formula");
    if (scene.mps.adaptive) continue;
    require_at(velocity.place, speed * scene.mps.time_step <= most_cfl * scene.mps.spacing, "velocity is ", speed,
               " m/s", at_point(x, 0, scene.dimension), ", ", speed * scene.mps.time_step / scene.mps.spacing,
               " particle distances in one step; take a shorter mps.time_step than ", 0.5 * scene.mps.spacing / speed,
               " s, or mend the formula");
  }
}

void check_body_force(const Check& check) {
  const Scene& scene = check.scene;
  for (const BodyForceCase& force : scene.body_force) {
    const auto compiled = compile(force.acceleration.text, force.acceleration.place, Variables::place_time_velocity);
    for (const Point& x : samples(check)) {
      for (const Formula& component : compiled)
        require_at(force.acceleration.place, std::isfinite(component(x[0], x[1], x[2], 0)),
                   "acceleration is no finite number", at_point(x, 0, scene.dimension), ", at rest; mend the formula");
    }
  }
}

void check_motion(const Check& check, const Shape& shape) {
  require_motion(*shape.geometry);
  const MotionCase& motion = *shape.geometry->motion;
  const MpsCase& mps = check.scene.mps;
  const Motion compiled(motion);
  LongestStep longest = longest_step(compiled, check.scene.end, mps.time_step, reach_of(shape));
  require_at(motion.place, std::isfinite(longest.way), "the motion of \"", shape.geometry->name,
             "\" is no finite number after t = ", longest.time, " s; mend the formula, or end the run before");
  if (mps.adaptive) {  // no wall is too fast, but one that jumps does so in the shortest step too
    longest = fastest_part(compiled, longest, mps.time_step, reach_of(shape));
    require_at(motion.place, longest.way <= mps.spacing, '"', shape.geometry->name, "\" moves ", longest.way,
               " m in a thousandth of mps.time_step at t = ", longest.time,
               " s, more than one mps.spacing = ", mps.spacing,
               " m: no step is short enough for that. Let the motion go on without a jump, and end in time");
    return;
  }
  require_at(motion.place, longest.way <= mps.spacing, '"', shape.geometry->name, "\" moves ", longest.way,
             " m in the step at t = ", longest.time, " s, more than one mps.spacing = ", mps.spacing,
             " m: water would be left behind it. Let the motion end in time (t < 0.1 ? ... : ...), or take a shorter "
             "mps.time_step");
}

/// A structure goes through no closed side of the tank that it stands in; the foot of a plate that leans may.
void check_structures(const Check& check) {
  const Scene& scene = check.scene;
  if (scene.boxes.size() != 1) return;
  const BoxCase& box = scene.boxes.front();
  const auto sides = box_sides(scene.dimension);
  const auto is_open = [&](const std::string& side) {
    return std::find(box.open.begin(), box.open.end(), side) != box.open.end();
  };
  for (const StructureCase& structure : scene.structures) {
    const double slack = check.slack + (structure.plate ? structure.plate->thickness : 0);
    for (const Point& x : structure.mesh.nodes)
      for (std::size_t d = 0; d < check.axes; ++d)
        require_at(structure.place,
                   (x[d] >= box.min[d] - slack || is_open(sides[2 * d])) &&
                       (x[d] <= box.max[d] + slack || is_open(sides[2 * d + 1])),
                   "the structure \"", structure.name, "\" reaches out of the box \"", box.name, "\" at ",
                   shown_point(x, scene.dimension), " m; move or shrink it, or open that side of the box");
  }
}

void check_domain(const Check& check) {
  const Scene& scene = check.scene;
  if (!scene.has_domain) return;
  require_at(scene.domain_place, check.holds({scene.domain_min, scene.domain_max}),
             "the fluid reaches out of [domain]: particles there would be taken out at once; ", "enlarge the domain");
}

/// What a domain that repeats itself along an axis asks of all that is in it.
void check_period(const Check& check, std::size_t d) {
  const Scene& scene = check.scene;
  const MpsCase& mps = scene.mps;
  const Place& place = scene.repeats_place;
  const double period = scene.domain_max[d] - scene.domain_min[d];
  const double radius = mps.spacing * std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
  require_at(place, period > 1.001 * shortest_period * radius, "the domain repeats itself along ", axis_name[d],
             " after ", period, " m, and a particle reaches ", radius, " m far: that must be more than ",
             shortest_period, " times as much; take a longer domain or a smaller mps.spacing");
  require_at(place, scene.structures.empty(),
             "structures in a domain that repeats itself are not built; delete periodic");
  const double wide = scene.fluid.max[d] - scene.fluid.min[d], cells = std::round(period / mps.spacing);
  if (scene.fluid.packing == "lattice" && scene.fluid.inside.empty() && !scene.fluid.ball &&
      wide > period - mps.spacing)
    require_at(mps.spacing_place, std::fabs(cells * mps.spacing - period) < 1e-6 * mps.spacing,
               "particles do not fit into the period of ", period, " m along ", axis_name[d],
               ": there would be a gap or a crowd at its edge; take spacing = ", period / cells);
  for (const Shape& shape : shapes_of(scene)) {
    const double length = shape.bounds.max[d] - shape.bounds.min[d];
    const GeometryCase& geometry = *shape.geometry;
    require_at(geometry.place, length <= period + check.slack, '"', geometry.name, "\" is ", length, " m long in ",
               axis_name[d], ", more than the domain, which repeats itself after ", period,
               " m: walls go on by themselves; end it at the edges");
    require_at(geometry.place, !geometry.motion || (!geometry.motion->rotation && !geometry.motion->rotation_table),
               '"', geometry.name, "\" turns, and the domain repeats itself; let it only shift, or delete periodic");
  }
  for (const BoxCase& box : scene.boxes)
    for (std::size_t end = 0; end < 2; ++end) {
      const std::string side = box_sides(scene.dimension)[2 * d + end];
      const bool open = std::find(box.open.begin(), box.open.end(), side) != box.open.end();
      require_at(box.place, open || box.max[d] - box.min[d] < period - check.slack, "the ", side, " side of \"",
                 box.name, "\" closes the domain where it repeats itself; open it: open = [\"", side, "\"]");
    }
}

void check_periods(const Check& check) {
  for (std::size_t d = 0; d < check.axes; ++d)
    if (check.scene.repeats[d]) check_period(check, d);
}

/// Cells in which neighbours are looked for; of particles the plan takes care.
void check_extent(const Check& check) {
  constexpr double most_cells = std::numeric_limits<int>::max() / 4;
  const Scene& scene = check.scene;
  const MpsCase& mps = scene.mps;
  const auto lattice = lattice_cells(scene.fluid, mps.spacing, scene.dimension);
  if (lattice[0] * lattice[1] * lattice[2] > most_cells) return;
  const double radius = mps.spacing * std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
  Corners room{scene.fluid.min, scene.fluid.max};
  for (const Shape& shape : shapes_of(scene))
    for (std::size_t d = 0; d < check.axes; ++d) {
      room.min[d] = std::min(room.min[d], shape.bounds.min[d]);
      room.max[d] = std::max(room.max[d], shape.bounds.max[d]);
    }
  if (scene.has_domain) room = {scene.domain_min, scene.domain_max};
  double cells = 1;
  for (std::size_t d = 0; d < check.axes; ++d) cells *= (room.max[d] - room.min[d]) / radius + 1;
  if (cells < most_cells) return;
  throw ResourceError(complaint(
      mps.spacing_place,
      text_of("the scene from ", shown_point(room.min, scene.dimension), " to ", shown_point(room.max, scene.dimension),
              " m has ", cells, " cells in which neighbours are looked for, more than ", most_cells,
              "; take a larger mps.spacing, or give the scene a smaller [domain]")));
}

}  // namespace

void check_scene(const Scene& scene) {
  const Check check{scene};
  check_times(check);
  check_spacing(check);
  check_fluid_size(check);
  if (scene.fluid.inside.empty()) {
    check_fluid_in_boxes(check);
    check_fluid_in_only_wall(check);
  }
  check_walls(scene);
  check_structures(check);
  check_domain(check);
  check_periods(check);
  check_extent(check);
  check_time_step(check);
  check_velocity(check);
  check_body_force(check);
  for (const Shape& shape : shapes_of(scene)) {
    if (shape.geometry->motion) check_motion(check, shape);
  }
}

}  // namespace greenwater
