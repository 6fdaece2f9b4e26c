#include "fem/supports.hpp"

#include <algorithm>

#include "core/check.hpp"

namespace greenwater {

void clamp(Supports& supports, int dim, const std::vector<int>& nodes) {
  for (int axis = 0; axis < dim; ++axis) hold(supports, dim, nodes, axis);
}

void hold(Supports& supports, int dim, const std::vector<int>& nodes, int axis) {
  expect(axis >= 0 && axis < dim);
  auto& held = supports.held;
  for (const int node : nodes) held.push_back(dim * node + axis);
  std::sort(held.begin(), held.end());
  held.erase(std::unique(held.begin(), held.end()), held.end());
}

void move(Supports& supports, int dim, const std::vector<int>& nodes, int axis,
          std::function<double(double)> displacement) {
  hold(supports, dim, nodes, axis);
  std::vector<int> unknowns;
  for (const int node : nodes) unknowns.push_back(dim * node + axis);
  auto write = [unknowns, displacement = std::move(displacement)](double t, Eigen::VectorXd& u) {
    const double all = displacement(t);
    for (const int i : unknowns) u[i] = all;
  };
  supports.motions.push_back({unknowns, std::move(write)});
}

void follow(Supports& supports, const SolidMesh& mesh, const std::vector<int>& nodes,
            std::function<Eigen::Affine3d(double)> motion) {
  const int dim = mesh.dim;
  clamp(supports, dim, nodes);
  std::vector<int> unknowns;
  Eigen::Matrix3Xd rest(3, nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    rest.col(static_cast<Eigen::Index>(k)) = Eigen::Vector3d(mesh.nodes[nodes[k]].data());
    for (int axis = 0; axis < dim; ++axis) unknowns.push_back(dim * nodes[k] + axis);
  }
  auto write = [dim, nodes, rest = std::move(rest), motion = std::move(motion)](double t, Eigen::VectorXd& u) {
    const Eigen::Affine3d now = motion(t);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Eigen::Vector3d from = rest.col(static_cast<Eigen::Index>(k)), to = now * from;
      for (int axis = 0; axis < dim; ++axis) u[dim * nodes[k] + axis] = to[axis] - from[axis];
    }
  };
  supports.motions.push_back({std::move(unknowns), std::move(write)});
}

std::vector<int> free_unknowns(const Supports& supports, int count) {
  std::vector<int> free;
  auto next = supports.held.begin();
  for (int i = 0; i < count; ++i) {
    if (next != supports.held.end() && *next == i)
      ++next;
    else
      free.push_back(i);
  }
  expect(next == supports.held.end());
  return free;
}

Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& matrix, const std::vector<int>& chosen) {
  std::vector<int> row(matrix.rows(), -1);
  for (std::size_t i = 0; i < chosen.size(); ++i) row[chosen[i]] = static_cast<int>(i);
  const auto size = static_cast<Eigen::Index>(chosen.size());
  Eigen::SparseMatrix<double> part(size, size);
  part.reserve(matrix.nonZeros());
  for (Eigen::Index j = 0; j < size; ++j) {
    part.startVec(j);
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, chosen[j]); entry; ++entry)
      if (row[entry.row()] >= 0) part.insertBack(row[entry.row()], j) = entry.value();
  }
  part.finalize();
  return part;
}

}  // namespace greenwater
