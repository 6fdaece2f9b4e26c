#include "tests/beams.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "tests/structures.hpp"

namespace greenwater::test {
namespace {

/// det of moment and shear force at the tip from those at the root: y' = A y, y = (w, psi, M / E I, V / E I) along x / L.
double end_determinant(const Beam& beam, double omega) {
  const double l = beam.length, mass = beam.density * beam.height * omega * omega;
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  a(0, 1) = 1, a(0, 3) = beam.bending() / (beam.shearing() * l * l);
  a(1, 2) = 1;
  a(2, 1) = -mass * beam.gyration * beam.height * beam.height * l * l / beam.bending(), a(2, 3) = -1;
  a(3, 0) = -mass * l * l * l * l / beam.bending();
  const Eigen::Matrix4d across = a.exp();
  return across.bottomRightCorner<2, 2>().determinant();
}

}  // namespace

std::vector<double> Beam::frequencies(int count) const {
  std::vector<double> found;
  // A tenth of the first frequency of a thin beam: no two zeros lie so close.
  const double step = 0.1 * 3.516 * std::sqrt(bending() / (density * height)) / (length * length);
  double low = step / 2, at_low = end_determinant(*this, low);
  while (static_cast<int>(found.size()) < count) {
    double high = low + step;
    const double at_high = end_determinant(*this, high);
    if (at_low * at_high < 0) {
      double a = low, b = high;
      for (int i = 0; i < 60; ++i) {
        const double middle = (a + b) / 2;
        (end_determinant(*this, middle) * at_low > 0 ? a : b) = middle;
      }
      found.push_back(a / (2 * std::numbers::pi));
    }
    low = high, at_low = at_high;
  }
  return found;
}

double Beam::tip_of_partial(double p, double s) const {
  return p * s * s * s * (4 * length - s) / (24 * bending()) + p * s * s / (2 * shearing());
}

double Beam::tip_of_triangle(double p) const {
  return p * std::pow(length, 4) / (30 * bending()) + p * length * length / (6 * shearing());
}

Beam Plate::beam() const {
  const Material& m = solid.material();
  const double young = sides == Sides::held ? m.young / (1 - m.poisson * m.poisson) : m.young;
  return {young, m.young / (2 * (1 + m.poisson)), m.density, thickness, 0.1};
}

double Plate::tip(const Eigen::VectorXd& u) const {
  double sum = 0;
  const auto& nodes = nodes_of_part(solid.mesh(), "back");
  for (const int n : nodes) sum += u[3 * n] / static_cast<double>(nodes.size());
  return sum;
}

Plate polycarbonate(double thickness, Sides sides, const SolidOptions& options, const std::array<int, 3>& divisions) {
  const SolidMesh mesh = box_mesh(3, {0, 0, 0}, {thickness, 0.1, 0.2}, divisions);
  Supports supports;
  const auto& foot = nodes_of_part(mesh, "front");
  for (const int axis : {0, 1}) hold(supports, 3, foot, axis);
  if (sides == Sides::beam)
    hold(supports, 3, nodes_of_part(mesh, "bottom"), 2);
  else
    hold(supports, 3, foot, 2);
  if (sides == Sides::held) {
    hold(supports, 3, nodes_of_part(mesh, "bottom"), 2);
    hold(supports, 3, nodes_of_part(mesh, "top"), 2);
  }
  return {Solid(mesh, {3.43e9, 0.37, 1200}, options), supports, thickness, sides};
}

}  // namespace greenwater::test
