// The load on a surface is the pressure on it, whatever the particles do.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "kernels/operators/rigid_walls.hpp"
#include "tests/catch.hpp"
#include "tests/still_water.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

/// What a pressure that is constant or that of rest gives at the places of a body.
struct Loads {
  double area = 0, uncovered = 0;  // of places that are not at the rim, where the water ends as well [m], [m^2]
  double worst_constant = 0;       // of covered places: |sum W / A - 1|
  double most = 0;                 // of all places: sum W / A
  double worst_at_rest = 0;        // of faces that are covered: off the exact force, over that
};

/// Where p is that of rest, at x.
double rest_pressure(const Fluid& fluid, const Triple& x) {
  const int up = fluid.particles.dim - 1;
  return fluid.rho * g * (3 - x[up]);  // never near 0
}

Loads loads_of(Fluid& fluid, int body, WetSide wet, const std::function<bool(const Triple&)>& inner) {
  SurveyOptions options;
  options.loads = true;
  const Survey found = surveyed(fluid, options);
  const auto pushes = wall_pushes(fluid, found, body);
  std::vector<int> faces;
  for (std::size_t f = 0; f < fluid.faces.faces.size(); ++f)
    if (fluid.faces.faces[f].body == body) faces.push_back(static_cast<int>(f));
  WallQuadrature quadrature(fluid.faces, faces, wet, fluid.grid.shape(), fluid.spacing);
  quadrature.weigh(pushes);
  const auto x = host(fluid.particles.position);
  const auto& points = quadrature.points();
  std::vector<double> constant(points.size(), 0), at_rest(points.size(), 0);
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const WallPush& push = pushes[k];
    Triple xi{};
    for (int d = 0; d < fluid.particles.dim; ++d) xi[d] = x(push.particle, d);
    quadrature.for_each(k, [&](int q, const Triple& from_particle, double weight) {
      constant[q] += weight;
      at_rest[q] += weight * (rest_pressure(fluid, xi) + fluid.rho * dot(push.drive, from_particle));
    });
  }
  Loads found_loads;
  std::vector<double> force(fluid.faces.faces.size() * 2, 0), exact(force), dry(force);
  for (std::size_t q = 0; q < points.size(); ++q) {
    const QuadraturePoint& at = points[q];
    const bool covered = quadrature.cover(static_cast<int>(q)) >= WallQuadrature::least_cover;
    if (inner(at.place)) {
      found_loads.area += at.area;
      if (!covered) found_loads.uncovered += at.area;
    }
    found_loads.most = std::max(found_loads.most, constant[q] / at.area);
    const std::size_t side = 2 * at.face + (wet == WetSide::both ? q % 2 : 0);
    if (!covered) {
      dry[side] += at.area;
      continue;
    }
    found_loads.worst_constant = std::max(found_loads.worst_constant, std::fabs(constant[q] / at.area - 1));
    force[side] += at_rest[q];
    exact[side] += rest_pressure(fluid, at.place) * at.area;
  }
  for (std::size_t k = 0; k < force.size(); ++k)
    if (dry[k] == 0 && exact[k] > 0)
      found_loads.worst_at_rest = std::max(found_loads.worst_at_rest, std::fabs(force[k] / exact[k] - 1));
  return found_loads;
}

struct Arrangement {
  const char* name;
  double first;    // distance of the first row [l0]
  double jitter;   // [l0]
  double squeeze;  // of all distances
};

const Arrangement arrangements[] = {{"lattice", 0.5, 0, 1},       {"row at 0.3", 0.3, 0, 1},
                                    {"row at 0.4", 0.4, 0, 1},    {"row at 0.6", 0.6, 0, 1},
                                    {"row at 0.7", 0.7, 0, 1},    {"row at 0.8", 0.8, 0, 1},
                                    {"jitter 20 %", 0.5, 0.2, 1}, {"squeezed to 0.8", 0.5, 0, 0.8}};

/// Particles over a floor in the way of the arrangement: of `wide` x `high` rows (and `wide` across), from x = 0 on.
Positions rows_over_floor(int dim, const Arrangement& how, int wide, int high) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<coord> shake(-how.jitter * l0, how.jitter * l0);
  const coord step = how.squeeze * l0;
  Positions x;
  for (int k = 0; k < (dim == 3 ? wide : 1); ++k)
    for (int j = 0; j < high; ++j)
      for (int i = 0; i < wide; ++i) {
        const coord along = (i + 0.5) * step + shake(generator), up = (how.first * how.squeeze + j * how.squeeze) * l0;
        const coord height = std::max(up + shake(generator), 0.05 * l0);
        if (dim == 2)
          x.push_back({along, height, 0});
        else
          x.push_back({along, (k + 0.5) * step + shake(generator), height});
      }
  return x;
}

/// Turns a floor and what is over it about the x-z plane's origin.
template <class P>
void turn(P& x, int dim, double angle) {
  const int up = dim - 1;
  const double c = std::cos(angle), s = std::sin(angle), a = x[0], b = x[up];
  x[0] = c * a - s * b;
  x[up] = s * a + c * b;
}

Fluid over_floor(int dim, const Arrangement& how, double angle, double bend, bool two_sided) {
  const int wide = dim == 2 ? 24 : 12, high = dim == 2 ? 8 : 5;
  const coord length = wide * how.squeeze * l0;
  auto positions = rows_over_floor(dim, how, wide, high);
  if (two_sided) {
    const auto above = positions;
    for (auto x : above) {
      x[dim - 1] *= -1;
      positions.push_back(x);
    }
  }
  WallFaces walls;
  walls.dim = dim;
  constexpr int faces = 6;  // along x
  for (int f = 0; f < faces; ++f) {
    const coord a = length * f / faces, b = length * (f + 1) / faces;
    if (dim == 2) {
      walls.faces.push_back(segment(a, 0, b, 0));
      continue;
    }
    const std::array<coord, 3> p{a, 0, 0}, q{b, 0, 0}, r{b, length, 0}, s{a, length, 0};
    walls.faces.push_back(triangle(p, q, r));
    walls.faces.push_back(triangle(p, r, s));
  }
  walls.bodies.push_back({"floor", false, bend != 0});
  const auto bent = [&](auto& x) { x[dim - 1] += bend * x[0] * (length - x[0]) / length; };
  for (WallFace& face : walls.faces)
    for (int e = 0; e < dim; ++e) {
      bent(face.corner[e].position);
      turn(face.corner[e].position, dim, angle);
    }
  for (auto& x : positions) {
    bent(x);
    turn(x, dim, angle);
  }
  Fluid fluid = fluid_at(positions, walls, standard(dim, dim == 2 ? 3.1 : 2.1));
  fluid.gravity[dim - 1] = -g;
  return fluid;
}

}  // namespace

TEST_CASE("a constant pressure and that of rest are the load, face by face, however particles lie",
          "[unit][coupling]") {
  struct Shape {
    const char* name;
    double angle, bend;
    bool two_sided;
  };
  const Shape shapes[] = {
      {"flat", 0, 0, false}, {"sloping", 0.6, 0, false}, {"two-sided", 0, 0, true}, {"bent", 0, 0.15, false}};
  for (const int dim : {2, 3})
    for (const Shape& shape : shapes)
      for (const Arrangement& how : arrangements) {
        INFO(dim << "-D, " << shape.name << ", " << how.name);
        Fluid fluid = over_floor(dim, how, shape.angle, shape.bend, shape.two_sided);
        const WetSide wet = shape.two_sided ? WetSide::both : WetSide::along_normal;
        const double length = fluid.particles.dim == 2 ? 24 * how.squeeze * l0 : 12 * how.squeeze * l0;
        const auto inner = [&](Triple x) {
          turn(x, dim, -shape.angle);
          const auto away = [&](double along) { return along > 1.5 * l0 && along < length - 1.5 * l0; };
          return away(x[0]) && (dim == 2 || away(x[1]));
        };
        const Loads loads = loads_of(fluid, 0, wet, inner);
        if (loads.uncovered > 0)
          WARN(dim << "-D, " << shape.name << ", " << how.name << ": " << 100 * loads.uncovered / loads.area
                   << " % of the places are not covered");
        CHECK(loads.worst_constant < 1e-10);
        CHECK(loads.worst_at_rest < 5e-3);
        CHECK(loads.most < 1 + 1e-10);
        if (how.jitter == 0 && how.first <= 0.7) CHECK(loads.uncovered == 0);
      }
}

TEST_CASE("fluid and wall that go together, or turn together, sweep nothing beyond what the survey has seen",
          "[unit][coupling]") {
  for (const int dim : {2, 3})
    for (const Arrangement& how : arrangements)
      for (const bool turns : {false, true}) {
        INFO(dim << "-D, " << how.name << (turns ? ", turning" : ", going"));
        Fluid fluid = over_floor(dim, how, 0.6, 0, false);
        const int up = dim - 1;
        const auto speed = [&](const Triple& x) {
          Triple v{0.3, dim == 3 ? 0.2 : 0, 0};
          v[up] = -0.4;
          if (turns) {
            v[0] -= 0.7 * x[up];
            v[up] += 0.7 * x[0];
          }
          return v;
        };
        for (WallFace& face : fluid.faces.faces)
          for (int e = 0; e < dim; ++e) face.corner[e].velocity = speed(face.corner[e].position);
        make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), l0);
        fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
        set_velocity(fluid, speed);
        SurveyOptions options;
        options.loads = true;
        const Survey found = surveyed(fluid, options);
        const auto before = Kokkos::create_mirror(found.rhs);
        Kokkos::deep_copy(before, found.rhs);
        RigidWalls walls;
        walls.join(fluid, found, found.rhs, dt);
        const auto after = host(found.rhs);
        double worst = 0;
        for (int i = 0; i < fluid.particles.count; ++i)
          worst = std::max(worst, std::fabs(static_cast<double>(after(i) - before(i))));
        CHECK(worst * dt / fluid.rho < 1e-12);
      }
}

TEST_CASE("a wall that moves sweeps its area times its speed, however particles lie", "[unit][coupling]") {
  for (const int dim : {2, 3})
    for (const Arrangement& how : arrangements) {
      if (how.first > 0.7) continue;
      INFO(dim << "-D, " << how.name);
      Fluid fluid = over_floor(dim, how, 0, 0, false);
      const int up = dim - 1;
      fluid.gravity[up] = 0;
      double area = 0;
      for (WallFace& face : fluid.faces.faces)
        for (int e = 0; e < dim; ++e) face.corner[e].velocity[up] = 0.5;
      make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), l0);
      fluid.rows.build(fluid.particles, fluid.grid, fluid.walls, row_options(fluid));
      SurveyOptions options;
      options.loads = true;
      const Survey found = surveyed(fluid, options);
      WallQuadrature quadrature;
      const auto pushes = wall_pushes(fluid, found, 0);
      std::vector<int> faces(fluid.faces.faces.size());
      for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = static_cast<int>(f);
      quadrature = WallQuadrature(fluid.faces, faces, WetSide::along_normal, fluid.grid.shape(), l0);
      quadrature.weigh(pushes);
      for (std::size_t q = 0; q < quadrature.points().size(); ++q)
        area += std::min(1.0, quadrature.cover(static_cast<int>(q)) / WallQuadrature::least_cover) *
                quadrature.points()[q].area;
      double swept = 0;  // the fluid is at rest: what the places give, and nothing else
      for (std::size_t k = 0; k < pushes.size(); ++k)
        quadrature.for_each(
            k, [&](int q, const Triple&, double weight) { swept -= weight * 0.5 * quadrature.points()[q].normal[up]; });
      CHECK(swept == Approx(0.5 * area).epsilon(1e-10));
    }
}

TEST_CASE("pairs that lie evenly about a joint of a bent wall have one image there", "[unit][corners]") {
  const Arrangement lattice{"lattice", 0.5, 0, 1};  // joints midway between two columns
  const auto n_of = [&](double bend) {
    const Fluid fluid = over_floor(2, lattice, 0, bend, false);
    const auto n = host(fluid.particles.number_density);
    std::vector<double> sorted(n.data(), n.data() + fluid.particles.count);  // particles are in another order
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  const auto flat = n_of(0);
  for (const double bend : {1e-5, 1e-3, -1e-5, -1e-3}) {  // kinks are a third of it
    INFO("bend " << bend);
    Fluid fluid = over_floor(2, lattice, 0, bend, false);
    SurveyOptions options;
    options.loads = true;
    const Survey found = surveyed(fluid, options);
    double area = 0;  // of pushes within 2 l0 of the joint in the middle
    for (const WallPush& push : wall_pushes(fluid, found, 0))
      if (std::fabs(push.from_particle[0] + host(fluid.particles.position)(push.particle, 0) - 12 * l0) < 2 * l0)
        area += push.area;
    CHECK(area == Approx(4 * l0).epsilon(2e-3));
    const auto n = n_of(bend);
    double worst = 0;
    for (std::size_t i = 0; i < n.size(); ++i) worst = std::max(worst, std::fabs(n[i] / flat[i] - 1));
    CHECK(worst < 2e-3);
  }
}
