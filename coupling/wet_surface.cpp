#include "coupling/wet_surface.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/check.hpp"

namespace greenwater {
namespace {

constexpr double round_off = 1e-9;  // of the size of the mesh

double size_of(const SolidMesh& mesh) {
  double most = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const auto [low, high] = std::minmax_element(mesh.nodes.begin(), mesh.nodes.end(),
                                                 [&](const auto& a, const auto& b) { return a[d] < b[d]; });
    most = std::max(most, (*high)[d] - (*low)[d]);
  }
  return most;
}

/// Corners of walls as groups of nodes.
struct Stations {
  std::vector<int> of_node;             // -1: not wet
  std::vector<std::vector<int>> nodes;  // of each
};

/// Corners are nodes.
Stations one_each(const SolidMesh& mesh, const std::set<int>& wet) {
  Stations stations{std::vector<int>(mesh.nodes.size(), -1), {}};
  for (const int node : wet) {
    stations.of_node[node] = static_cast<int>(stations.nodes.size());
    stations.nodes.push_back({node});
  }
  return stations;
}

/// Corners are all nodes of a place, seen along z.
Stations along_width(const SolidMesh& mesh, const std::set<int>& wet) {
  const double raster = 1e3 * round_off * size_of(mesh);
  std::map<std::pair<long long, long long>, int> known;
  Stations stations{std::vector<int>(mesh.nodes.size(), -1), {}};
  for (const int node : wet) {
    const auto& x = mesh.nodes[node];
    const auto key = std::pair(std::llround(x[0] / raster), std::llround(x[1] / raster));
    const auto [place, is_new] = known.emplace(key, static_cast<int>(stations.nodes.size()));
    if (is_new) stations.nodes.emplace_back();
    stations.of_node[node] = place->second;
    stations.nodes[place->second].push_back(node);
  }
  return stations;
}

std::set<int> wet_nodes(const SolidMesh& mesh, const std::vector<Facet>& facets) {
  std::set<int> nodes;
  for (const Facet facet : facets) {
    const auto of = nodes_of(mesh, facet);
    nodes.insert(of.begin(), of.begin() + mesh.nodes_per_side());
  }
  return nodes;
}

/// The stations of a facet that goes through the width, in the order in which the solid is on their left.
std::array<int, 3> line_of(const SolidMesh& mesh, const Stations& stations, Facet facet) {
  const auto nodes = nodes_of(mesh, facet);
  // A side runs anti-clockwise seen from outside: its edge at the lower z, seen along z, has the solid on its left.
  for (int a = 0; a < 4; ++a) {
    const int from = nodes[a], to = nodes[(a + 1) % 4], across = nodes[(a + 2) % 4];
    const bool same = stations.of_node[from] == stations.of_node[nodes[(a + 3) % 4]];
    if (same && stations.of_node[to] == stations.of_node[across] &&
        mesh.nodes[from][2] < mesh.nodes[nodes[(a + 3) % 4]][2])
      return {stations.of_node[from], stations.of_node[to], -1};
  }
  const auto& x = mesh.nodes[nodes[0]];
  throw CaseError(
      text_of("a wet side of element ", facet.element + 1, ", at (", x[0], ", ", x[1], ", ", x[2],
              ") m, does not go straight through the width: in a 2-D fluid a structure has the same outline "
              "at every z; leave its front and back out of what is wet, or make the fluid 3-D"));
}

double width_of(const SolidMesh& mesh, const std::set<int>& wet) {
  double low = 1e300, high = -1e300;
  for (const int node : wet) {
    low = std::min(low, mesh.nodes[node][2]);
    high = std::max(high, mesh.nodes[node][2]);
  }
  return high - low;
}

/// What part each node has of the width, to the middles between it and the next along z: the mean over the width of what
/// goes in straight lines between nodes.
std::vector<double> shares(const SolidMesh& mesh, std::vector<int>& nodes) {
  if (nodes.size() == 1) return {1};
  const auto z = [&](std::size_t i) { return mesh.nodes[nodes[i]][2]; };
  std::sort(nodes.begin(), nodes.end(), [&](int a, int b) { return mesh.nodes[a][2] < mesh.nodes[b][2]; });
  const std::size_t last = nodes.size() - 1;
  std::vector<double> share(nodes.size());
  for (std::size_t i = 0; i <= last; ++i)
    share[i] = (z(std::min(i + 1, last)) - z(i > 0 ? i - 1 : 0)) / (2 * (z(last) - z(0)));
  return share;
}

// Axes that go with a face: along its first side, and out of it.
template <int Dim>
Eigen::Matrix<double, Dim, Dim> frame_of(const std::array<Eigen::Matrix<double, Dim, 1>, Dim>& corner) {
  Eigen::Matrix<double, Dim, Dim> frame;
  const Eigen::Matrix<double, Dim, 1> along = (corner[1] - corner[0]).normalized();
  frame.col(0) = along;
  if constexpr (Dim == 2) {
    frame.col(1) << -along[1], along[0];
  } else {
    const Eigen::Vector3d out = along.cross(corner[2] - corner[0]).normalized();
    frame.col(1) = out;
    frame.col(2) = along.cross(out);
  }
  return frame;
}

template <int Dim>
std::vector<Eigen::MatrixXd> turns_of(const std::vector<std::array<double, 3>>& rest,
                                      const std::vector<std::array<int, 3>>& faces,
                                      const Eigen::VectorXd& displacement) {
  using Point = Eigen::Matrix<double, Dim, 1>;
  using Turn = Eigen::Matrix<double, Dim, Dim>;
  std::vector<Turn> sum(rest.size(), Turn::Zero());
  for (const auto& face : faces) {
    std::array<Point, Dim> still, moved;
    for (int e = 0; e < Dim; ++e) {
      still[e] = Eigen::Map<const Point>(rest[face[e]].data());
      moved[e] = still[e] + displacement.segment<Dim>(Dim * face[e]);
    }
    const Turn turn = frame_of<Dim>(moved) * frame_of<Dim>(still).transpose();
    for (int e = 0; e < Dim; ++e) sum[face[e]] += turn;
  }
  std::vector<Eigen::MatrixXd> turns;
  for (const Turn& all : sum) {
    const Eigen::JacobiSVD<Turn> parts(all, Eigen::ComputeFullU | Eigen::ComputeFullV);
    turns.push_back(parts.matrixU() * parts.matrixV().transpose());
  }
  return turns;
}

}  // namespace

WetSurface::WetSurface(const SolidMesh& mesh, const std::vector<Facet>& facets, int fluid_dim, double depth)
    : fluid_dim_(fluid_dim), depth_(fluid_dim == 3 ? 1 : depth) {
  require(!facets.empty(), "the structure has no wet surface: name the parts of its mesh that the fluid touches");
  require(fluid_dim == 2 || mesh.dim == 3, "a 3-D fluid needs a structure of hexahedra");
  const bool projected = fluid_dim == 2 && mesh.dim == 3;
  const std::set<int> wet = wet_nodes(mesh, facets);
  Stations stations = projected ? along_width(mesh, wet) : one_each(mesh, wet);
  if (projected) depth_ = width_of(mesh, wet);
  std::set<std::array<int, 3>> lines;  // each once, however many elements lie along the width
  for (const Facet facet : facets) {
    if (projected) {
      const auto line = line_of(mesh, stations, facet);
      if (lines.insert(line).second) faces_.push_back(line);
      continue;
    }
    std::array<int, 4> at{};
    const auto nodes = nodes_of(mesh, facet);
    for (int a = 0; a < mesh.nodes_per_side(); ++a) at[a] = stations.of_node[nodes[a]];
    faces_.push_back({at[0], at[1], fluid_dim == 2 ? -1 : at[2]});
    if (fluid_dim == 3) faces_.push_back({at[0], at[2], at[3]});
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t c = 0; c < stations.nodes.size(); ++c) {
    std::array<double, 3> place{};
    const std::vector<double> share = shares(mesh, stations.nodes[c]);
    for (std::size_t i = 0; i < share.size(); ++i) {
      const int node = stations.nodes[c][i];
      for (int d = 0; d < fluid_dim; ++d) {
        place[d] += share[i] * mesh.nodes[node][d];
        entries.emplace_back(fluid_dim * static_cast<int>(c) + d, mesh.dim * node + d, share[i]);
      }
    }
    rest_.push_back(place);
  }
  mean_.resize(fluid_dim * static_cast<int>(rest_.size()), mesh.dim * static_cast<int>(mesh.nodes.size()));
  mean_.setFromTriplets(entries.begin(), entries.end());
}

std::vector<Eigen::MatrixXd> WetSurface::turn_of_corners(const Eigen::VectorXd& displacement) const {
  return fluid_dim_ == 2 ? turns_of<2>(rest_, faces_, displacement) : turns_of<3>(rest_, faces_, displacement);
}

std::vector<WallFace> WetSurface::faces(int body) const {
  std::vector<WallFace> made;
  for (const auto& corners : faces_) {
    made.push_back({{}, body});
    for (int e = 0; e < fluid_dim_; ++e) made.back().corner[e].position = rest_[corners[e]];
  }
  return made;
}

std::vector<Facet> outer_facets_without(const SolidMesh& mesh, const std::vector<std::string>& parts) {
  std::vector<Facet> wet;
  for (const Facet facet : outer_facets(mesh)) {
    const bool left_out = std::any_of(parts.begin(), parts.end(), [&](const std::string& name) {
      const MeshPart* part = find_part(mesh, name);
      return part != nullptr && std::count(part->facets.begin(), part->facets.end(), facet) > 0;
    });
    if (!left_out) wet.push_back(facet);
  }
  return wet;
}

}  // namespace greenwater
