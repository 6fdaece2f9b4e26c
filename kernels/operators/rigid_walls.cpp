#include "kernels/operators/rigid_walls.hpp"

#include "core/region.hpp"

namespace greenwater {
namespace {

bool is_zero(const Triple& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Whether walls of the body move or begin to.
bool moves(const WallFaces& walls, int body) {
  for (const WallFace& face : walls.faces) {
    if (face.body != body) continue;
    for (int e = 0; e < walls.dim; ++e)
      if (!is_zero(face.corner[e].velocity) || !is_zero(face.corner[e].acceleration)) return true;
  }
  return false;
}

std::vector<int> faces_of(const WallFaces& walls, int body) {
  std::vector<int> found;
  for (std::size_t f = 0; f < walls.faces.size(); ++f)
    if (walls.faces[f].body == body) found.push_back(static_cast<int>(f));
  return found;
}

/// Of a field that is linear along a face, from its values at the corners.
Triple mixed(const WallFace& face, int dim, const Triple& shares, Triple WallPoint::*values) {
  Triple v{};
  for (int e = 0; e < dim; ++e) v = sum(v, scaled(face.corner[e].*values, shares[e]));
  return v;
}

}  // namespace

bool rigid_walls_move(const WallFaces& walls) {
  for (int body = 0; body < static_cast<int>(walls.bodies.size()); ++body)
    if (!walls.bodies[body].bends && moves(walls, body)) return true;
  return false;
}

int RigidWalls::watch(int body) {
  watched_.push_back(body);
  return static_cast<int>(watched_.size()) - 1;
}

WallQuadrature& RigidWalls::quadrature_of(const Fluid& fluid, int body, bool moves) {
  Body& found = bodies_[body];
  if (!found.made)
    found = {WallQuadrature(fluid.faces, faces_of(fluid.faces, body), WetSide::both, fluid.grid.shape(), fluid.spacing),
             true};
  else if (moves)
    found.quadrature.move_to(fluid.faces);
  return found.quadrature;
}

void RigidWalls::add_rows(const Fluid& fluid, const std::vector<WallPush>& pushes, const WallQuadrature& quadrature,
                          int number) {
  const int dim = fluid.particles.dim;
  for (std::size_t k = 0; k < pushes.size(); ++k) {
    const WallPush& push = pushes[k];
    Triple all{};
    quadrature.for_each(k, [&](int q, const Triple& from_particle, double weight) {
      const QuadraturePoint& point = quadrature.points()[q];
      const Triple a_w = mixed(fluid.faces.faces[point.face], dim, point.shares, &WallPoint::acceleration);
      const double offset = fluid.rho * dot(difference(push.drive, a_w), from_particle);
      all = sum(all, scaled(point.normal, weight));
      for (int d = 0; d < 3; ++d) known_[number][d] += weight * offset * point.normal[d];
    });
    for (int d = 0; d < dim; ++d)
      if (all[d] != 0) rows_.push_back({push.particle, dim * number + d, static_cast<real>(all[d])});
  }
}

void RigidWalls::join(const Fluid& fluid, const Survey& survey, const ScalarField& rhs, real dt,
                      SweptVolume::Share share) {
  Region region("wall_loads");
  const int dim = fluid.particles.dim;
  rows_.clear();
  known_.assign(watched_.size(), {});
  for (int body = 0; body < static_cast<int>(fluid.faces.bodies.size()); ++body) {
    const bool sweeps = !fluid.faces.bodies[body].bends && moves(fluid.faces, body);
    bool loads = false;
    for (const int watched : watched_) loads = loads || watched == body;
    if (!sweeps && !loads) continue;
    const auto pushes = wall_pushes(fluid, survey, body);
    WallQuadrature& quadrature = quadrature_of(fluid, body, sweeps);
    quadrature.weigh(pushes);
    for (std::size_t k = 0; k < watched_.size(); ++k)
      if (watched_[k] == body) add_rows(fluid, pushes, quadrature, static_cast<int>(k));
    if (!sweeps) continue;
    const auto speed = [&](int f, const Triple& x) {
      const WallFace& face = fluid.faces.faces[f];
      return mixed(face, dim, shares_at(face, dim, x), &WallPoint::velocity);
    };
    swept_.gather(pushes, quadrature, speed, share);
  }
  swept_.add_to(rhs, survey.fixed, source_per_volume(fluid, dt));
  if (!watched_.empty()) term_.set_rows(dim * static_cast<int>(watched_.size()), rows_);
}

std::vector<std::array<double, 3>> RigidWalls::reactions(const Fluid& fluid) {
  if (watched_.empty()) return {};
  const int dim = fluid.particles.dim, count = dim * static_cast<int>(watched_.size());
  if (static_cast<int>(felt_.extent(0)) < count) felt_ = ScalarField("greenwater::wall_reactions", count);
  term_.feel(fluid.particles.pressure, felt_);
  const auto felt = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), felt_);
  auto forces = known_;
  for (int k = 0; k < count; ++k) forces[k / dim][k % dim] += felt(k);
  return forces;
}

std::array<double, 3> wall_reaction(const Fluid& fluid, const Survey& survey, int body) {
  RigidWalls walls;
  walls.watch(body);
  const ScalarField unused("greenwater::unused_source", survey.rhs.extent(0));
  walls.join(fluid, survey, unused, 1);
  return walls.reactions(fluid).front();
}

}  // namespace greenwater
