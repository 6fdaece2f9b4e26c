#include "kernels/operators/wall_quadrature.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

constexpr double reach = 1.5;    // R, x spacing
constexpr double longest = 0.5;  // part of a face in 2-D; in 3-D the diagonal of a square of that size, x spacing

struct Part {
  Triple corner[3];  // shares of the face's corners
};

Triple middle_of(const Part& part, int dim) {
  Triple all{};
  for (int e = 0; e < dim; ++e) all = sum(all, scaled(part.corner[e], 1.0 / dim));
  return all;
}

Triple place_of(const WallFace& face, int dim, const Triple& shares) {
  Triple x{};
  for (int e = 0; e < dim; ++e) x = sum(x, scaled(face.corner[e].position, shares[e]));
  return x;
}

/// Equal parts with no side longer than `most`, by halving the longest side.
std::vector<Part> parts_of(const WallFace& face, int dim, double most) {
  std::vector<Part> small, open{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  if (dim == 2) {
    const double length = distance(face.corner[0].position, face.corner[1].position);
    const int n = std::max(1, static_cast<int>(std::ceil(length / most - 1e-6)));
    for (int k = 0; k < n; ++k) {
      const double a = static_cast<double>(k) / n, b = (k + 1.0) / n;
      small.push_back({{{1 - a, a, 0}, {1 - b, b, 0}, {}}});
    }
    return small;
  }
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    int longest_side = 0;
    double length = 0;
    for (int e = 0; e < 3; ++e) {
      const double side = distance(place_of(face, 3, part.corner[e]), place_of(face, 3, part.corner[(e + 1) % 3]));
      if (side > length * (1 + 1e-9)) {
        length = side;
        longest_side = e;
      }
    }
    if (!(length > most * (1 + 1e-6))) {
      small.push_back(part);
      continue;
    }
    const Triple &a = part.corner[longest_side], &b = part.corner[(longest_side + 1) % 3],
                 &c = part.corner[(longest_side + 2) % 3];
    const Triple half = scaled(sum(a, b), 0.5);
    open.push_back({{c, a, half}});
    open.push_back({{b, c, half}});
  }
  return small;
}

double area_of(const WallFace& face, int dim) {
  const auto &a = face.corner[0].position, &b = face.corner[1].position, &c = face.corner[2].position;
  if (dim == 2) return distance(a, b);
  return length(cross(difference(b, a), difference(c, a))) / 2;
}

}  // namespace

WallQuadrature::WallQuadrature(const WallFaces& walls, const std::vector<int>& faces, WetSide wet,
                               const GridShape& grid, double spacing)
    : dim_(walls.dim),
      radius_(reach * spacing),
      turned_(wet == WetSide::along_normal ? -1 : 1),
      both_(wet == WetSide::both),
      periods_{Triple{}} {
  const double most = longest * spacing * (dim_ == 2 ? 1 : std::sqrt(2.0));
  for (const int f : faces) {
    const WallFace& face = walls.faces[f];
    if (face.repeated || !(area_of(face, dim_) > 0)) continue;
    const auto parts = parts_of(face, dim_, most);
    for (const Part& part : parts)
      for (int side = 0; side < (both_ ? 2 : 1); ++side) {
        points_.emplace_back();
        points_.back().face = f;
        points_.back().shares = middle_of(part, dim_);
        points_.back().part = 1.0 / static_cast<double>(parts.size());
      }
  }
  for (int d = 0; d < dim_; ++d) {
    if (!(grid.period[d] > 0)) continue;
    const std::size_t before = periods_.size();
    for (std::size_t k = 0; k < before; ++k)
      for (const int turn : {-1, 1}) {
        periods_.push_back(periods_[k]);
        periods_.back()[d] += turn * grid.period[d];
      }
  }
  move_to(walls);
  for (QuadraturePoint& point : points_) {
    double around = 0;
    for_each_near(point.place, point.normal,
                  [&](int q, const Triple&, double psi) { around += points_[q].area * psi; });
    point.around = around;
  }
  sum_.assign(points_.size(), 0);
}

void WallQuadrature::move_to(const WallFaces& walls) {
  for (std::size_t q = 0; q < points_.size(); ++q) {
    QuadraturePoint& point = points_[q];
    const WallFace& face = walls.faces[point.face];
    const double turned = both_ && q % 2 == 1 ? -turned_ : turned_;
    point.area = point.part * area_of(face, dim_);
    point.place = place_of(face, dim_, point.shares);
    point.normal = scaled(face_normal(corners_of(face), dim_), turned);
  }
  sort_into_cells();
}

int WallQuadrature::cell_along(int axis, double x) const {
  const double k = std::floor((x - low_[axis]) / cell_);
  return static_cast<int>(std::clamp(k, 0.0, cells_[axis] - 1.0));
}

void WallQuadrature::sort_into_cells() {
  constexpr double most_per_point = 8;  // cells; beyond that they are made larger
  low_ = {1e300, 1e300, 1e300};
  high_ = {-1e300, -1e300, -1e300};
  for (const QuadraturePoint& point : points_)
    for (int d = 0; d < dim_; ++d) {
      low_[d] = std::min(low_[d], point.place[d]);
      high_[d] = std::max(high_[d], point.place[d]);
    }
  const auto count_for = [&](double cell) {
    double count = 1;
    for (int d = 0; d < dim_; ++d) count *= std::floor((high_[d] - low_[d]) / cell) + 1;
    return count;
  };
  cell_ = radius_;
  while (!points_.empty() && count_for(cell_) > 1000 + most_per_point * static_cast<double>(points_.size())) cell_ *= 2;
  for (int d = 0; d < dim_; ++d) cells_[d] = points_.empty() ? 1 : static_cast<int>((high_[d] - low_[d]) / cell_) + 1;
  first_.assign(static_cast<std::size_t>(cells_[0]) * cells_[1] * cells_[2] + 1, 0);
  std::vector<int> cell(points_.size());
  for (std::size_t q = 0; q < points_.size(); ++q) {
    int c = 0;
    for (int d = dim_ - 1; d >= 0; --d) c = c * cells_[d] + cell_along(d, points_[q].place[d]);
    cell[q] = c;
    ++first_[c + 1];
  }
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  order_.resize(points_.size());
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (std::size_t q = 0; q < points_.size(); ++q) order_[next[cell[q]]++] = static_cast<int>(q);
}

void WallQuadrature::weigh(const std::vector<WallPush>& pushes) {
  std::fill(sum_.begin(), sum_.end(), 0.0);
  given_.clear();
  first_given_.assign(1, 0);
  for (const WallPush& push : pushes) {
    if (push.area > 0)
      for_each_near(push.place, push.normal, [&](int q, const Triple& way, double psi) {
        sum_[q] += push.area * psi;
        given_.push_back({q, push.area * psi, sum(push.from_particle, way)});
      });
    first_given_.push_back(given_.size());
  }
  for (Given& part : given_) {
    const QuadraturePoint& point = points_[part.place];
    part.weight *= point.area / std::max(sum_[part.place], least_cover * point.around);
  }
}

}  // namespace greenwater
