#pragma once
// A structure in time: explicit central differences with lumped mass and damping C = alpha M,
//   v(n+1/2) = [(1 - alpha h/2) v(n-1/2) + h M^-1 (f_ext - f_int)] / (1 + alpha h/2),   u(n+1) = u(n) + h v(n+1/2).

#include <Eigen/Dense>
#include <optional>

#include "fem/contact.hpp"
#include "fem/loads.hpp"
#include "fem/solid.hpp"
#include "fem/supports.hpp"

namespace greenwater {

struct MarchOptions {
  double step = 0;     // h      [s]
  double damping = 0;  // alpha  [1/s]
  double start = 0;    // time of the first instant [s]
};

/// alpha [1/s] that damps a mode of this frequency [Hz] with this ratio of the critical.
double damping_of(double ratio, double frequency);

/// What a structure has and has had [J]. Without contact and loads that follow or change, and with small strain, kinetic +
/// strain + contact + lost - loads - supports stays the same to round-off; else to the square of the step.
struct Energies {
  double kinetic = 0;   // of the velocity half a step back
  double strain = 0;    // u(n-1) K u(n) / 2; in large displacement W(u(n-1)) + (u(n) - u(n-1)) f_int(u(n-1)) / 2
  double contact = 0;   // of the springs at walls, in the same way
  double lost = 0;      // to damping since the start
  double loads = 0;     // work of the loads since the start, those held too
  double supports = 0;  // work of moving supports, and of moving walls that it touches, since the start

  double balance() const { return kinetic + strain + contact + lost - loads - supports; }
};

class March {
 public:
  /// What changes in time, to be kept and put back when a step is repeated.
  struct State {
    double time = 0;                           // [s]
    Eigen::VectorXd u;                         // displacement [m]
    Eigen::VectorXd v;                         // velocity half a step back [m/s]
    Eigen::VectorXd held;                      // load held over the last call of advance() [N]
    Eigen::VectorXd reaction;                  // of the supports in the last step [N]
    double lost = 0, loads = 0, supports = 0;  // see Energies
    Contact::State contact;                    // empty without
  };

  /// Displacement [m] and velocity [m/s] are those of the first instant; empty ones are zero. Throws CaseError when the
  /// step is not below the critical one. Keeps a reference to the solid.
  March(const Solid& solid, Supports supports, Loads loads, const MarchOptions& options,
        const Eigen::VectorXd& displacement = {}, const Eigen::VectorXd& velocity = {},
        std::optional<Contact> contact = {});

  /// Takes steps under the loads and, beside them, a load held [N], that of the fluid. The first step has half of what
  /// was held before and half of what is held now: then the displacement under the new load is that of exact sums of
  /// cosines, and never against it. Allocates nothing, but where contact finds more nodes near walls than before. Throws NumericsError when a displacement is not finite.
  void advance(int steps, const Eigen::VectorXd& held);
  /// With what was held before, nothing at the start.
  void advance(int steps);

  /// As if this had been held before [N]: then the next advance() has all of its load in the first step too.
  void set_held(const Eigen::VectorXd& held) { now_.held = held; }

  const State& state() const { return now_; }
  void set_state(const State& state) { now_ = state; }
  double time() const { return now_.time; }
  const Eigen::VectorXd& displacement() const { return now_.u; }
  /// Half a step back.
  const Eigen::VectorXd& velocity() const { return now_.v; }
  Energies energies() const;
  /// Force of the supports on the structure in the last step, for each unknown; 0 where it is free [N].
  const Eigen::VectorXd& reaction() const { return now_.reaction; }

 private:
  void start(const Eigen::VectorXd& velocity);
  void feel_walls();
  void move_supports();
  void kick();
  void update_reaction();

  const Solid& solid_;
  Supports supports_;
  Loads loads_;
  std::optional<Contact> contact_;
  MarchOptions options_;
  State now_;
  Eigen::VectorXd keep_;   // (1 - alpha h/2) / (1 + alpha h/2), 0 where held
  Eigen::VectorXd push_;   // h M^-1 / (1 + alpha h/2), 0 where held
  Eigen::VectorXd given_;  // velocity of moving supports [m/s], 0 elsewhere
  Eigen::VectorXd place_;  // where moving supports are next [m]
  Eigen::VectorXd drag_;   // force that moves them: M (a + alpha v) [N]
  Eigen::VectorXd inner_, outer_, next_held_;
};

}  // namespace greenwater
