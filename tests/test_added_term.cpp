// A term that is added to the pressure operator: against dense matrices, and absent where nobody asked for it.
#include <cmath>

#include "kernels/preconditioner_with_term.hpp"
#include "kernels/pressure_solver.hpp"
#include "tests/support.hpp"

using namespace greenwater;
using namespace greenwater::test;

namespace {

constexpr coord l0 = 0.1;
constexpr int unknowns = 40;

Fluid column() {
  Fluid fluid =
      fluid_at(lattice(18, 30, l0, 0, 0, 0.1),
               walls_of({segment(0, 0, 1.8, 0), segment(0, 0, 0, 4), segment(1.8, 4, 1.8, 0)}), {.spacing = l0});
  mark_surface(fluid, real(0.97));
  return fluid;
}

PressureSystem assembled(const Fluid& fluid) {
  PressureOptions options;
  options.compressibility = real(4.5e-10);
  PressureSystem system(options);
  system.assemble(fluid, real(1e-3));
  return system;
}

// D and C of some unknowns, and D C D^T.
struct Term {
  std::vector<AddedEntry> D;
  std::vector<real> C;
  std::vector<real> root;  // C = root^T root, row by row
  Eigen::MatrixXd dense;
};

// Each unknown feels the particles around one of the free ones at random. On the diagonal the term has up to `strength`
// times what the operator has.
Term random_term(const Fluid& fluid, const PressureSystem& system, double strength) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const std::vector<int> active = free_particles(fluid);
  const auto x = host(fluid.particles.position);
  const auto diagonal = host(system.diagonal());
  const int n = fluid.particles.count;
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(n, unknowns);
  for (int u = 0; u < unknowns; ++u) {
    const int middle = active[generator() % active.size()];
    for (int i = 0; i < n; ++i)
      if (std::hypot(x(i, 0) - x(middle, 0), x(i, 1) - x(middle, 1)) < 2 * l0) D(i, u) = any(generator);
  }
  // Of less than full rank: positive semi-definite.
  Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(unknowns, unknowns - 3, [&] { return any(generator); });
  Eigen::MatrixXd C = root * root.transpose();
  const Eigen::MatrixXd plain = D * C * D.transpose();
  double most = 0;
  for (const int i : active) most = std::max(most, plain(i, i) / diagonal(i));
  C *= strength / most;
  root *= std::sqrt(strength / most);

  Term term;
  for (int i = 0; i < n; ++i)
    for (int u = 0; u < unknowns; ++u)
      if (D(i, u) != 0) term.D.push_back({i, u, static_cast<real>(D(i, u))});
  for (int u = 0; u < unknowns; ++u)
    for (int v = 0; v < unknowns; ++v) term.C.push_back(static_cast<real>(C(u, v)));
  term.root.assign(root.data(), root.data() + root.size());
  term.dense = D * C * D.transpose();
  return term;
}

ScalarField zero_pressure(const Fluid& fluid) {
  return ScalarField("greenwater::test_pressure", fluid.particles.id.extent(0));
}

SolveReport solve(PressureSystem& system, const ScalarField& p, Preconditioning way, real tolerance) {
  SolverOptions options;
  options.preconditioning = way;
  options.cg.tolerance = tolerance;
  options.cg.max_iterations = 5000;
  options.most_multigrid_iterations = 300;
  const SolveReport report = make_pressure_solver(options)->solve(system, p);
  CHECK(report.converged);
  CHECK(report.recovery.empty());
  return report;
}

}  // namespace

TEST_CASE("an added term is in the operator as it is given", "[unit][pressure][added]") {
  const Fluid fluid = column();
  PressureSystem system = assembled(fluid);
  const std::vector<int> active = free_particles(fluid);
  const Eigen::MatrixXd without = dense(system)(active, active);
  const Term term = random_term(fluid, system, 3);
  AddedTerm added;
  added.set_rows(unknowns, term.D);
  added.set_answer(term.C, {});
  system.set_added(&added);
  const Eigen::MatrixXd with = dense(system);
  const Eigen::MatrixXd error = with(active, active) - without - term.dense(active, active);
  CHECK(error.cwiseAbs().maxCoeff() <= 1e-12 * with.cwiseAbs().maxCoeff());
  const auto surface = host(fluid.particles.surface);
  for (int i = 0; i < fluid.particles.count; ++i)
    if (surface(i)) CHECK(with.row(i).cwiseAbs().maxCoeff() == 0);
  system.set_added(nullptr);
  CHECK(dense(system)(active, active) == without);
}

TEST_CASE("with an added term the pressure is that of a dense solve", "[unit][pressure][added]") {
  for (const double strength : {0.1, 1.0, 10.0})
    for (const auto way : {Preconditioning::multigrid, Preconditioning::jacobi}) {
      INFO("the term has up to " << strength << " times the operator's diagonal");
      const Fluid fluid = column();
      PressureSystem system = assembled(fluid);
      const Term term = random_term(fluid, system, strength);
      AddedTerm added;
      added.set_rows(unknowns, term.D);
      added.set_answer(term.C, {});
      system.set_added(&added);
      const ScalarField p = zero_pressure(fluid);
      solve(system, p, way, real(1e-10));
      const std::vector<int> active = free_particles(fluid);
      const auto rhs = host(system.rhs()), found = host(p);
      Eigen::VectorXd b(active.size()), x(active.size());
      for (std::size_t k = 0; k < active.size(); ++k) {
        b(k) = rhs(active[k]);
        x(k) = found(active[k]);
      }
      const Eigen::VectorXd exact = dense(system)(active, active).ldlt().solve(b);
      CHECK((x - exact).norm() <= 1e-7 * exact.norm());
    }
}

TEST_CASE("a preconditioner with a term is the inverse of its own matrix and the term", "[unit][pressure][added]") {
  const Fluid fluid = column();
  PressureSystem system = assembled(fluid);
  const Term term = random_term(fluid, system, 3);
  AddedTerm added;
  added.set_rows(unknowns, term.D);
  added.set_answer(term.C, term.root);
  system.set_added(&added);
  const auto with_term = make_preconditioner_with_term(make_jacobi());
  with_term->update(system);
  const std::vector<int> active = free_particles(fluid);
  const auto diagonal = host(system.diagonal());
  Eigen::MatrixXd matrix = term.dense(active, active), found(active.size(), active.size());
  for (std::size_t k = 0; k < active.size(); ++k) matrix(k, k) += diagonal(active[k]);
  const ScalarField unit = zero_pressure(fluid), answer = zero_pressure(fluid);
  for (std::size_t k = 0; k < active.size(); ++k) {
    Kokkos::deep_copy(Kokkos::subview(unit, active[k]), real(1));
    const accum product = with_term->apply(unit, answer);
    Kokkos::deep_copy(Kokkos::subview(unit, active[k]), real(0));
    const auto values = host(answer);
    for (std::size_t row = 0; row < active.size(); ++row) found(row, k) = values(active[row]);
    CHECK(product == Approx(found(k, k)).epsilon(1e-6));
  }
  const Eigen::MatrixXd unity = Eigen::MatrixXd::Identity(active.size(), active.size());
  CHECK((found * matrix - unity).cwiseAbs().maxCoeff() <= (sizeof(real) == 8 ? 1e-9 : 1e-2));
}

// A multigrid that knows nothing of the term needs about an iteration for each unknown that matters. One that knows all of
// it needs no more than without the term.
TEST_CASE("iterations with an added term of forty unknowns", "[unit][pressure][added]") {
  const std::vector<std::pair<double, int>> most = {{0.1, 12}, {1, 26}, {10, 62}};
  for (const auto& [strength, allowed] : most) {
    INFO("the term has up to " << strength << " times the operator's diagonal");
    const Fluid fluid = column();
    PressureSystem system = assembled(fluid);
    const auto iterations = [&] {
      return solve(system, zero_pressure(fluid), Preconditioning::multigrid, real(1e-6)).iterations;
    };
    const int without = iterations();
    const Term term = random_term(fluid, system, strength);
    AddedTerm added;
    added.set_rows(unknowns, term.D);
    added.set_answer(term.C, {});
    system.set_added(&added);
    CHECK(iterations() <= allowed);
    added.set_answer(term.C, term.root);
    CHECK(iterations() <= without + 1);
  }
}

TEST_CASE("without an added term nothing of it is launched or held", "[unit][pressure][added]") {
  const Fluid fluid = column();
  Ears ears;
  PressureSystem system = assembled(fluid);
  const ScalarField p = zero_pressure(fluid);
  const auto solver = make_pressure_solver({});
  REQUIRE(solver->solve(system, p).converged);
  CHECK_FALSE(ears.launched("added"));
  CHECK_FALSE(ears.allocated("added"));

  AddedTerm added;
  added.set_rows(1, {{free_particles(fluid)[0], 0, real(1)}});
  added.set_answer({real(1)}, {real(1)});
  system.set_added(&added);
  CHECK(ears.allocated("greenwater::added_value"));
  REQUIRE(solver->solve(system, p).converged);
  CHECK(ears.launched("greenwater::added_product"));
}
