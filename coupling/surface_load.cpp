#include "coupling/surface_load.hpp"

#include <algorithm>
#include <cmath>

namespace greenwater {
namespace {

using Point = std::array<double, 3>;

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double distance(const Point& a, const Point& b) {
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

/// Length of a segment, area of a triangle.
double size_of(const WallFace& face, int dim) {
  const auto &a = face.corner[0].position, &b = face.corner[1].position, &c = face.corner[2].position;
  if (dim == 2) return distance(a, b);
  const Point s{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, t{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return std::sqrt(std::max(0.0, dot(s, s) * dot(t, t) - dot(s, t) * dot(s, t))) / 2;
}

/// Middles of equal parts of a face: shares of its corners.
std::vector<Point> middles(const WallFace& face, int dim, double longest) {
  double edge = 0;
  for (int e = 0; e < dim; ++e)
    edge = std::max(edge, distance(face.corner[e].position, face.corner[(e + 1) % dim].position));
  const int n = std::max(1, static_cast<int>(std::ceil(edge / longest - 1e-6)));
  std::vector<Point> shares;
  if (dim == 2) {
    for (int i = 0; i < n; ++i) shares.push_back({1 - (i + 0.5) / n, (i + 0.5) / n, 0});
    return shares;
  }
  const auto add = [&](double i, double j) { shares.push_back({1 - (i + j) / n, i / n, j / n}); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j + i < n; ++j) {
      add(i + 1 / 3.0, j + 1 / 3.0);
      if (i + j + 2 <= n) add(i + 2 / 3.0, j + 2 / 3.0);
    }
  return shares;
}

/// One place at which the pressure is read.
struct Reader {
  std::size_t face;
  Point shares;   // of the face's corners
  double area;    // [m], in 3-D [m^2]
  Point outward;  // unit
};

}  // namespace

Eigen::VectorXd read_loads(PointSampler& sampler, const Fluid& fluid, const WetSurface& surface, int first_face,
                           Reading reading) {
  const int dim = fluid.faces.dim;
  const double off = 0.01 * fluid.spacing;  // on the fluid's side, and on the wall for the sampler
  std::vector<Reader> readers;
  std::vector<Point> points;
  for (std::size_t f = 0; f < surface.corner_of_face().size(); ++f) {
    const WallFace& face = fluid.faces.faces[first_face + f];
    Point normal = face_normal(corners_of(face), dim);
    for (double& n : normal) n *= WetSurface::outward(dim);
    const auto all = middles(face, dim, fluid.spacing);
    for (const Point& shares : all) {
      readers.push_back({f, shares, size_of(face, dim) / static_cast<double>(all.size()), normal});
      Point at{};
      for (int d = 0; d < dim; ++d) {
        at[d] = off * normal[d];
        for (int e = 0; e < dim; ++e) at[d] += shares[e] * face.corner[e].position[d];
      }
      points.push_back(at);
    }
  }
  const std::vector<double> pressure = sampler.pressure(fluid, points, reading);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(dim * surface.corners());
  for (std::size_t k = 0; k < readers.size(); ++k) {
    const Reader& at = readers[k];
    for (int e = 0; e < dim; ++e)
      for (int d = 0; d < dim; ++d)
        force[dim * surface.corner_of_face()[at.face][e] + d] -= at.shares[e] * pressure[k] * at.area * at.outward[d];
  }
  return force;
}

double pressure_difference(const WetSurface& surface, const Eigen::VectorXd& on_corners, const PlateBand& band) {
  const int dim = surface.fluid_dim();
  // Of each corner and side: how far it reaches along the height, and its area.
  struct Reach {
    double low = 1e300, high = -1e300, area = 0;
  };
  std::vector<Reach> reach[2];
  for (auto& of_side : reach) of_side.resize(surface.corners());
  const auto faces = surface.faces(0);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const double facing = WetSurface::outward(dim) * dot(face_normal(corners_of(faces[f]), dim), band.across);
    if (std::fabs(facing) < 0.5) continue;  // an end
    double middle = 0;
    std::array<double, 3> height{};
    for (int e = 0; e < dim; ++e) {
      const Point& x = faces[f].corner[e].position;
      height[e] = dot({x[0] - band.foot[0], x[1] - band.foot[1], x[2] - band.foot[2]}, band.up);
      middle += height[e] / dim;
    }
    for (int e = 0; e < dim; ++e) {
      Reach& at = reach[facing > 0 ? 1 : 0][surface.corner_of_face()[f][e]];
      at.low = std::min({at.low, middle, height[e]});
      at.high = std::max({at.high, middle, height[e]});
      at.area += size_of(faces[f], dim) * std::fabs(facing) / dim;
    }
  }
  double difference = 0;
  for (const auto& of_side : reach) {
    double force = 0, area = 0;
    for (int c = 0; c < surface.corners(); ++c) {
      const Reach& at = of_side[c];
      const double overlap = std::min(at.high, band.high) - std::max(at.low, band.low);
      if (!(at.area > 0) || !(overlap > 0)) continue;
      const double part = overlap / (at.high - at.low);
      for (int d = 0; d < dim; ++d) force += part * on_corners[dim * c + d] * band.across[d];
      area += part * at.area;
    }
    if (area > 0) difference += force / area;
  }
  return difference;
}

}  // namespace greenwater
