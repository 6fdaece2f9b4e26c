// Structures that touch rigid walls.

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/march.hpp"
#include "tests/catch.hpp"
#include "tests/structures.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

const Material rubbery{2.5e6, 0.3, 1200};
constexpr double usual = 0.02;  // stiffness

/// Walls that stand.
ContactWalls standing(int dim, const std::vector<FaceCorners>& faces) {
  return {dim, [faces](double, std::vector<FaceCorners>& now) { now = faces; }};
}

/// Walls that move as they are, by a way at a time.
ContactWalls moving(int dim, const std::vector<FaceCorners>& faces, std::function<Place(double)> way) {
  return {dim, [faces, way](double t, std::vector<FaceCorners>& now) {
            now = faces;
            for (FaceCorners& corner : now)
              for (Place& x : corner)
                for (int d = 0; d < 3; ++d) x[d] += way(t)[d];
          }};
}

FaceCorners segment(double x0, double y0, double x1, double y1) {
  FaceCorners corner{};
  corner[0] = {x0, y0, 0};
  corner[1] = {x1, y1, 0};
  return corner;
}

/// The floor z = 0 of two triangles from -1 to 2 m.
std::vector<FaceCorners> floor_in_space() {
  return {{Place{-1, -1, 0}, Place{2, -1, 0}, Place{2, 2, 0}}, {Place{-1, -1, 0}, Place{2, 2, 0}, Place{-1, 2, 0}}};
}

Vector everywhere(const Solid& solid, const Place& value) {
  return displacement_of(solid.mesh(), [&](const Place&) { return value; });
}

/// Mean of a component over the mass.
double mean(const Solid& solid, const Vector& values, int axis) {
  double sum = 0, mass = 0;
  for (Eigen::Index i = axis; i < values.size(); i += solid.dim()) {
    sum += solid.mass()[i] * values[i];
    mass += solid.mass()[i];
  }
  return sum / mass;
}

/// Lowest coordinate of any node along an axis.
double lowest(const Solid& solid, const Vector& u, int axis) {
  double least = 1e300;
  for (std::size_t n = 0; n < solid.mesh().nodes.size(); ++n)
    least = std::min(least, solid.mesh().nodes[n][axis] + u[solid.dim() * n + axis]);
  return least;
}

/// What is lost or gained at most, of the kinetic energy of a node, when its spring begins or ends within a step: the work
/// of the spring is summed by trapezoids, k (v h)^2 / 8. Steps are a part `safety` of the critical ones.
double begin_error(double stiffness, double safety) { return stiffness * safety * safety / (1 + 3 * stiffness); }

struct Bounce {
  double balance = 0;  // largest change, of the energy of the fall
  double deepest = 0;  // [m]
  double rebound = 0;  // of the height of the fall
};

/// A bar that is dropped on end onto the floor, and up again.
Bounce drop(int dim, double stiffness, double safety) {
  const double fall = 0.01, g = 9.81, thick = 0.02;
  const int up = dim - 1;
  Place low{}, high{thick, thick, thick}, acceleration{};
  low[up] = fall, high[up] = fall + 0.1, acceleration[up] = -g;
  std::array<int, 3> divisions{2, 1, 1};
  divisions[up] = 10;
  // Without Poisson's ratio the waves of the impact are one-dimensional: none of them stays in the bar.
  const Solid solid(box_mesh(dim, low, high, divisions), {2.5e6, 0, 1200});
  Loads loads;
  loads.add(gravity_pattern(solid, acceleration));
  const Contact contact(solid, standing(dim, dim == 2 ? std::vector{segment(-1, 0, 1, 0)} : floor_in_space()),
                        stiffness);
  March march(solid, {}, loads, {.step = safety * Contact::critical_step(critical_step(solid, {}), stiffness)}, {}, {},
              contact);
  const double energy = solid.mass().sum() / dim * g * fall, first = march.energies().balance();
  Bounce bounce;
  bool up_again = false;
  while (march.time() < 3 * std::sqrt(2 * fall / g)) {
    march.advance(7);
    bounce.balance = std::max(bounce.balance, std::abs(march.energies().balance() - first) / energy);
    bounce.deepest = std::max(bounce.deepest, -lowest(solid, march.displacement(), up));
    up_again = up_again || (march.time() > std::sqrt(2 * fall / g) && mean(solid, march.velocity(), up) > 0);
    if (up_again) bounce.rebound = std::max(bounce.rebound, 1 + mean(solid, march.displacement(), up) / fall);
  }
  return bounce;
}

}  // namespace

TEST_CASE("a bar dropped on the floor comes up again, and the balance of its energy holds", "[unit][structure]") {
  for (const int dim : {2, 3}) {
    const Bounce coarse = drop(dim, usual, 0.9), fine = drop(dim, usual, 0.45), hard = drop(dim, 0.1, 0.9);
    for (const Bounce& bounce : {coarse, fine, hard}) CHECK(bounce.rebound < 1);
    CHECK(coarse.balance < 1e-3);
    CHECK(hard.balance < begin_error(0.1, 0.9) / 20);  // half of the lowest of ten elements is at the spring
    CHECK(coarse.rebound > 0.98);
    CHECK(hard.rebound > 0.93);  // more stays in waves as short as the elements
    CHECK(coarse.deepest > 0);
    CHECK(coarse.deepest < 0.02 * 0.1);
    CHECK(hard.deepest < 0.4 * coarse.deepest);
    CHECK(fine.balance < 0.5 * coarse.balance);
  }
}

TEST_CASE("a beam that is pressed on a wall rests there as on a prop", "[unit][structure]") {
  const double length = 0.4, height = 0.02, gap = 0.005;
  const Solid solid(box_mesh(2, {0, 0, 0}, {length, height, 0}, {40, 1, 1}), rubbery);
  Supports supports;
  clamp(supports, 2, nodes_of_part(solid.mesh(), "left"));
  const double bending = 2.5e6 / (1 - 0.3 * 0.3) * std::pow(height, 3) / 12;
  // Alone it would bend twice as far; then the wall carries 3/8 p L - 3 E I gap / L^3, and only its tip touches.
  const double p = 2 * 8 * bending * gap / std::pow(length, 4);
  const double carried = 3.0 / 8 * p * length - 3 * bending * gap / std::pow(length, 3);
  Loads loads;
  loads.add(pressure_pattern(solid, find_part(solid.mesh(), "top")->facets, [p](const Place&) { return p; }));
  const double step = 0.9 * Contact::critical_step(critical_step(solid, supports), usual);
  const auto settled = [&](std::optional<Contact> contact) {
    March march(solid, supports, loads, {.step = step, .damping = 15}, {}, {}, std::move(contact));
    march.advance(static_cast<int>(3 / step));
    return march;
  };
  CHECK(lowest(solid, settled({}).displacement(), 1) == Approx(-2 * gap).epsilon(0.02));
  const March march = settled(Contact(solid, standing(2, {segment(0.1, -gap, 1, -gap)}), usual));
  const double depth = -gap - lowest(solid, march.displacement(), 1);
  CHECK(depth > 0);
  CHECK(depth < 0.001 * length);
  double foot = 0;
  for (const int node : nodes_of_part(solid.mesh(), "left")) foot += march.reaction()[2 * node + 1];
  CHECK(p * length - foot == Approx(carried).epsilon(0.03));
  CHECK(march.energies().contact == Approx(carried * depth / 2).epsilon(0.03));
}

TEST_CASE("what slides along a wall feels no force along it, nor the joints of its faces", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0.001, 0}, {0.1, 0.051, 0}, {4, 2, 1}), rubbery);
  Loads loads;
  loads.add(gravity_pattern(solid, {0, -9.81, 0}));
  const double step = 0.9 * Contact::critical_step(critical_step(solid, {}), usual);
  const auto slid = [&](const std::vector<FaceCorners>& faces) {
    March march(solid, {}, loads, {.step = step}, {}, everywhere(solid, {3, 0, 0}),
                Contact(solid, standing(2, faces), usual));
    march.advance(static_cast<int>(0.2 / step));
    CHECK(mean(solid, march.velocity(), 0) == Approx(3).epsilon(1e-10));
    CHECK(lowest(solid, march.displacement(), 1) > -0.002);
    return march.displacement();
  };
  std::vector<FaceCorners> pieces;
  for (int k = -1; k < 20; ++k) pieces.push_back(segment(0.05 * k, 0, 0.05 * (k + 1), 0));
  std::swap(pieces[7][0], pieces[7][1]);
  const Vector whole = slid({segment(-1, 0, 2, 0)}), jointed = slid(pieces);
  CHECK((whole - jointed).lpNorm<Eigen::Infinity>() < 1e-9);
}

TEST_CASE("a block thrown into a corner comes out of it", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0.01, 0.01, 0}, {0.06, 0.06, 0}, {3, 3, 1}), rubbery);
  for (const auto& [stiffness, safety] : {std::pair{usual, 0.95}, std::pair{0.3, 0.95}, std::pair{0.3, 0.5}}) {
    const double step = safety * Contact::critical_step(critical_step(solid, {}), stiffness);
    const Contact contact(solid, standing(2, {segment(0, 0, 0, 1), segment(1, 0, 0, 0)}), stiffness);
    March march(solid, {}, {}, {.step = step}, {}, everywhere(solid, {-1, -1, 0}), contact);
    const double energy = march.energies().balance();
    double deepest = 0, worst = 0;
    for (int call = 0; call < 200; ++call) {
      march.advance(static_cast<int>(1.5e-4 / step) + 1);
      worst = std::max(worst, std::abs(march.energies().balance() / energy - 1));
      for (const int axis : {0, 1}) deepest = std::max(deepest, -lowest(solid, march.displacement(), axis));
    }
    CHECK(deepest > 0);
    CHECK(deepest < 0.1 * 0.05);
    CHECK(worst < begin_error(stiffness, safety));
    CHECK(mean(solid, march.velocity(), 0) > 0.5);
    CHECK(mean(solid, march.velocity(), 1) == Approx(mean(solid, march.velocity(), 0)).epsilon(1e-6));
  }
}

TEST_CASE("a wall that moves pushes, and its work is counted", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0, 0}, {0.1, 0.02, 0}, {10, 2, 1}), {2.5e6, 0, 1200});
  const double step = 0.9 * Contact::critical_step(critical_step(solid, {}), usual), speed = 0.5;
  const ContactWalls piston = moving(2, {segment(-0.001, -1, -0.001, 1)}, [speed](double t) {
    return Place{speed * t, 0, 0};
  });
  March march(solid, {}, {}, {.step = step}, {}, {}, Contact(solid, piston, usual));
  const double energy = 2 * solid.mass().sum() / 2 * speed * speed;  // of twice the speed
  double worst = 0;
  for (int call = 0; call < 100; ++call) {
    march.advance(static_cast<int>(1e-4 / step) + 1);
    worst = std::max(worst, std::abs(march.energies().balance()));
  }
  CHECK(worst < 2e-3 * energy);
  CHECK(march.energies().supports == Approx(energy).epsilon(0.02));
  CHECK(mean(solid, march.velocity(), 0) == Approx(2 * speed).epsilon(0.02));
}

TEST_CASE("a wall that came round a block pushes from the other side", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0, 0}, {0.02, 0.02, 0}, {2, 2, 1}), rubbery);
  const double step = 0.9 * Contact::critical_step(critical_step(solid, {}), usual);
  // Down, below the block to the right, up, and to the left.
  const auto way = [](double t) {
    const auto leg = [t](double from) { return std::clamp(10 * (t - from), 0.0, 1.0); };
    return Place{0.07 * leg(0.1) - 0.06 * leg(0.3), -0.2 * leg(0) + 0.2 * leg(0.2), 0};
  };
  const ContactWalls plate = moving(2, {segment(-0.03, -0.05, -0.03, 0.07)}, way);
  March march(solid, {}, {}, {.step = step}, {}, {}, Contact(solid, plate, usual));
  for (int call = 0; march.time() < 0.3; ++call) march.advance(10);
  CHECK(march.displacement().isZero(0));
  while (march.time() < 0.4) march.advance(10);
  CHECK(mean(solid, march.velocity(), 0) == Approx(-2 * 0.6).epsilon(0.1));
}

TEST_CASE("walls end, and what lies on a wall at rest never touches it", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0, 0}, {0.1, 0.1, 0}, {2, 2, 1}), rubbery);
  const double step = 0.9 * Contact::critical_step(critical_step(solid, {}), usual);
  const auto fallen = [&](const FaceCorners& face) {
    March march(solid, {}, {}, {.step = step}, {}, everywhere(solid, {0, -1, 0}),
                Contact(solid, standing(2, {face}), usual));
    march.advance(static_cast<int>(0.05 / step));
    return mean(solid, march.displacement(), 1) / march.time();
  };
  CHECK(fallen(segment(0.11, -0.01, 1, -0.01)) == Approx(-1));
  CHECK(fallen(segment(-1, -0.01, -0.01, -0.01)) == Approx(-1));
  CHECK(fallen(segment(-1, 0, 1, 0)) == Approx(-1));
  CHECK(fallen(segment(-1, -0.01, 1, -0.01)) > -0.2);
}

TEST_CASE("a step with contact can be taken back", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0.001, 0}, {0.1, 0.021, 0}, {4, 1, 1}), rubbery);
  const double step = 0.9 * Contact::critical_step(critical_step(solid, {}), usual);
  const ContactWalls rising = moving(2, {segment(-1, 0, 0.06, 0)}, [](double t) { return Place{0, t, 0}; });
  March march(solid, {}, {}, {.step = step}, {}, everywhere(solid, {1, -1, 0}), Contact(solid, rising, usual));
  for (int call = 0; call < 40; ++call) {
    const March::State kept = march.state();
    march.advance(10);
    const Vector there = march.displacement();
    march.set_state(kept);
    march.advance(10, Vector::Constant(solid.unknowns(), 1));
    march.set_state(kept);
    march.advance(10);
    CHECK(march.displacement() == there);
  }
  CHECK(march.energies().supports > 0);
}

TEST_CASE("a step that contact makes too long is refused", "[unit][structure]") {
  const Solid solid(box_mesh(2, {0, 0.001, 0}, {0.1, 0.021, 0}, {4, 1, 1}), rubbery);
  const double alone = critical_step(solid, {});
  CHECK(Contact::critical_step(alone, 0.5) < 0.65 * alone);
  const auto start = [&](double stiffness, double step) {
    const March march(solid, {}, {}, {.step = step}, {}, {},
                      Contact(solid, standing(2, {segment(0, 0, 1, 0)}), stiffness));
  };
  CHECK_NOTHROW(start(0.5, 0.63 * alone));
  CHECK_THROWS_WITH(start(0.5, 0.64 * alone), Catch::Contains("2/omega_max"));
  CHECK_THROWS_AS(start(0, 0.5 * alone), CaseError);
}
