// Walls that move: a piston, a gate, a rolling tank against the same in its own frame, plates that turn and bend.
#include <iostream>

#include "kernels/motion.hpp"
#include "tests/runs.hpp"
#include "tests/shapes.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

// Pulled through a cloud at rest, a wall takes every particle along that it meets: nobody is on the wrong side of it.
void sweeps_clean(const WallFaces& start, const Positions& cloud, const WallMotion& motion, const FluidOptions& options,
                  const std::function<coord(const Point&, double)>& ahead) {
  Fluid fluid = fluid_at(cloud, start, options);
  const auto mover = make_moving_walls(motion);
  const real dt = real(0.01);
  std::vector<coord> before(cloud.size());
  const auto sides = [&](double t) {
    const auto x = host(fluid.particles.position);
    std::vector<coord> side(fluid.particles.count);
    for (int i = 0; i < fluid.particles.count; ++i) {
      Point at{};
      for (int d = 0; d < options.dim; ++d) at[d] = x(i, d);
      side[host(fluid.particles.id)(i)] = ahead(at, t);
    }
    return side;
  };
  const auto first = sides(0);
  int stopped = 0;
  for (int k = 0; k < 20; ++k) {
    clear_acceleration(fluid);
    mover->apply(fluid, dt);
    stopped += predict(fluid, dt);
    fluid.time += dt;
  }
  CHECK(stopped > 0);
  const auto last = sides(fluid.time);
  for (std::size_t i = 0; i < first.size(); ++i)
    if (std::isfinite(first[i]) && std::isfinite(last[i])) CHECK(first[i] * last[i] > 0);
}

}  // namespace

TEST_CASE("a wall that moves takes along what it meets", "[unit][moving]") {
  FluidOptions options;
  options.spacing = 0.05;
  const auto push = [](WallFaces& faces, double t) {
    for (auto& corner : faces.faces[0].corner) corner.position[0] = 0.2 + t;
  };
  sweeps_clean(walls_of({segment(0.2, -1, 0.2, 2)}), random_cloud(300, 2, 3), push, options,
               [](const Point& x, double t) { return x[0] - 0.2 - t; });
  options.dim = 3;
  WallFaces gate{3, {}, {{"gate"}}};
  add_rectangle(gate, {0.2, -1, -1}, {0.2, 2, -1}, {0.2, 2, 2}, {0.2, -1, 2});
  const auto push_3d = [](WallFaces& faces, double t) {
    for (auto& face : faces.faces)
      for (auto& corner : face.corner) corner.position[0] = 0.2 + t;
  };
  sweeps_clean(gate, random_cloud(300, 3, 3), push_3d, options,
               [](const Point& x, double t) { return x[0] - 0.2 - t; });
}

TEST_CASE("a plate that turns, and one that bends, take along what they meet", "[unit][moving]") {
  FluidOptions options;
  options.spacing = 0.05;
  const auto turn = [](WallFaces& faces, double t) {
    faces.faces[0].corner[1].position = {2 * std::cos(2 * t), 2 * std::sin(2 * t), 0};
  };
  sweeps_clean(walls_of({segment(0, 0, 2, 0)}), random_cloud(300, 2, 4), turn, options,
               [](const Point& x, double t) { return std::cos(2 * t) * x[1] - std::sin(2 * t) * x[0]; });
  // A plate of four pieces that bends into a parabola; no particle starts beside its ends.
  const auto bend = [](WallFaces& faces, double t) {
    for (auto& face : faces.faces)
      for (int e = 0; e < 2; ++e) {
        const coord y = face.corner[e].position[1];
        face.corner[e].position[0] = 0.4 + t * y * y;
      }
  };
  WallFaces plate = walls_of({});
  for (int k = 0; k < 4; ++k) plate.faces.push_back(segment(0.4, -0.2 + 0.4 * k, 0.4, 0.2 + 0.4 * k));
  sweeps_clean(plate, random_cloud(300, 2, 5), bend, options, [](const Point& x, double t) {
    const int k = std::clamp(static_cast<int>(std::floor((x[1] + 0.2) / 0.4)), 0, 3);
    const coord low = -0.2 + 0.4 * k, high = low + 0.4, s = (x[1] - low) / 0.4;
    return x[0] - (0.4 + t * ((1 - s) * low * low + s * high * high));
  });
}

TEST_CASE("walls that move tell their speed and acceleration", "[unit][moving]") {
  FluidOptions options;
  options.spacing = 0.1;
  Fluid fluid = fluid_at({{1, 0.5, 0}}, walls_of({segment(0, 0, 3, 0)}), options);
  const auto lift = [](WallFaces& faces, double t) {
    for (auto& corner : faces.faces[0].corner) corner.position[1] = t <= 0 ? 0 : 3 * t * t;
  };
  const auto mover = make_moving_walls(lift);
  const real dt = real(1e-3);
  for (int k = 0; k < 10; ++k) {
    mover->apply(fluid, dt);
    fluid.time += dt;
  }
  const Panel panel = host(fluid.walls.panel)(0);
  CHECK(panel.velocity.value[1] == Approx(3 * (0.01 * 0.01 - 0.009 * 0.009) / 1e-3));
  CHECK(panel.acceleration.value[1] == Approx(6));
  CHECK(panel.point[1] == Approx(3e-4));
}

TEST_CASE("moving walls allocate nothing in a steady step", "[unit][moving]") {
  FluidSimulation simulation(scene_of("moving_walls/rolling.toml"));
  for (int k = 0; k < 5; ++k) simulation.step();
  Ears ears;
  for (int k = 0; k < 5; ++k) simulation.step();
  CHECK(ears.allocations == std::vector<std::string>{});
}

TEST_CASE("a pressure probe on a wall that moves goes with it", "[unit][moving]") {
  FluidSimulation simulation(scene_of("moving_walls/piston.toml"));
  for (int k = 0; k < 400; ++k) simulation.step();
  const Fluid& fluid = simulation.fluid();
  const auto x = host(fluid.particles.position);
  const auto p = Kokkos::create_mirror(fluid.particles.pressure);
  for (int i = 0; i < fluid.particles.count; ++i) p(i) = x(i, 0);  // the pressure tells where it was read
  Kokkos::deep_copy(fluid.particles.pressure, p);
  const double piston = fluid.faces.faces.back().corner[0].position[0];
  REQUIRE(piston > 2 * fluid.spacing);
  const double read = simulation.sample(1);
  CHECK(read > piston);
  CHECK(read < piston + 2 * fluid.spacing);
}

namespace {

void check_piston(const Scene& scene) {
  double piston = 0;
  Watched run(scene, [&](const Point& x) { return x[0] < piston || x[0] > 0.2 || x[1] < 0; });
  const double l0 = scene.mps.spacing;
  double height = 0;
  int samples = 0;
  while (run.simulation.time() < 2) {
    const double t = run.simulation.time() + run.simulation.dt();
    piston = t < 0.5 ? 0.025 * (1 - std::cos(2 * M_PI * t)) : 0.05;
    run.step();
    if (t < 1 || run.simulation.steps() % 20 != 0) continue;
    height += 2 * centroid_of(run.simulation)[1];
    ++samples;
  }
  height /= samples;
  std::cout << "piston, scheme " << scene.mps.scheme << ": mean height " << height << " m of 0.08 ("
            << (height - 0.08) / l0 << " l0), fastest " << run.fastest << " m/s, stopped at walls " << run.stopped
            << ", outside " << run.outside << '\n';
  CHECK(std::fabs(height - 0.08) < 0.5 * l0);
  CHECK(run.outside == 0);
  CHECK(run.simulation.fluid().particles.count == 750);
}

}  // namespace

TEST_CASE("a piston pushed in keeps the volume of the water", "[validation][moving]") {
  const Scene scene = scene_of("moving_walls/piston.toml");
  check_piston(scene);
  Scene other = with_default_scheme(scene);
  check_piston(other);
  other.mps.adaptive = true;
  other.mps.time_step *= 4;
  check_piston(other);
}

TEST_CASE("a gate pulled up lets the water go, and holds it where it still is", "[validation][moving]") {
  const Scene scene = scene_of("moving_walls/gate.toml");
  const double fall = std::sqrt(2 * 9.81 * 0.4);
  double foot = 0, fastest_free = 0;
  const auto gate_foot = [](double t) { return t < 0.12 ? ((-285.115 * t + 72.305) * t + 0.1463) * t : 0.566; };
  Watched run(scene, [](const Point& x) { return x[0] < 0 || x[0] > 0.8 || x[1] < 0; });
  double free_at = -1, front_at_twice = -1;
  int leaked = 0;
  while (run.simulation.time() < 0.4) {
    foot = gate_foot(run.simulation.time() + run.simulation.dt());
    run.step();
    const auto places = places_of(run.simulation);
    coord front = 0;
    for (const Point& x : places) {
      front = std::max(front, x[0]);
      leaked += x[0] > 0.2 && x[0] < 0.2 + 0.01 && x[1] > foot + 4 * scene.mps.spacing && run.simulation.time() < 0.05;
    }
    if (front < 0.75) fastest_free = run.fastest;
    if (free_at < 0 && front > 0.2) free_at = run.simulation.time();
    if (front_at_twice < 0 && front > 0.4) front_at_twice = run.simulation.time();
  }
  Watched sudden(scene_of("dam_break_rigid/quick.toml", {"mps.spacing=0.005", "mps.time_step=0.000575"}),
                 [](const Point&) { return false; });
  while (sudden.simulation.sample(0) < 0.4 + 0.0025) sudden.step();
  std::cout << "gate: water passes at " << free_at << " s, front at x = 0.4 m at " << front_at_twice
            << " s, without a gate at " << sudden.simulation.time() << " s; fastest before the far wall "
            << fastest_free << " m/s, sqrt(2 g H) = " << fall << " m/s, stopped at walls " << run.stopped
            << ", outside " << run.outside << ", through the gate " << leaked << '\n';
  CHECK(free_at > 0.001);
  CHECK(std::fabs(front_at_twice - sudden.simulation.time()) < 0.03);  // it leaves later, and as a jet
  CHECK(fastest_free < fall);
  CHECK(run.outside == 0);
  CHECK(leaked == 0);
  CHECK(run.simulation.fluid().particles.count == 3200);
}

namespace {

void check_rolling_tank(const Scene& by_walls, const Scene& by_frame) {
  const double period = 0.83;
  const auto angle = [&](double t) { return 0.05 * (1 - std::cos(2 * M_PI * t / period)); };
  Watched walls(by_walls, [](const Point&) { return false; });
  Watched frame(by_frame, [](const Point&) { return false; });
  const double end = 0.6;  // the first crest is at 0.58 s; later they part, as sloshing breaks its symmetry by itself
  // Sway of the centroid in the tank's frame, and the side force of the water on the tank over a running mean.
  double crest = 0, largest_difference = 0, force_walls = 0, force_frame = 0, most_walls = 0, most_frame = 0;
  while (walls.simulation.time() < end) {
    walls.step();
    frame.step();
    const double t = walls.simulation.time(), a = angle(t);
    const Point c = centroid_of(walls.simulation), d = centroid_of(frame.simulation);
    const double sway = std::cos(a) * (c[0] - 0.15) + std::sin(a) * c[1], sway_frame = d[0] - 0.15;
    crest = std::max(crest, std::fabs(sway_frame));
    largest_difference = std::max(largest_difference, std::fabs(sway - sway_frame));
    const auto force_of = [](FluidSimulation& s) {
      PointSampler sampler;
      return wall_force(sampler, s.fluid(), wall_patches(s.fluid().faces, 0, s.fluid().spacing), Reading::average);
    };
    const auto f = force_of(walls.simulation), g = force_of(frame.simulation);
    const double share = walls.simulation.dt() / 0.03;
    force_walls += share * (std::cos(a) * f[0] + std::sin(a) * f[1] - force_walls);
    force_frame += share * (g[0] - force_frame);
    most_walls = std::max(most_walls, std::fabs(force_walls));
    most_frame = std::max(most_frame, std::fabs(force_frame));
  }
  std::cout << "rolling tank, scheme " << by_walls.mps.scheme << ": sway of the centroid " << crest
            << " m, largest difference " << largest_difference << " m (" << largest_difference / crest
            << "); largest side force " << most_walls << " and " << most_frame << " N/m, ratio "
            << most_walls / most_frame << '\n';
  CHECK(largest_difference < 0.02 * crest);
  CHECK(most_walls / most_frame == Approx(1).epsilon(0.02));
}

}  // namespace

TEST_CASE("a rolling tank by moving walls is the same in its own frame", "[validation][moving]") {
  const Scene by_walls = scene_of("moving_walls/rolling.toml"), by_frame = scene_of("moving_walls/rolling_frame.toml");
  check_rolling_tank(by_walls, by_frame);
  check_rolling_tank(with_default_scheme(by_walls), with_default_scheme(by_frame));
}
