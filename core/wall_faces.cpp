#include "core/wall_faces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace greenwater {
namespace {

struct Line {  // a face as a stretch of its line
  std::array<coord, 2> direction;
  coord length;
};

Line line_of(const WallFace& face) {
  const coord x = face.end[1][0] - face.end[0][0], y = face.end[1][1] - face.end[0][1];
  const coord length = std::hypot(x, y);
  return {{x / length, y / length}, length};
}

// Takes `other` into `face` when both lie on one line, touch and move alike.
bool absorb(WallFace& face, const WallFace& other, coord tolerance) {
  if (face.velocity != other.velocity || face.acceleration != other.acceleration) return false;
  const Line line = line_of(face);
  std::array<coord, 2> place{};
  for (int e = 0; e < 2; ++e) {
    const coord x = other.end[e][0] - face.end[0][0], y = other.end[e][1] - face.end[0][1];
    if (std::fabs(x * line.direction[1] - y * line.direction[0]) > tolerance) return false;
    place[e] = x * line.direction[0] + y * line.direction[1];
  }
  const auto [low, high] = std::minmax(place[0], place[1]);
  if (low > line.length + tolerance || high < -tolerance) return false;
  if (line_of(other).length > line.length) face.body = other.body;
  const auto start = face.end[0];
  const coord from = std::min(low, coord(0)), to = std::max(high, line.length);
  for (int d = 0; d < 2; ++d) {
    face.end[0][d] = start[d] + from * line.direction[d];
    face.end[1][d] = start[d] + to * line.direction[d];
  }
  return true;
}

}  // namespace

void merge_collinear(WallFaces& walls, coord tolerance) {
  auto& faces = walls.faces;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (std::size_t j = i + 1; j < faces.size();)
      if (absorb(faces[i], faces[j], tolerance)) {
        faces.erase(faces.begin() + static_cast<std::ptrdiff_t>(j));
        j = i + 1;  // the longer face may touch one that was passed
      } else {
        ++j;
      }
}

}  // namespace greenwater
