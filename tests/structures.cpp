#include "tests/structures.hpp"

#include <random>

#include "core/check.hpp"

namespace greenwater::test {
namespace {

SolidMesh shaken_box(int dim, double shift, bool outer_too) {
  SolidMesh mesh = box_mesh(dim, {0, 0, 0}, {3, 2, 2}, {3, 2, 2});
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> amount(-shift, shift);
  for (auto& x : mesh.nodes) {
    bool outer = false;
    for (int d = 0; d < dim; ++d) outer = outer || x[d] == 0 || x[d] == (d == 0 ? 3 : 2);
    for (int d = 0; d < dim; ++d) x[d] += outer && !outer_too ? 0 : amount(generator);
  }
  return mesh;
}

}  // namespace

SolidMesh distorted_box(int dim, double shift) { return shaken_box(dim, shift, false); }
SolidMesh crooked_box(int dim, double shift) { return shaken_box(dim, shift, true); }

Vector displacement_of(const SolidMesh& mesh, const std::function<Place(const Place&)>& u) {
  Vector all(mesh.dim * mesh.nodes.size());
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const Place at = u(mesh.nodes[n]);
    for (int d = 0; d < mesh.dim; ++d) all[mesh.dim * n + d] = at[d];
  }
  return all;
}

Vector random_vector(int count, double size) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> amount(-size, size);
  Vector v(count);
  for (double& x : v) x = amount(generator);
  return v;
}

const std::vector<int>& nodes_of_part(const SolidMesh& mesh, const std::string& name) {
  const MeshPart* part = find_part(mesh, name);
  expect(part != nullptr);
  return part->nodes;
}

}  // namespace greenwater::test
