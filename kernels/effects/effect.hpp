#pragma once
// Optional physics: one file per effect, one list per stage. What a scene does not name is not in a list, launches
// nothing and holds nothing.

#include <array>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "core/region.hpp"
#include "kernels/fluid.hpp"

namespace greenwater {

enum class Stage {
  wall_speeds,  // tells walls how they will go in this step
  force,        // adds to the acceleration, at x and u of the step's start
  walls,        // moves walls to where they are at the end of the step
  after_move    // changes x and u once they have moved; the rows are those of the last build, distances those of now
};
constexpr std::size_t stages = 4;

/// One optional piece of physics. Its name is its case-file key, its kernel label and its row in the time table.
class Effect {
 public:
  virtual ~Effect() = default;
  virtual std::string_view name() const = 0;
  virtual Stage stage() const = 0;
  /// Before the first step: adds to the fluid what the effect holds there (fields, and their places). A step that is undone
  /// puts back what was there when it began, so nothing of the fluid may come to be inside a step.
  virtual void prepare(Fluid& /*fluid*/) {}
  virtual void apply(Fluid& fluid, real dt) = 0;
};

class Effects {
 public:
  void add(std::unique_ptr<Effect> effect) {
    auto& list = list_[static_cast<std::size_t>(effect->stage())];
    list.push_back(std::move(effect));
  }

  /// Before the first step of this fluid.
  void prepare(Fluid& fluid) {
    for (auto& list : list_)
      for (auto& effect : list) effect->prepare(fluid);
  }

  void run(Stage stage, Fluid& fluid, real dt) {
    for (auto& effect : list_[static_cast<std::size_t>(stage)]) {
      Region region(effect->name());
      effect->apply(fluid, dt);
    }
  }

  const std::vector<std::unique_ptr<Effect>>& at(Stage stage) const { return list_[static_cast<std::size_t>(stage)]; }

 private:
  std::array<std::vector<std::unique_ptr<Effect>>, stages> list_;
};

struct ViscosityOptions {
  real kinematic = 0;     // nu [m^2/s]
  bool measured = false;  // lambda n^0 is what both of a pair really see of it, in place of the lattice's
};

/// acceleration += nu (2 d / (lambda n^0)) sum_j (u_j - u_i) w_ij (Koshizuka and Oka 1996). At walls of bodies with
/// no_slip an image moves with 2 u_w - u_j; at others the fluid slips freely. lambda n^0 is sum w r^2 of the lattice;
/// particles that lie in disorder see another sum, at any spacing, and `measured` takes the mean of that of the pair.
std::unique_ptr<Effect> make_viscosity(const ViscosityOptions& options);

struct CollisionOptions {
  real distance = 0.85;    // x spacing: closer than this and approaching, two particles collide
  real restitution = 0.2;  // of their relative normal speed [-]
  int sweeps = 5;          // at most: who bounces off a wall may meet the next one behind
};

/// An effect that has seen how near particles came to each other.
class Collision : public Effect {
 public:
  /// The smallest distance of two particles before the last apply() held them apart [m]; of those that are not closer than
  /// collisions any large number.
  virtual real nearest() const = 0;
};

/// Particles that come too close bounce: their normal approach speed U becomes -restitution U, shared evenly, and they
/// move on with the change. A particle in several collisions at once takes the mean of them, so that no energy is made.
std::unique_ptr<Collision> make_collision(const CollisionOptions& options);

/// A force per mass [m/s^2] at a place [m], for a velocity [m/s] and a time [s].
using ForceField =
    std::function<std::array<double, 3>(const std::array<double, 3>& x, const std::array<double, 3>& u, double t)>;

/// Adds a force per mass to that of gravity, evaluated on the host for each particle and step. It needs prepare().
std::unique_ptr<Effect> make_body_force(ForceField force);

/// Puts the corners of the faces where they are at a time [s]; velocities and accelerations are left alone.
using WallMotion = std::function<void(WallFaces& faces, double t)>;

/// Moves walls: a corner's velocity is its mean over the step, (x(t + dt) - x(t)) / dt, so that it goes as far as the
/// fluid sees it go; its acceleration is (x(t + dt) - 2 x(t) + x(t - dt)) / dt^2.
std::unique_ptr<Effect> make_moving_walls(WallMotion motion);

/// Before make_moving_walls() does so: gives the walls the velocities and accelerations of the step that comes, and
/// leaves them where they are.
std::unique_ptr<Effect> make_wall_speeds(WallMotion motion);

}  // namespace greenwater
