#include "app/build_walls.hpp"

#include <algorithm>
#include <cmath>

#include "app/motion.hpp"
#include "app/plate_frame.hpp"
#include "app/scene_shape.hpp"
#include "core/check.hpp"

namespace greenwater {
namespace {

int add_body(WallFaces& walls, const Scene& scene, const std::string& name) {
  const auto sticks = [&](const ViscosityCase& c) { return std::count(c.no_slip.begin(), c.no_slip.end(), name) > 0; };
  walls.bodies.push_back({name, std::any_of(scene.viscosity.begin(), scene.viscosity.end(), sticks)});
  return static_cast<int>(walls.bodies.size()) - 1;
}

void add_face(WallFaces& walls, int body, const Point& a, const Point& b, const Point& c = {}) {
  WallFace face;
  face.corner[0].position = a;
  face.corner[1].position = b;
  face.corner[2].position = c;
  face.body = body;
  walls.faces.push_back(face);
}

// a, b, c, d go round.
void add_rectangle(WallFaces& walls, int body, const Point& a, const Point& b, const Point& c, const Point& d) {
  add_face(walls, body, a, b, c);
  add_face(walls, body, a, c, d);
}

bool is_open(const BoxCase& box, const std::string& side) {
  return std::find(box.open.begin(), box.open.end(), side) != box.open.end();
}

// The side of a box at the low (0) or high (1) end of an axis.
std::string side_name(int dim, int axis, int end) { return box_sides(dim)[2 * axis + end]; }

void add_box(WallFaces& walls, const Scene& scene, const BoxCase& box) {
  const int body = add_body(walls, scene, box.name), dim = scene.dimension;
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      if (is_open(box, side_name(dim, axis, end))) continue;
      const auto at = [&](int b, int c) {  // low or high along the axes after this one
        Point x = box.min;
        if (end == 1) x[axis] = box.max[axis];
        if (b == 1) x[(axis + 1) % dim] = box.max[(axis + 1) % dim];
        if (c == 1) x[(axis + 2) % dim] = box.max[(axis + 2) % dim];
        return x;
      };
      if (dim == 2)
        add_face(walls, body, at(0, 0), at(1, 0));
      else
        add_rectangle(walls, body, at(0, 0), at(1, 0), at(1, 1), at(0, 1));
    }
}

void add_polyline(WallFaces& walls, const Scene& scene, const PolylineCase& line) {
  const int body = add_body(walls, scene, line.name);
  for (std::size_t k = 0; k + 1 < line.points.size(); ++k) add_face(walls, body, line.points[k], line.points[k + 1]);
  if (line.closed) add_face(walls, body, line.points.back(), line.points.front());
}

Point moved(const Point& from, double s, const Point& along) {
  return {from[0] + s * along[0], from[1] + s * along[1], from[2] + s * along[2]};
}

void add_plate_2d(WallFaces& walls, int body, const PlateCase& plate) {
  const PlateFrame frame = frame_of(plate, 2);
  const Point top = moved(frame.corner, plate.height, frame.up);
  add_face(walls, body, frame.corner, top);
  if (plate.thickness <= 0) return;
  add_face(walls, body, top, moved(top, plate.thickness, frame.right));
  add_face(walls, body, moved(top, plate.thickness, frame.right), moved(frame.corner, plate.thickness, frame.right));
}

void add_plate_3d(WallFaces& walls, int body, const PlateCase& plate) {
  const PlateFrame frame = frame_of(plate, 3);
  const auto at = [&](int up, int over, int right) {
    return moved(moved(moved(frame.corner, up * plate.height, frame.up), over * plate.width, frame.over),
                 right * plate.thickness, frame.right);
  };
  add_rectangle(walls, body, at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0));
  if (plate.thickness <= 0) return;
  add_rectangle(walls, body, at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
  add_rectangle(walls, body, at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  for (const int over : {0, 1})
    add_rectangle(walls, body, at(0, over, 0), at(1, over, 0), at(1, over, 1), at(0, over, 1));
}

// Its foot is no face: it stands on something.
void add_plate(WallFaces& walls, const Scene& scene, const PlateCase& plate) {
  const int body = add_body(walls, scene, plate.name);
  scene.dimension == 2 ? add_plate_2d(walls, body, plate) : add_plate_3d(walls, body, plate);
}

void add_mesh(WallFaces& walls, const Scene& scene, const MeshCase& mesh) {
  const int body = add_body(walls, scene, mesh.name);
  const auto& at = mesh.mesh.vertices;
  for (const auto& [a, b, c] : mesh.mesh.triangles) add_face(walls, body, at[a], at[b], at[c]);
}

// How far a body goes along an axis during the run, to either side.
double travel_of(const Scene& scene, const std::string& name, int axis) {
  constexpr int looks = 200;
  const auto names = wall_names(scene);
  if (std::find(names.begin(), names.end(), name) == names.end()) return 0;  // the rim
  const GeometryCase& geometry = geometry_named(scene, name);
  if (!geometry.motion) return 0;
  const Motion motion(*geometry.motion);
  double most = 0;
  for (int k = 1; k <= looks; ++k) most = std::max(most, std::fabs(motion.displacement(scene.end * k / looks)[axis]));
  return most;
}

void widen(Extent& extent, const WallFaces& walls) {
  for (const WallFace& face : walls.faces)
    for (int e = 0; e < walls.dim; ++e)
      for (int d = 0; d < walls.dim; ++d) {
        extent.low[d] = std::min(extent.low[d], face.corner[e].position[d]);
        extent.high[d] = std::max(extent.high[d], face.corner[e].position[d]);
      }
}

}  // namespace

WallFaces build_walls(const Scene& scene) {
  WallFaces walls;
  walls.dim = scene.dimension;
  for (const BoxCase& box : scene.boxes) add_box(walls, scene, box);
  for (const PolylineCase& line : scene.polylines) add_polyline(walls, scene, line);
  for (const PlateCase& plate : scene.plates) add_plate(walls, scene, plate);
  for (const MeshCase& mesh : scene.meshes) add_mesh(walls, scene, mesh);
  for (int axis = 0; axis < scene.dimension; ++axis)
    if (scene.repeats[axis]) repeat_walls(walls, scene, axis, 0);
  return walls;
}

void repeat_walls(WallFaces& walls, const Scene& scene, int axis, std::size_t first_face) {
  const MpsCase& mps = scene.mps;
  const double low = scene.domain_min[axis], high = scene.domain_max[axis], period = high - low;
  const double reach = 2 * mps.spacing * std::max({mps.radius_density, mps.radius_gradient, mps.radius_laplacian});
  std::vector<double> beyond;  // of each body: what must be covered on either side of the domain
  for (const WallBody& body : walls.bodies) beyond.push_back(reach + travel_of(scene, body.name, axis));
  constexpr double most_copies = 1e5;  // of a wall
  const std::vector<WallFace> once(walls.faces.begin() + static_cast<std::ptrdiff_t>(first_face), walls.faces.end());
  for (const WallFace& face : once) {
    double from = face.corner[0].position[axis], to = from;
    for (int e = 1; e < walls.dim; ++e) {
      from = std::min(from, face.corner[e].position[axis]);
      to = std::max(to, face.corner[e].position[axis]);
    }
    const double more = beyond[face.body];
    const double first = std::ceil((low - more - to) / period), last = std::floor((high + more - from) / period);
    require_at(scene.repeats_place, last - first <= most_copies, "the wall \"", walls.bodies[face.body].name,
               "\" would be repeated ", last - first, " times, as it goes or lies that many periods of ", period,
               " m away from the domain; let it move less far, or put it inside");
    for (double k = first; k <= last; ++k) {
      if (k == 0) continue;
      WallFace copy = face;
      copy.repeated = true;
      for (int e = 0; e < walls.dim; ++e) copy.corner[e].position[axis] += k * period;
      walls.faces.push_back(copy);
    }
  }
}

WallMotion build_motion(const Scene& scene) {
  // The faces at t = 0, and the motion of each body; null for those that stand.
  struct Moving {
    WallFaces start;
    std::vector<std::unique_ptr<Motion>> of_body;
  };
  const auto moving = std::make_shared<Moving>();
  moving->start = build_walls(scene);
  bool any = false;
  for (const WallBody& body : moving->start.bodies) {
    const GeometryCase& geometry = geometry_named(scene, body.name);
    moving->of_body.push_back(geometry.motion ? std::make_unique<Motion>(*geometry.motion) : nullptr);
    any = any || geometry.motion;
  }
  if (!any) return {};
  return [moving](WallFaces& faces, double t) {
    for (std::size_t f = 0; f < moving->start.faces.size(); ++f) {  // those of structures come after them
      const WallFace& start = moving->start.faces[f];
      const auto& motion = moving->of_body[start.body];
      if (!motion) continue;
      for (int e = 0; e < faces.dim; ++e) faces.faces[f].corner[e].position = motion->at(start.corner[e].position, t);
    }
  };
}

Extent scene_extent(const Scene& scene, WallFaces walls) {
  constexpr int looks = 200;  // along the run, at walls that move
  Extent extent{scene.fluid.min, scene.fluid.max};
  widen(extent, walls);
  if (const auto motion = build_motion(scene))
    for (int k = 1; k <= looks; ++k) {
      motion(walls, scene.end * k / looks);
      widen(extent, walls);
    }
  return extent;
}

bool closed_at(const Scene& scene, int axis, int end, double at) {
  return std::any_of(scene.boxes.begin(), scene.boxes.end(), [&](const BoxCase& box) {
    return !is_open(box, side_name(scene.dimension, axis, end)) &&
           std::fabs((end == 1 ? box.max : box.min)[axis] - at) < 1e-6 * scene.mps.spacing;
  });
}

}  // namespace greenwater
