#pragma once
// Small geometry of wall pieces, on the host, for the files that make panels and corners.

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "kernels/wall_panels.hpp"

namespace greenwater::wall_geometry {

using Vector = Eigen::Matrix<coord, 3, 1>;
using Matrix = Eigen::Matrix<coord, 3, 3>;

constexpr coord parallel = 1e-7;  // sine of an angle below which two planes are one

inline Vector vec(const std::array<coord, 3>& a) { return {a[0], a[1], a[2]}; }
inline Vector vec(const coord* a) { return {a[0], a[1], a[2]}; }
inline void put(coord* to, const Vector& from) { std::copy(from.data(), from.data() + 3, to); }

inline Vector corner(const Piece& piece, int e) { return vec(piece.corner[e]); }
inline Vector normal_of(const Panel& panel) { return vec(panel.normal); }

struct Bounds {
  Vector low, high;
  bool touch(const Bounds& other, coord tolerance) const {
    return (low.array() - tolerance <= other.high.array()).all() &&
           (other.low.array() - tolerance <= high.array()).all();
  }
  void take_in(const Bounds& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
};

// Calls f(i, j), i < j, for all boxes that touch.
template <class F>
inline void for_each_touching(const std::vector<Bounds>& boxes, coord tolerance, F f) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return boxes[a].low[0] < boxes[b].low[0]; });
  std::vector<std::pair<int, int>> found;
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t m = k + 1; m < order.size(); ++m) {
      if (boxes[order[m]].low[0] > boxes[order[k]].high[0] + tolerance) break;
      if (boxes[order[k]].touch(boxes[order[m]], tolerance)) found.push_back(std::minmax(order[k], order[m]));
    }
  std::sort(found.begin(), found.end());
  for (const auto& [i, j] : found) f(i, j);
}

inline coord distance_to_segment(const Vector& a, const Vector& b, const Vector& x) {
  const coord s = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (x - a - s * (b - a)).norm();
}

inline bool contains(const Piece& piece, int dim, const Vector& q, coord tolerance) {
  for (int e = 0; e < dim; ++e)
    if (vec(piece.inward[e]).dot(q - corner(piece, e)) < -tolerance) return false;
  return true;
}

}  // namespace greenwater::wall_geometry
