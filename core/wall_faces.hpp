#pragma once
// Walls on the host: straight segments in 2-D, triangles in 3-D. Fluid may be on either side of a wall, or on both.

#include <array>
#include <string>
#include <vector>

#include "core/real.hpp"

namespace greenwater {

/// A corner of a wall: where it is now and how it moves.
struct WallPoint {
  std::array<coord, 3> position{};      // [m]; z = 0 in 2-D
  std::array<coord, 3> velocity{};      // mean over the step that led here [m/s]
  std::array<coord, 3> acceleration{};  // [m/s^2]
};

struct WallFace {
  std::array<WallPoint, 3> corner;  // 2-D: a segment from the first to the second
  int body = 0;                     // which named geometry it belongs to
  bool repeated = false;            // it stands for one a period away, where space repeats itself
};

struct WallBody {
  std::string name;      // as in the case file
  bool no_slip = false;  // viscous fluid sticks to it
  bool bends = false;    // each of its faces goes its own way
};

struct WallFaces {
  int dim = 2;
  std::vector<WallFace> faces;
  std::vector<WallBody> bodies;
};

/// Two corners in 2-D, three in 3-D [m].
using FaceCorners = std::array<std::array<coord, 3>, 3>;
FaceCorners corners_of(const WallFace& face);

/// Unit normal: to the left of the segment, or by the right-hand rule of the triangle. Zero of a face without length or area.
std::array<coord, 3> face_normal(const FaceCorners& corner, int dim);

/// The shares of the corners at a place of the face's plane; their sum is 1. What is linear along the face is the sum of its
/// values at the corners, each times its share.
std::array<double, 3> shares_at(const WallFace& face, int dim, const std::array<coord, 3>& place);

/// Distance of a point to the nearest point of the segment or triangle [m].
coord distance_to_face(const FaceCorners& corner, int dim, const std::array<coord, 3>& x);

}  // namespace greenwater
