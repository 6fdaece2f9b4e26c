#include "fem/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/check.hpp"

namespace greenwater {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double alike = 0.866;  // cosine of 30 degrees: normals of faces that push as one
constexpr std::size_t most_pushing = 3;

Vec3 vector_of(const std::array<double, 3>& x) { return Vec3(x.data()); }
std::array<double, 3> array_of(const Vec3& x) { return {x[0], x[1], x[2]}; }
int sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// The nodes of the outer facets, and the shortest edge of these [m].
std::vector<int> surface_nodes(const SolidMesh& mesh, double& shortest) {
  std::vector<int> nodes;
  shortest = std::numeric_limits<double>::infinity();
  const int corners = mesh.nodes_per_side();
  for (const Facet facet : outer_facets(mesh)) {
    const auto of_side = nodes_of(mesh, facet);
    for (int a = 0; a < corners; ++a) {
      nodes.push_back(of_side[a]);
      const Vec3 x = vector_of(mesh.nodes[of_side[a]]), next = vector_of(mesh.nodes[of_side[(a + 1) % corners]]);
      shortest = std::min(shortest, (next - x).norm());
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// The diagonal of the box around a mesh [m].
double size_of(const SolidMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const auto& x : mesh.nodes) box.extend(vector_of(x));
  return box.diagonal().norm();
}

bool before(const Contact::Pair& a, const Contact::Pair& b) {
  return a.node < b.node || (a.node == b.node && a.face < b.face);
}

}  // namespace

Contact::Plane::Plane(const FaceCorners& corner, int corners)
    : ends(corners), normal(vector_of(face_normal(corner, corners))), offset(normal.dot(vector_of(corner[0]))) {
  for (int e = 0; e < ends; ++e) {
    const Vec3 from = vector_of(corner[e]), along = (vector_of(corner[(e + 1) % ends]) - from).normalized();
    inwards[e] = ends == 2 ? along : normal.cross(along);
    begin[e] = inwards[e].dot(from);
  }
}

bool Contact::Plane::faced_by(const Vec3& x, double slack) const {
  if (normal.isZero(0)) return false;  // of no size
  for (int e = 0; e < ends; ++e)
    if (inwards[e].dot(x) < begin[e] - slack) return false;
  return true;
}

/// A node that is through a face.
struct Contact::Touch {
  int node = 0, face = 0;
  double depth = 0;  // [m]
  Vec3 normal;       // towards the side of the node
};

Contact::Contact(const Solid& solid, ContactWalls walls, double stiffness)
    : solid_(solid), walls_(std::move(walls)), stiffness_(stiffness) {
  constexpr double near = 0.02, past = 0.1;
  require(stiffness > 0, "the stiffness of contact is ", stiffness, "; it has to be above 0");
  double shortest = 0;
  nodes_ = surface_nodes(solid.mesh(), shortest);
  margin_ = near * size_of(solid.mesh());
  slack_ = past * shortest;
}

double Contact::critical_step(double alone, double stiffness) {
  return alone / std::sqrt(1 + most_pushing * stiffness);
}

Contact::State Contact::begin(double time, double critical) {
  constexpr double touching = 1e-6;  // of the size: round-off of typed numbers
  spring_.resize(static_cast<Eigen::Index>(solid_.mesh().nodes.size()));
  const double omega = 2 / critical;
  for (Eigen::Index node = 0; node < spring_.size(); ++node)
    spring_[node] = stiffness_ * omega * omega * solid_.mass()[solid_.dim() * node];
  prepare(time, time);
  lying_.clear();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(solid_.unknowns());
  const double near = touching * size_of(solid_.mesh());
  for (const int node : nodes_)
    for (int face = 0; face < static_cast<int>(at_from_.size()); ++face)
      if (distance_to_face(at_from_[face], walls_.dim, array_of(place_of(node, rest))) <= near)
        lying_.emplace_back(node, face);
  State state;
  Eigen::VectorXd no_force = rest;
  look_around(state, time, rest);
  push(state, {time, 0, rest, rest}, no_force);
  return state;
}

void Contact::prepare(double from, double to) {
  from_ = from;
  to_ = to;
  walls_.place(from, at_from_);
  walls_.place(to, at_to_);
  double way = 0;
  for (std::size_t face = 0; face < at_from_.size(); ++face)
    for (int e = 0; e < walls_.dim; ++e)
      way = std::max(way, (vector_of(at_to_[face][e]) - vector_of(at_from_[face][e])).norm());
  speed_ = to > from ? way / (to - from) : 0;
  standing_.clear();
  if (speed_ == 0)
    for (const FaceCorners& corner : at_from_) standing_.emplace_back(corner, walls_.dim);
}

Vec3 Contact::place_of(int node, const Eigen::VectorXd& u) const {
  Vec3 x = vector_of(solid_.mesh().nodes[node]);
  for (int d = 0; d < solid_.dim(); ++d) x[d] += u[solid_.dim() * node + d];
  if (walls_.dim == 2) x[2] = 0;  // a solid of hexahedra between walls of the plane
  return x;
}

FaceCorners Contact::corners(int face, double time) const {
  if (speed_ == 0) return at_from_[face];
  const double later = (time - from_) / (to_ - from_);
  FaceCorners now{};
  for (int e = 0; e < walls_.dim; ++e)
    for (int d = 0; d < 3; ++d) now[e][d] = (1 - later) * at_from_[face][e][d] + later * at_to_[face][e][d];
  return now;
}

/// What `use` makes of a face; that of a wall that stands is not copied, which would take longer than most uses.
template <class Use>
auto Contact::with_plane(int face, double time, const Use& use) const {
  return speed_ == 0 ? use(standing_[face]) : use(Plane(corners(face, time), walls_.dim));
}

/// For each node: its pairs [begin, end) of `near`, and of the faces that it is through those that push, of several alike
/// the deepest.
template <class Visit>
void Contact::for_nodes(const State& state, const Instant& now, const Visit& visit) const {
  std::array<Touch, most_pushing> touches;
  std::size_t begin = 0, count = 0;
  for (std::size_t k = 0; k < state.near.size(); ++k) {
    const Pair& pair = state.near[k];
    const Touch touch = with_plane(pair.face, now.time, [&](const Plane& plane) {
      const double depth = -pair.side * plane.height(place_of(pair.node, now.u));
      return Touch{pair.node, pair.face, depth, pair.side * plane.normal};
    });
    if (pair.faces && touch.depth > 0) {
      const auto end = touches.begin() + static_cast<std::ptrdiff_t>(count);
      const auto same =
          std::find_if(touches.begin(), end, [&](const Touch& t) { return t.normal.dot(touch.normal) > alike; });
      if (same != end && touch.depth > same->depth) *same = touch;
      if (same == end && count < most_pushing) touches[count++] = touch;
    }
    if (k + 1 < state.near.size() && state.near[k + 1].node == pair.node) continue;
    visit(begin, k + 1, std::span(touches.data(), count));
    begin = k + 1;
    count = 0;
  }
}

template <class Visit>
void Contact::for_touches(const State& state, const Instant& now, const Visit& visit) const {
  for_nodes(state, now, [&](std::size_t, std::size_t, std::span<const Touch> touches) {
    for (const Touch& touch : touches) visit(touch);
  });
}

void Contact::push(State& state, const Instant& now, Eigen::VectorXd& f) const {
  state.way += now.step * (std::sqrt(solid_.dim()) * now.v.lpNorm<Eigen::Infinity>() + speed_);
  if (state.way > margin_ / 2) look_around(state, now.time, now.u);
  for_nodes(state, now, [&](std::size_t begin, std::size_t end, std::span<const Touch> touches) {
    for (const Touch& touch : touches)
      for (int d = 0; d < solid_.dim(); ++d)
        f[solid_.dim() * touch.node + d] -= spring_[touch.node] * touch.depth * touch.normal[d];
    learn_sides({state.near.data() + begin, end - begin}, now, touches);
  });
}

/// A node is on the side of a face where it was when it was last past its ends, but for the depth to which it is through
/// walls: with that it would be behind the next face of a floor, and inside a block whose edge it has touched.
void Contact::learn_sides(std::span<Pair> of_node, const Instant& now, std::span<const Touch> touches) const {
  Vec3 x = place_of(of_node.front().node, now.u);
  for (const Touch& touch : touches) x += (touch.depth + 2 * slack_) * touch.normal;
  for (Pair& pair : of_node) {
    with_plane(pair.face, now.time, [&](const Plane& plane) {
      pair.faces = plane.faced_by(x, slack_);
      if (!pair.faces || pair.side == 0) pair.side = sign_of(plane.height(x));
    });
  }
}

double Contact::energy(const State& state, const Instant& now) const {
  double energy = 0;
  for_touches(state, now, [&](const Touch& touch) {
    const double before = touch.depth, force = spring_[touch.node] * before;
    double rate = 0;
    for (int d = 0; d < solid_.dim(); ++d) rate -= touch.normal[d] * now.v[solid_.dim() * touch.node + d];
    energy += force * (before + now.step * rate) / 2;
  });
  return energy;
}

double Contact::power(const State& state, const Instant& now) const {
  if (speed_ == 0) return 0;
  const double beside = 1e-3 * (to_ - from_);
  double power = 0;
  for_touches(state, now, [&](const Touch& touch) {
    const Vec3 x = place_of(touch.node, now.u);
    const Plane before = plane_of(touch.face, now.time - beside), after = plane_of(touch.face, now.time + beside);
    const double side = after.normal.dot(touch.normal) > 0 ? 1 : -1;
    power += spring_[touch.node] * touch.depth * side * (before.height(x) - after.height(x)) / (2 * beside);
  });
  return power;
}

Contact::Plane Contact::plane_of(int face, double time) const {
  return with_plane(face, time, [](const Plane& plane) { return plane; });
}

void Contact::look_around(State& state, double time, const Eigen::VectorXd& u) const {
  const std::vector<Pair> known = std::move(state.near);
  state.near.clear();
  state.way = 0;
  for (int face = 0; face < static_cast<int>(at_from_.size()); ++face) {
    const FaceCorners corner = corners(face, time);
    Eigen::AlignedBox3d box;
    for (int e = 0; e < walls_.dim; ++e) box.extend(vector_of(corner[e]));
    for (const int node : nodes_) {
      const Vec3 x = place_of(node, u);
      if (box.squaredExteriorDistance(x) > margin_ * margin_ || lies(node, face)) continue;
      if (distance_to_face(corner, walls_.dim, array_of(x)) > margin_) continue;
      const Pair pair{node, face};
      const auto old = std::lower_bound(known.begin(), known.end(), pair, before);
      state.near.push_back(old != known.end() && !before(pair, *old) ? *old : pair);
    }
  }
  for (const Pair& pair : known)  // those that are through deeper than the margin
    if (pair.faces && pair.side * plane_of(pair.face, time).height(place_of(pair.node, u)) < 0)
      state.near.push_back(pair);
  const auto same = [](const Pair& a, const Pair& b) { return a.node == b.node && a.face == b.face; };
  std::sort(state.near.begin(), state.near.end(), before);
  state.near.erase(std::unique(state.near.begin(), state.near.end(), same), state.near.end());
}

bool Contact::lies(int node, int face) const {
  return std::binary_search(lying_.begin(), lying_.end(), std::pair(node, face));
}

}  // namespace greenwater
