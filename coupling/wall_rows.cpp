#include "coupling/wall_rows.hpp"

#include <algorithm>

namespace greenwater {
namespace {

using Point = std::array<double, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Sums the entries of one particle, unknown by unknown.
class OneParticle {
 public:
  OneParticle(int first_unknown, int unknowns)
      : first_unknown_(first_unknown), sum_(unknowns, 0.0), touched_(unknowns, 0) {}

  void add(int unknown, double value) {
    if (touched_[unknown] == 0) list_.push_back(unknown);
    touched_[unknown] = 1;
    sum_[unknown] += value;
  }

  void hand_over(int particle, std::vector<AddedEntry>& rows) {
    std::sort(list_.begin(), list_.end());
    for (const int unknown : list_) {
      if (sum_[unknown] != 0) rows.push_back({particle, first_unknown_ + unknown, static_cast<real>(sum_[unknown])});
      sum_[unknown] = 0;
      touched_[unknown] = 0;
    }
    list_.clear();
  }

 private:
  int first_unknown_;
  std::vector<double> sum_;
  std::vector<char> touched_;
  std::vector<int> list_;
};

}  // namespace

std::array<double, 3> shares_at(const WallFace& face, int dim, const Point& place) {
  const Point a = face.corner[0].position, r = minus(place, a), s = minus(face.corner[1].position, a);
  if (dim == 2) {
    const double t = dot(r, s) / dot(s, s);
    return {1 - t, t, 0};
  }
  const Point q = minus(face.corner[2].position, a);
  const double ss = dot(s, s), sq = dot(s, q), qq = dot(q, q), det = ss * qq - sq * sq;
  const double t = (qq * dot(r, s) - sq * dot(r, q)) / det, u = (ss * dot(r, q) - sq * dot(r, s)) / det;
  return {1 - t - u, t, u};
}

void add_wall_rows(const std::vector<WallPush>& pushes, const WallFaces& walls, const WetSurface& surface,
                   int first_face, int first_unknown, std::vector<AddedEntry>& rows) {
  OneParticle sums(first_unknown, walls.dim * surface.corners());
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const WallPush& push = pushes[k];
    const auto share = shares_at(walls.faces[push.face], walls.dim, push.place);
    const auto& corners = surface.corner_of_face()[push.face - first_face];
    for (int e = 0; e < walls.dim; ++e)
      for (int d = 0; d < walls.dim; ++d) sums.add(walls.dim * corners[e] + d, share[e] * push.push[d]);
    if (k + 1 == pushes.size() || pushes[k + 1].particle != push.particle) sums.hand_over(push.particle, rows);
  }
}

}  // namespace greenwater
