#include "app/rim.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "app/build_walls.hpp"
#include "app/room.hpp"
#include "app/scene_shape.hpp"
#include "core/point_math.hpp"
#include "core/whole.hpp"

namespace greenwater {
namespace {

constexpr int most_sides = 1 << 29;

void add_face(WallFaces& walls, const Point& a, const Point& b, const Point& c = {}) {
  WallFace face;
  face.corner[0].position = a;
  face.corner[1].position = b;
  face.corner[2].position = c;
  face.body = static_cast<int>(walls.bodies.size()) - 1;
  walls.faces.push_back(face);
}

// ---- Boxes

// A side of the region: the axis that it stands across, and where [m].
struct Side {
  int axis;
  double at;
};

// Where walls that come to the side begin, end, or pass through it at right angles, along an axis in it; with its own ends.
std::vector<double> cuts_along(const Scene& scene, const WallFaces& walls, const Side& side, int axis) {
  const double low = scene.fluid.min[axis], high = scene.fluid.max[axis], touch = 1e-6 * scene.mps.spacing;
  std::vector<double> cuts{low, high};
  for (const WallFace& face : walls.faces) {
    const auto range = [&](int d) {
      double from = face.corner[0].position[d], to = from;
      for (int e = 1; e < walls.dim; ++e) {
        from = std::min(from, face.corner[e].position[d]);
        to = std::max(to, face.corner[e].position[d]);
      }
      return std::pair{from, to};
    };
    const auto [bottom, top] = range(side.axis);
    if (bottom > side.at + touch || top < side.at - touch) continue;
    const auto [from, to] = range(axis);
    if (to - from > touch && top - bottom > touch) continue;  // slanting
    for (const double cut : {from, to})
      if (cut > low + touch && cut < high - touch) cuts.push_back(cut);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end(), [&](double a, double b) { return b - a < touch; }), cuts.end());
  return cuts;
}

bool on_a_wall(const Scene& scene, const WallFaces& walls, const Point& x) {
  return std::any_of(walls.faces.begin(), walls.faces.end(), [&](const WallFace& face) {
    return distance_to_face(corners_of(face), walls.dim, x) < 1e-6 * scene.mps.spacing;
  });
}

void add_side(const Scene& scene, const Room& room, const WallFaces& walls, const Side& side, WallFaces& closed) {
  const int a = (side.axis + 1) % scene.dimension, b = (side.axis + 2) % scene.dimension;
  const bool flat = scene.dimension == 2;
  const auto along = cuts_along(scene, walls, side, a);
  const auto across = flat ? std::vector<double>{0, 0} : cuts_along(scene, walls, side, b);
  for (std::size_t k = 0; k + 1 < across.size(); ++k)
    for (std::size_t i = 0; i + 1 < along.size(); ++i) {
      const auto at = [&](double s, double t) {
        Point x{};
        if (!flat) x[b] = across[k] + t * (across[k + 1] - across[k]);
        x[a] = along[i] + s * (along[i + 1] - along[i]);
        x[side.axis] = side.at;
        return x;
      };
      const Point middle = at(0.5, 0.5);
      if (on_a_wall(scene, walls, middle) || room.in_solid(middle)) continue;
      if (flat) {
        add_face(closed, at(0, 0), at(1, 0));
      } else {
        add_face(closed, at(0, 0), at(1, 0), at(1, 1));
        add_face(closed, at(0, 0), at(1, 1), at(0, 1));
      }
    }
}

void add_sides(const Scene& scene, const WallFaces& walls, WallFaces& closed) {
  const Room room(scene);
  const double touch = 1e-6 * scene.mps.spacing;
  for (int axis = 0; axis < scene.dimension; ++axis)
    for (const bool high : {false, true}) {
      const Side side{axis, (high ? scene.fluid.max : scene.fluid.min)[axis]};
      const double edge = (high ? scene.domain_max : scene.domain_min)[axis];
      if (scene.repeats[axis] && std::fabs(side.at - edge) < touch) continue;
      add_side(scene, room, walls, side, closed);
    }
}

// ---- The lid of an inside

void add_lid(const Scene& scene, WallFaces& closed) {
  const double beyond = 5 * scene.mps.spacing, level = scene.fluid.level;
  const double x0 = scene.fluid.min[0] - beyond, x1 = scene.fluid.max[0] + beyond;
  const double y0 = scene.fluid.min[1] - beyond, y1 = scene.fluid.max[1] + beyond;
  if (scene.dimension == 2) return add_face(closed, {x0, level, 0}, {x1, level, 0});
  add_face(closed, {x0, y0, level}, {x1, y0, level}, {x1, y1, level});
  add_face(closed, {x0, y0, level}, {x1, y1, level}, {x0, y1, level});
}

// ---- Balls

// A ball that touches a wall gets a rim a little inside, or the two would meet at no angle.
double rim_radius(const Scene& scene, const WallFaces& walls, double wanted) {
  const BallCase& ball = *scene.fluid.ball;
  const double near = 0.05 * scene.mps.spacing;
  for (const WallFace& face : walls.faces)
    if (std::fabs(distance_to_face(corners_of(face), walls.dim, ball.centre) - ball.radius) < near)
      return ball.radius - 0.02 * scene.mps.spacing;
  return wanted;
}

void add_circle(const Scene& scene, const WallFaces& walls, WallFaces& closed) {
  const BallCase& ball = *scene.fluid.ball;
  constexpr double round = 2 * std::numbers::pi;
  const int sides = whole_within(std::ceil(round * ball.radius / scene.mps.spacing), 24, most_sides);
  const double angle = round / sides;
  const double radius = rim_radius(scene, walls, ball.radius * std::sqrt(angle / std::sin(angle)));
  const auto corner = [&](int k) {
    return Point{ball.centre[0] + radius * std::cos(k % sides * angle),
                 ball.centre[1] + radius * std::sin(k % sides * angle), 0};
  };
  for (int k = 0; k < sides; ++k) add_face(closed, corner(k), corner(k + 1));
}

using Facets = std::vector<std::array<Triple, 3>>;

// Of the unit sphere.
Facets octahedron() {
  Facets facets;
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) facets.push_back({Triple{x, 0, 0}, Triple{0, y, 0}, Triple{0, 0, z}});
  return facets;
}

Facets quartered(const Facets& facets) {
  const auto between = [](const Triple& a, const Triple& b) {
    const Triple middle = sum(a, b);
    return scaled(middle, 1 / length(middle));
  };
  Facets finer;
  for (const auto& [a, b, c] : facets) {
    const Triple ab = between(a, b), bc = between(b, c), ca = between(c, a);
    for (const auto& facet :
         {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
      finer.push_back(facet);
  }
  return finer;
}

void add_sphere(const Scene& scene, const WallFaces& walls, WallFaces& closed) {
  const BallCase& ball = *scene.fluid.ball;
  const auto longest = [](const Facets& facets) {
    double most = 0;
    for (const auto& [a, b, c] : facets) most = std::max({most, distance(a, b), distance(b, c), distance(c, a)});
    return most;
  };
  Facets facets = quartered(quartered(octahedron()));
  while (longest(facets) * ball.radius > 2 * scene.mps.spacing) facets = quartered(facets);
  double volume = 0;
  for (const auto& [a, b, c] : facets) volume += std::fabs(dot(a, cross(b, c))) / 6;
  const double radius = rim_radius(scene, walls, ball.radius * std::cbrt(4.0 / 3 * std::numbers::pi / volume));
  const auto at = [&](const Triple& unit) { return sum(ball.centre, scaled(unit, radius)); };
  for (const auto& [a, b, c] : facets) add_face(closed, at(a), at(b), at(c));
}

}  // namespace

WallFaces with_rim(const Scene& scene, const WallFaces& walls) {
  WallFaces closed = walls;
  closed.bodies.push_back({"rim", false, false});
  if (scene.fluid.ball)
    scene.dimension == 2 ? add_circle(scene, walls, closed) : add_sphere(scene, walls, closed);
  else if (fills_closed_shape(scene))
    add_lid(scene, closed);
  else
    add_sides(scene, walls, closed);
  for (int axis = 0; axis < scene.dimension; ++axis)
    if (scene.repeats[axis]) repeat_walls(closed, scene, axis, walls.faces.size());
  return closed;
}

}  // namespace greenwater
