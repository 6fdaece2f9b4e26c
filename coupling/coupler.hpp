#pragma once
// Fluid and structures, step by step. The scheme of the fluid asks in this order:
//
//   foresee()      structures march, walls get their speeds for the step
//   join()         the pressure solve learns what walls and structures do to it
//   answer()       after a solve: loads go to the structures, which march; true when the fluid is to solve once more
//   place_walls()  walls go to where the structures are
//
// Over a step from t to t + dt a load f is held, and a structure whose displacement was u0 comes to u1. The fluid always
// has its mean velocity V = (u1 - u0) / dt, never that of the end: only with the mean is the answer to a load positive.
// Without structures all of this does nothing.

#include <limits>
#include <string>
#include <vector>

#include "coupling/coupling_options.hpp"
#include "coupling/elastic_body.hpp"
#include "coupling/exchange.hpp"
#include "coupling/interface_ledger.hpp"
#include "coupling/structure_answer.hpp"
#include "coupling/surface_load.hpp"
#include "coupling/wall_rows.hpp"
#include "kernels/operators/swept_volume.hpp"
#include "kernels/pressure_solver.hpp"
#include "kernels/survey.hpp"

namespace greenwater {

class Coupler {
 public:
  Coupler() = default;
  Coupler(std::vector<ElasticBody> bodies, const WallFaces& walls, const CouplingOptions& options);

  bool any() const { return !bodies_.empty(); }
  /// Whether a step may have to be made again from its start, walls and all (classic scheme).
  bool repeats_steps() const { return any() && options_.way == CouplingWay::aitken; }

  /// From t to t + dt, which the fluid has not begun: structures march under the load at t, and walls get the speeds of that
  /// march; joint, aitken: as a first guess.
  void foresee(Fluid& fluid, double dt);

  /// After the rows and the survey of this step: rows of the walls, and what they sweep beyond what the survey has seen into
  /// the source. With `joint` D C D^T goes into the operator, and what the load at t makes of the speeds goes out of the
  /// source, as it is part of the solve.
  void join(const Fluid& fluid, const Survey& survey, PressureSystem& system, double dt);

  /// After a solve of the default scheme. Corrects the right side where it says so.
  bool answer(Fluid& fluid, PressureSystem& system, double dt);
  /// After a solve of the classic scheme, whose walls stand where they will be: true when the step is to be made again
  /// from its start, with walls that place_walls() moves anew.
  bool answer_of_whole_step(Fluid& fluid, double dt);

  /// Walls go to where they are at t + dt, with the velocity with which the fluid has seen them. Throws NumericsError when
  /// a structure's march has diverged, or it has folded so that walls cannot be there.
  void place_walls(Fluid& fluid, double dt);
  /// The step is over.
  void finish(const Fluid& fluid, double dt);

  /// Asks for the added mass in the step that comes: one solve more for each structure.
  void ask_for_added_mass() { weighs_ = any(); }
  bool weighs() const { return weighs_; }
  /// After answer(): what it is, of the water as it stands. b = -rho D a for accelerations a of the walls as in the first
  /// dry mode gives the pressure against them, and that the added mass of the mode.
  void weigh(const Fluid& fluid, const PressureSystem& system, PressureSolver& solver, double dt);

  /// What lasts from step to step, that of the structures' marches too: to be kept and put back when a step is undone.
  struct State;
  void keep(State& state) const;
  /// Walls are another's to put back.
  void put_back(const State& state);

  const ElasticBody& body(std::size_t k) const { return bodies_[k].body; }
  /// Forces of the fluid on the corners of a structure [N/m], in 3-D [N].
  const Eigen::VectorXd& loads(std::size_t k) const { return bodies_[k].load; }
  const InterfaceLedger& ledger(std::size_t k) const { return bodies_[k].ledger; }
  /// Added mass over that of the structure, both of its first dry mode, when it was last asked for; not a number before.
  double added_mass_ratio(std::size_t k) const { return bodies_[k].added_mass; }
  /// Marches of the structures in the last step, one of all of them counted as one.
  int passes() const { return passes_; }
  /// Whether the last step ended without agreement.
  bool disagreed() const { return disagreed_; }
  /// A notice of walls whose accelerations alternate and grow, or nothing.
  std::string alarm() const;

 private:
  /// Of one structure, what lasts from step to step beside its march.
  struct Lasting {
    Eigen::VectorXd placed;   // displacement of the corners where the walls stand [m]
    Eigen::VectorXd base;     // speeds in the right side of the solve; joint: as they are without pressure [m/s]
    Eigen::VectorXd speed;    // of the walls in this step [m/s]
    Eigen::VectorXd before;   // in the last one
    Eigen::VectorXd load;     // on the corners
    Eigen::VectorXd applied;  // that under which the structure has gone through this step
    double added_mass = std::numeric_limits<double>::quiet_NaN();  // over the structure's
    InterfaceLedger ledger;
  };
  struct Coupled : Lasting {
    Coupled(ElasticBody given, const WallFaces& walls, int first);

    ElasticBody body;
    std::string name;  // of the structure
    int first_unknown = 0;
    StructureAnswer answer;  // C
    WallQuadrature quadrature;
    // The load is that of the particles' pressure, of gravity between them and the wall, and -layer (V - V0).
    Eigen::VectorXd pressed, known;
    Eigen::SparseMatrix<double> layer;  // L (structure_answer.hpp)
    Eigen::VectorXd mode;               // the corners in the first dry mode, of modal mass 1 kg; empty until asked for
    March::State start;                 // of this step
    March::State foreseen;              // at its end, under the load of the last one
    CornerMotion motion;
    Exchange<CoordField> velocity, acceleration;
  };

  void march_under_loads(double dt);
  void march(Coupled& one, const Eigen::VectorXd& load, double dt);
  Eigen::VectorXd acceleration_of(const Coupled& one, double dt) const;
  void give_speeds(Fluid& fluid, Coupled& one, double dt);
  const char* cure_of_divergence() const;
  void check_ways(const Fluid& fluid, double dt) const;
  void read_loads(const Fluid& fluid, const PressureSystem* system);
  void renew_answers(double dt);
  void hand_over_answers(const Fluid& fluid, double dt);
  void look_at_walls(const Fluid& fluid, const Survey& survey, PressureSystem& system, double dt);
  void change_source(const Fluid& fluid, PressureSystem& system, const Eigen::VectorXd& by, double dt);
  Eigen::VectorXd residual() const;
  Eigen::VectorXd correction_of(const Eigen::VectorXd& residual);
  Eigen::VectorXd relaxed(const Eigen::VectorXd& residual);
  bool agreed(const Eigen::VectorXd& residual, const Fluid& fluid, double dt) const;
  Eigen::VectorXd seen(const Coupled& one) const;

  std::vector<Coupled> bodies_;
  CouplingOptions options_;
  int unknowns_ = 0, passes_ = 0;
  bool disagreed_ = false;
  AddedTerm term_;
  bool answers_changed_ = false;  // since they were handed over
  double handed_dt_ = 0;          // step with which they were [s]
  Exchange<ScalarField> felt_, change_;
  SweptVolume swept_;
  PointSampler sampler_;
  Eigen::VectorXd last_residual_;
  double relaxation_ = 0;
  bool weighs_ = false;
};

struct Coupler::State {
  std::vector<Lasting> lasting;  // of each structure
  std::vector<March::State> marches;
  double relaxation = 0;
  int passes = 0;
  bool disagreed = false, weighs = false;
};

}  // namespace greenwater
