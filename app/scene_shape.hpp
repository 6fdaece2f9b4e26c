#pragma once
// Geometries as points and bounds, on the host: for checks, before anything is built.

#include <vector>

#include "app/scene_parts.hpp"

namespace greenwater {

/// One geometry of any kind.
struct Shape {
  const GeometryCase* geometry = nullptr;
  const char* kind = "";  // box | polyline | plate | mesh
  Corners bounds;         // [m] at t = 0
};

/// All geometries: boxes, polylines, plates, meshes.
std::vector<Shape> shapes_of(const Scene& scene);

/// The geometry of this name, which must be there.
const GeometryCase& geometry_named(const Scene& scene, const std::string& name);

/// `[0.3, -0.05]`: a computed point for messages, without the digits of round-off.
std::string shown_point(const Point& x, int dimension);

/// The cross-section of a plate in the plane of its height and thickness: foot, top, and back to the foot. Coordinates
/// are x and the last axis [m]; two points where it has no thickness, else four, clockwise for those who see x to the
/// right.
std::vector<std::array<double, 2>> plate_section(const PlateCase& plate, int dimension);

/// True when the point is inside the closed polyline; on it, either.
bool inside_polyline(const PolylineCase& line, const Point& x);

/// Whether the fluid fills the inside of a closed polyline or mesh, to which no lattice fits.
bool fills_closed_shape(const Scene& scene);

/// True when the point is closer to the centre than the radius.
bool inside_ball(const BallCase& ball, const Point& x);

/// How far any point of a moving geometry is from its axis of rotation, at most [m].
double reach_of(const Shape& shape);

}  // namespace greenwater
