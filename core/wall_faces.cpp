#include "core/wall_faces.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

using Place = std::array<coord, 3>;

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
coord dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

coord distance_to_segment(const Place& a, const Place& b, const Place& x) {
  const Place along = minus(b, a), from = minus(x, a);
  const coord length2 = dot(along, along), s = length2 > 0 ? std::clamp(dot(from, along) / length2, 0.0, 1.0) : 0;
  const Place rest = minus(from, {s * along[0], s * along[1], s * along[2]});
  return std::sqrt(dot(rest, rest));
}

}  // namespace

Place face_normal(const FaceCorners& c, int dim) {
  const Place a = minus(c[1], c[0]);
  Place n = dim == 2 ? Place{-a[1], a[0], 0} : cross(a, minus(c[2], c[0]));
  const coord length = std::sqrt(dot(n, n));
  if (!(length > 0)) return {};
  for (coord& component : n) component /= length;
  return n;
}

std::array<double, 3> shares_at(const WallFace& face, int dim, const Place& place) {
  const Place a = face.corner[0].position, r = minus(place, a), s = minus(face.corner[1].position, a);
  if (dim == 2) {
    const double t = dot(r, s) / dot(s, s);
    return {1 - t, t, 0};
  }
  const Place q = minus(face.corner[2].position, a);
  const double ss = dot(s, s), sq = dot(s, q), qq = dot(q, q), det = ss * qq - sq * sq;
  const double t = (qq * dot(r, s) - sq * dot(r, q)) / det, u = (ss * dot(r, q) - sq * dot(r, s)) / det;
  return {1 - t - u, t, u};
}

coord distance_to_face(const FaceCorners& c, int dim, const Place& x) {
  if (dim == 2) return distance_to_segment(c[0], c[1], x);
  const Place n = face_normal(c, 3);
  bool above = n != Place{};
  coord to_edge = distance_to_segment(c[2], c[0], x);
  for (int e = 0; e < 3; ++e) {
    const Place &from = c[e], &to = c[(e + 1) % 3];
    above = above && dot(cross(n, minus(to, from)), minus(x, from)) >= 0;
    to_edge = std::min(to_edge, distance_to_segment(from, to, x));
  }
  return above ? std::fabs(dot(n, minus(x, c[0]))) : to_edge;
}

FaceCorners corners_of(const WallFace& face) {
  return {face.corner[0].position, face.corner[1].position, face.corner[2].position};
}

}  // namespace greenwater
