#include "app/fill.hpp"

#include <algorithm>
#include <cmath>

#include "app/plan.hpp"
#include "app/random.hpp"
#include "app/relaxed_start.hpp"
#include "app/scene_shape.hpp"
#include "core/whole.hpp"

namespace greenwater {
namespace {

constexpr int most_cells = 1 << 29;  // along an axis

// Cell centres of a lattice in the fluid's bounds, from `from` on.
std::vector<Point> lattice(const FluidCase& fluid, const Point& from, double spacing, int dimension) {
  const auto cells = lattice_cells(fluid, spacing, dimension);
  const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]), nz = static_cast<int>(cells[2]);
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(nx) * ny * nz);
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        points.push_back({from[0] + (i + 0.5) * spacing, from[1] + (j + 0.5) * spacing,
                          dimension == 3 ? from[2] + (k + 0.5) * spacing : 0.0});
  return points;
}

// Cells about the centre, which is a corner of four of them, in 3-D of eight: those whose own centre is in the ball. Told
// in cells, where centres are exact, so that nothing but the centre's own digits spoils the symmetry.
std::vector<Point> lattice_in_ball(const BallCase& ball, double spacing, int dimension) {
  const double radius = ball.radius / spacing;
  const int n = whole_within(std::ceil(radius - 0.5), 0, most_cells), nz = dimension == 3 ? n : 0;
  const double middle_z = dimension == 3 ? 0.5 : 0;
  std::vector<Point> points;
  for (int k = -nz; k < std::max(nz, 1); ++k)
    for (int j = -n; j < n; ++j)
      for (int i = -n; i < n; ++i) {
        const Point cell{i + 0.5, j + 0.5, k + middle_z};
        if (cell[0] * cell[0] + cell[1] * cell[1] + cell[2] * cell[2] >= radius * radius) continue;
        points.push_back(ball.centre);
        for (std::size_t d = 0; d < 3; ++d) points.back()[d] += cell[d] * spacing;
      }
  return points;
}

// Each by its own number; who would end in a solid, or beside a ball, stays.
void shake(const Room& room, const Scene& scene, std::vector<Point>& points) {
  const double most = scene.fluid.jitter * scene.mps.spacing;
  if (most == 0) return;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Point x = points[i];
    for (std::size_t d = 0; d < static_cast<std::size_t>(scene.dimension); ++d) x[d] += most * random_of(3 * i + d);
    const bool leaves = scene.fluid.ball && !inside_ball(*scene.fluid.ball, x);
    if (!leaves && !room.in_solid(x)) points[i] = x;
  }
}

}  // namespace

std::vector<Point> fill(const Scene& scene) {
  const FluidCase& fluid = scene.fluid;
  const Room room(scene);
  const bool relaxed = fluid.packing == "relaxed";
  std::vector<Point> points = relaxed      ? relaxed_start(room, scene)
                              : fluid.ball ? lattice_in_ball(*fluid.ball, scene.mps.spacing, scene.dimension)
                                           : lattice(fluid, fluid.min, scene.mps.spacing, scene.dimension);
  if (!relaxed)
    points.erase(std::remove_if(points.begin(), points.end(), [&](const Point& x) { return room.in_solid(x); }),
                 points.end());
  require_at(scene.fluid.place, !points.empty(),
             "the fluid's region holds no particle: enlarge it or take a smaller mps.spacing");
  if (!relaxed) shake(room, scene, points);
  return points;
}

}  // namespace greenwater
