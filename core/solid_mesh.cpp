#include "core/solid_mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <map>

#include "core/check.hpp"

namespace greenwater {
namespace {

// Local nodes of the sides, in the order left, right, front, back, bottom, top of an element that lies along the axes.
constexpr int sides_3d[6][4] = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 3, 2, 1}, {4, 5, 6, 7}};
// Left, right, bottom, top.
constexpr int sides_2d[4][2] = {{3, 0}, {1, 2}, {0, 1}, {2, 3}};

int node_index(const std::array<int, 3>& divisions, int i, int j, int k) {
  return i + (divisions[0] + 1) * (j + (divisions[1] + 1) * k);
}

void add_box_nodes(SolidMesh& mesh, const std::array<double, 3>& low, const std::array<double, 3>& high,
                   const std::array<int, 3>& divisions) {
  const auto at = [&](int axis, int i) { return low[axis] + (high[axis] - low[axis]) * i / divisions[axis]; };
  for (int k = 0; k <= (mesh.dim == 3 ? divisions[2] : 0); ++k) {
    for (int j = 0; j <= divisions[1]; ++j) {
      for (int i = 0; i <= divisions[0]; ++i) mesh.nodes.push_back({at(0, i), at(1, j), mesh.dim == 3 ? at(2, k) : 0});
    }
  }
}

std::array<int, 8> box_element(const SolidMesh& mesh, const std::array<int, 3>& divisions, int i, int j, int k) {
  std::array<int, 8> element{};
  constexpr int right[4] = {0, 1, 1, 0}, back[4] = {0, 0, 1, 1};
  for (int a = 0; a < mesh.nodes_per_element(); ++a) {
    element[a] = node_index(divisions, i + right[a % 4], j + back[a % 4], k + a / 4);
  }
  return element;
}

}  // namespace

std::array<int, 4> nodes_of(const SolidMesh& mesh, Facet facet) {
  std::array<int, 4> nodes{-1, -1, -1, -1};
  const auto& element = mesh.elements[facet.element];
  for (int a = 0; a < mesh.nodes_per_side(); ++a) {
    nodes[a] = element[mesh.dim == 2 ? sides_2d[facet.side][a] : sides_3d[facet.side][a]];
  }
  return nodes;
}

std::vector<Facet> outer_facets(const SolidMesh& mesh) {
  std::map<std::array<int, 4>, std::vector<Facet>> by_nodes;
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e) {
    for (int side = 0; side < mesh.sides_per_element(); ++side) {
      auto key = nodes_of(mesh, {e, side});
      std::sort(key.begin(), key.end());
      by_nodes[key].push_back({e, side});
    }
  }
  std::vector<Facet> outer;
  for (const auto& [nodes, facets] : by_nodes) {
    if (facets.size() == 1) outer.push_back(facets.front());
  }
  std::sort(outer.begin(), outer.end(),
            [](Facet a, Facet b) { return a.element != b.element ? a.element < b.element : a.side < b.side; });
  return outer;
}

const MeshPart* find_part(const SolidMesh& mesh, const std::string& name) {
  const auto found = std::find_if(mesh.parts.begin(), mesh.parts.end(), [&](const auto& p) { return p.name == name; });
  return found == mesh.parts.end() ? nullptr : &*found;
}

std::string part_names(const SolidMesh& mesh) {
  std::string names;
  for (const MeshPart& part : mesh.parts) names += (names.empty() ? "\"" : ", \"") + part.name + '"';
  return names.empty() ? "none" : names;
}

void scale(SolidMesh& mesh, double by) {
  for (auto& node : mesh.nodes) {
    for (double& x : node) x *= by;
  }
}

void add_part(SolidMesh& mesh, const std::string& name, std::vector<Facet> facets) {
  MeshPart part{name, {}, std::move(facets)};
  for (const Facet facet : part.facets) {
    const auto nodes = nodes_of(mesh, facet);
    part.nodes.insert(part.nodes.end(), nodes.begin(), nodes.begin() + mesh.nodes_per_side());
  }
  std::sort(part.nodes.begin(), part.nodes.end());
  part.nodes.erase(std::unique(part.nodes.begin(), part.nodes.end()), part.nodes.end());
  mesh.parts.push_back(std::move(part));
}

SolidMesh box_mesh(int dim, const std::array<double, 3>& low, const std::array<double, 3>& high,
                   const std::array<int, 3>& divisions) {
  SolidMesh mesh;
  mesh.dim = dim;
  for (int d = 0; d < dim; ++d) expect(divisions[d] > 0 && high[d] > low[d]);
  add_box_nodes(mesh, low, high, divisions);
  const int layers = dim == 3 ? divisions[2] : 1;
  std::vector<std::vector<Facet>> sides(mesh.sides_per_element());
  for (int k = 0; k < layers; ++k) {
    for (int j = 0; j < divisions[1]; ++j) {
      for (int i = 0; i < divisions[0]; ++i) {
        const int e = static_cast<int>(mesh.elements.size());
        mesh.elements.push_back(box_element(mesh, divisions, i, j, k));
        const int place[3] = {i, j, k};
        for (int d = 0; d < dim; ++d) {
          if (place[d] == 0) sides[2 * d].push_back({e, 2 * d});
          if (place[d] == divisions[d] - 1) sides[2 * d + 1].push_back({e, 2 * d + 1});
        }
      }
    }
  }
  const std::vector<std::string> names =
      dim == 2 ? std::vector<std::string>{"left", "right", "bottom", "top"}
               : std::vector<std::string>{"left", "right", "front", "back", "bottom", "top"};
  for (std::size_t s = 0; s < names.size(); ++s) add_part(mesh, names[s], sides[s]);
  return mesh;
}

}  // namespace greenwater
