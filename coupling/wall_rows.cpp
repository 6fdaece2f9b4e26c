#include "coupling/wall_rows.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace greenwater {
namespace {

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

WallQuadrature quadrature_of(const WetSurface& surface, const WallFaces& walls, int first_face, const GridShape& grid,
                             double spacing) {
  std::vector<int> faces(surface.corner_of_face().size());
  std::iota(faces.begin(), faces.end(), first_face);
  const WetSide wet = WetSurface::outward(walls.dim) > 0 ? WetSide::along_normal : WetSide::against_normal;
  return WallQuadrature(walls, faces, wet, grid, spacing);
}

void add_wall_rows(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature, const WetSurface& surface,
                   int dim, int first_face, int first_unknown, std::vector<AddedEntry>& rows) {
  OneParticle sums(first_unknown, dim * surface.corners());
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const WallPush& push = pushes[k];
    quadrature.for_each(k, [&](int q, const Triple&, double weight) {
      const QuadraturePoint& point = quadrature.points()[q];
      const auto& corners = surface.corner_of_face()[point.face - first_face];
      for (int e = 0; e < dim; ++e)
        for (int d = 0; d < dim; ++d) sums.add(dim * corners[e] + d, weight * point.shares[e] * point.normal[d]);
    });
    if (k + 1 == pushes.size() || pushes[k + 1].particle != push.particle) sums.hand_over(push.particle, rows);
  }
}

Eigen::VectorXd known_load(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature,
                           const WetSurface& surface, int dim, int first_face, double rho) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(dim * surface.corners());
  for (std::size_t k = 0; k < pushes.size(); ++k)
    quadrature.for_each(k, [&](int q, const Triple& from_particle, double weight) {
      const QuadraturePoint& point = quadrature.points()[q];
      const auto& corners = surface.corner_of_face()[point.face - first_face];
      const double size = weight * rho * dot(pushes[k].drive, from_particle);
      for (int e = 0; e < dim; ++e)
        for (int d = 0; d < dim; ++d) force[dim * corners[e] + d] += size * point.shares[e] * point.normal[d];
    });
  return force;
}

Eigen::SparseMatrix<double> layer_mass(const std::vector<WallPush>& pushes, const WallQuadrature& quadrature,
                                       const WetSurface& surface, int dim, int first_face, double rho) {
  const auto& points = quadrature.points();
  std::vector<double> mass(points.size(), 0.0);
  for (std::size_t k = 0; k < pushes.size(); ++k)
    quadrature.for_each(k, [&](int q, const Triple& from_particle, double weight) {
      mass[q] += rho * weight * std::fabs(dot(points[q].normal, from_particle));
    });
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t q = 0; q < mass.size();) {  // places of a face stand together, and have one normal
    const int face = points[q].face;
    const Triple n = points[q].normal;
    double shared[3][3] = {}, whole = 0;
    for (; q < mass.size() && points[q].face == face; ++q) {
      whole += mass[q];
      for (int a = 0; a < dim; ++a)
        for (int b = 0; b < dim; ++b) shared[a][b] += mass[q] * points[q].shares[a] * points[q].shares[b];
    }
    if (whole == 0) continue;
    const auto& corners = surface.corner_of_face()[face - first_face];
    for (int a = 0; a < dim; ++a)
      for (int b = 0; b < dim; ++b)
        for (int d = 0; d < dim; ++d)
          for (int e = 0; e < dim; ++e)
            entries.emplace_back(dim * corners[a] + d, dim * corners[b] + e, shared[a][b] * n[d] * n[e]);
  }
  const int size = dim * surface.corners();
  Eigen::SparseMatrix<double> M(size, size);
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

}  // namespace greenwater
