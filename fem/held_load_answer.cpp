#include "fem/held_load_answer.hpp"

#include "core/check.hpp"

namespace greenwater {

Eigen::MatrixXd held_load_answer(const Solid& solid, const Supports& supports, const Eigen::SparseMatrix<double>& p,
                                 const MarchOptions& options, int steps) {
  expect(p.rows() == solid.unknowns() && steps > 0);
  Material material = solid.material();
  material.law = Law::linear;
  SolidOptions small = solid.options();
  small.kinematics = Kinematics::small;
  const Solid linear(solid.mesh(), material, small);
  const Supports fixed{supports.held, {}};
  March march(linear, fixed, {}, options);
  const March::State rest = march.state();
  Eigen::MatrixXd answer(p.cols(), p.cols());
  for (int j = 0; j < p.cols(); ++j) {
    march.set_state(rest);
    march.advance(steps, p.col(j));
    answer.col(j) = p.transpose() * march.displacement();
  }
  require<NumericsError>(answer.allFinite(),
                         "what the structure answers to a load is not a finite number: look at its ",
                         "material, and at the unit of its sizes");
  return (answer + answer.transpose()) / 2;  // of round-off only
}

}  // namespace greenwater
