#include "fem/loads.hpp"

#include <cmath>

#include "core/check.hpp"

namespace greenwater {
namespace {

using Vec3 = Eigen::Vector3d;

/// A point of Gauss on a facet.
struct FacetPoint {
  double share[4] = {};  // N_a of its nodes
  Vec3 place;            // [m]
  Vec3 area;             // outer normal times area [m2]
};

Vec3 place_of(const Solid& solid, int node, const double* u) {
  Vec3 x(solid.mesh().nodes[node].data());
  if (u != nullptr)
    for (int d = 0; d < solid.dim(); ++d) x[d] += u[solid.dim() * node + d];
  return x;
}

/// Point p of 2 (2-D) or 4 of a facet, displaced by u unless that is nullptr.
FacetPoint facet_point(const Solid& solid, const std::array<int, 4>& nodes, int p, const double* u) {
  const double g = 1 / std::sqrt(3.0), xi = p % 2 ? g : -g, eta = p / 2 ? g : -g;
  FacetPoint point;
  point.place.setZero();
  Vec3 along = Vec3::Zero(), across = Vec3::Zero();
  for (int a = 0; a < solid.mesh().nodes_per_side(); ++a) {
    const Vec3 x = place_of(solid, nodes[a], u);
    const double s = a == 1 || a == 2 ? 1 : -1, t = a >= 2 ? 1 : -1;
    const double r = solid.dim() == 2 ? 1 : (1 + t * eta) / 2;
    point.share[a] = (1 + s * xi) / 2 * r;
    along += s / 2 * r * x;
    across += (1 + s * xi) / 2 * t / 2 * x;
    point.place += point.share[a] * x;
  }
  // In 2-D the element is to the left, so that outside is to the right.
  point.area = solid.dim() == 2 ? Vec3(along.y(), -along.x(), 0) * solid.options().thickness : along.cross(across);
  return point;
}

/// Adds the integral of N_a times what `force` makes of each point [N].
template <class Force>
void add_facets(const Solid& solid, const std::vector<Facet>& facets, const double* u, const Force& force,
                Eigen::VectorXd& f) {
  const int dim = solid.dim(), corners = solid.mesh().nodes_per_side();
  for (const Facet facet : facets) {
    const auto nodes = nodes_of(solid.mesh(), facet);
    for (int p = 0; p < corners; ++p) {
      const FacetPoint point = facet_point(solid, nodes, p, u);
      const Vec3 all = force(point);
      for (int a = 0; a < corners; ++a)
        for (int d = 0; d < dim; ++d) f[dim * nodes[a] + d] += point.share[a] * all[d];
    }
  }
}

std::array<double, 3> as_array(const Vec3& x) { return {x[0], x[1], x[2]}; }

}  // namespace

void Loads::add(const Eigen::VectorXd& pattern) {
  if (constant_.size() == 0) constant_ = Eigen::VectorXd::Zero(pattern.size());
  constant_ += pattern;
}

void Loads::add(Eigen::VectorXd pattern, Factor factor) { varying_.push_back({std::move(pattern), std::move(factor)}); }

void Loads::add_follower(std::vector<Facet> facets, Factor pressure) {
  followers_.push_back({std::move(facets), std::move(pressure)});
}

void Loads::add_acceleration(Acceleration acceleration) { accelerations_.push_back(std::move(acceleration)); }

void Loads::prepare(const Solid& solid, double from, double to) {
  if (accelerations_.empty()) return;
  from_ = from;
  to_ = to;
  for (Eigen::VectorXd* f : {&at_from_, &at_to_}) {
    f->setZero(solid.unknowns());
    summand_.setZero(solid.unknowns());
    for (const Acceleration& acceleration : accelerations_) {
      acceleration(f == &at_from_ ? from : to, summand_);
      *f += summand_.cwiseProduct(solid.mass());
    }
  }
}

void Loads::evaluate(const Solid& solid, double t, const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  if (constant_.size() == 0)
    f.setZero();
  else
    f = constant_;
  for (const Varying& load : varying_) f += load.factor(t) * load.pattern;
  for (const Follower& load : followers_) {
    const double p = load.pressure(t);
    add_facets(
        solid, load.facets, u.data(), [p](const FacetPoint& point) -> Vec3 { return -p * point.area; }, f);
  }
  if (accelerations_.empty()) return;
  expect(at_to_.size() == f.size());
  const double later = to_ > from_ ? (t - from_) / (to_ - from_) : 0;
  f += (1 - later) * at_from_ + later * at_to_;
}

Eigen::VectorXd gravity_pattern(const Solid& solid, const std::array<double, 3>& acceleration) {
  Eigen::VectorXd f = solid.mass();
  for (Eigen::Index i = 0; i < f.size(); ++i) f[i] *= acceleration[i % solid.dim()];
  return f;
}

Eigen::VectorXd pressure_pattern(const Solid& solid, const std::vector<Facet>& facets, const FieldAt& pressure) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(solid.unknowns());
  const auto force = [&](const FacetPoint& point) -> Vec3 { return -pressure(as_array(point.place)) * point.area; };
  add_facets(solid, facets, nullptr, force, f);
  return f;
}

Eigen::VectorXd traction_pattern(const Solid& solid, const std::vector<Facet>& facets, const VectorAt& traction) {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(solid.unknowns());
  const auto force = [&](const FacetPoint& point) -> Vec3 {
    return point.area.norm() * Vec3(traction(as_array(point.place)).data());
  };
  add_facets(solid, facets, nullptr, force, f);
  return f;
}

Eigen::VectorXd nodal_pattern(const Solid& solid, int node, const std::array<double, 3>& force) {
  expect(node >= 0 && node < static_cast<int>(solid.mesh().nodes.size()));
  Eigen::VectorXd f = Eigen::VectorXd::Zero(solid.unknowns());
  for (int d = 0; d < solid.dim(); ++d) f[solid.dim() * node + d] = force[d];
  return f;
}

}  // namespace greenwater
