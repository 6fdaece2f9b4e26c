#include "fem/march.hpp"

#include <cstring>
#include <numbers>

#include "core/check.hpp"
#include "fem/critical_step.hpp"
#include "fem/pack.hpp"

namespace greenwater {
namespace {

using element::lanes;
using element::Pack;

Pack load(const double* from) {
  Pack x;
  std::memcpy(&x, from, sizeof x);
  return x;
}

double sum_of(const Pack& x) {
  double sum = 0;
  for (int l = 0; l < lanes; ++l) sum += x[l];
  return sum;
}

/// Work of the loads and power lost in one step, each over its length.
struct Powers {
  double loads = 0, lost = 0;
};

/// The arrays that a step reads and writes.
struct StepArrays {
  const double *keep, *push, *given, *outer, *inner, *mass;
  double *u, *v;
  double h;
};

/// One step of the unknowns from `i` on, T at once.
template <class T, class Read, class Write>
void step_at(const StepArrays& a, Eigen::Index i, const Read& read, const Write& write, T& loads, T& lost) {
  const T before = read(a.v + i), outer = read(a.outer + i);
  const T after = read(a.keep + i) * before + read(a.push + i) * (outer - read(a.inner + i)) + read(a.given + i);
  const T mean = 0.5 * (before + after);
  write(a.v + i, after);
  write(a.u + i, read(a.u + i) + a.h * after);
  loads += mean * outer;
  lost += mean * mean * read(a.mass + i);
}

Powers step_all(const StepArrays& a, Eigen::Index count) {
  Pack loads{}, lost{};
  Powers powers;
  Eigen::Index i = 0;
  for (; i + lanes <= count; i += lanes) {
    step_at(
        a, i, load, [](double* to, const Pack& x) { std::memcpy(to, &x, sizeof x); }, loads, lost);
  }
  const auto read = [](const double* from) { return *from; };
  for (; i < count; ++i) {
    step_at(
        a, i, read, [](double* to, double x) { *to = x; }, powers.loads, powers.lost);
  }
  powers.loads += sum_of(loads);
  powers.lost += sum_of(lost);
  return powers;
}

Eigen::VectorXd or_zero(const Eigen::VectorXd& x, Eigen::Index size) {
  if (x.size() == 0) return Eigen::VectorXd::Zero(size);
  expect(x.size() == size);
  return x;
}

}  // namespace

double damping_of(double ratio, double frequency) { return 4 * std::numbers::pi * ratio * frequency; }

March::March(const Solid& solid, Supports supports, Loads loads, const MarchOptions& options,
             const Eigen::VectorXd& displacement, const Eigen::VectorXd& velocity, std::optional<Contact> contact)
    : solid_(solid),
      supports_(std::move(supports)),
      loads_(std::move(loads)),
      contact_(std::move(contact)),
      options_(options) {
  const double alone = critical_step(solid_, supports_), h = options_.step, alpha = options_.damping;
  const double limit = contact_ ? Contact::critical_step(alone, contact_->stiffness()) : alone;
  require(h > 0 && h < limit, "the step of the structure is ", h, " s; it has to be above 0 and below ", limit,
          " s (2/omega_max), or coarsen the mesh");
  require(alpha >= 0, "the damping of the structure is ", alpha, " 1/s; it cannot be negative");
  const Eigen::Index n = solid_.unknowns();
  now_.time = options_.start;
  now_.u = or_zero(displacement, n);
  now_.held = now_.reaction = given_ = place_ = drag_ = inner_ = outer_ = next_held_ = Eigen::VectorXd::Zero(n);
  keep_ = Eigen::VectorXd::Constant(n, (1 - alpha * h / 2) / (1 + alpha * h / 2));
  push_ = h / (1 + alpha * h / 2) * solid_.mass().cwiseInverse();
  for (const int i : supports_.held) keep_[i] = push_[i] = 0;
  if (contact_) now_.contact = contact_->begin(now_.time, alone);
  start(or_zero(velocity, n));
}

/// v(-1/2) = v(0) - h/2 a(0); of moving supports 2 v(1/2) - v(3/2), as they may have been at rest before.
void March::start(const Eigen::VectorXd& velocity) {
  const double h = options_.step;
  for (const auto& motion : supports_.motions) motion.displacement(now_.time, now_.u);
  solid_.internal_force(now_.u, inner_);
  if (contact_) contact_->push(now_.contact, {now_.time, 1, now_.u, now_.u}, inner_);
  loads_.prepare(solid_, now_.time, now_.time);
  loads_.evaluate(solid_, now_.time, now_.u, outer_);
  const Eigen::VectorXd acceleration = (outer_ - inner_).cwiseQuotient(solid_.mass()) - options_.damping * velocity;
  now_.v = velocity - h / 2 * acceleration;
  for (const int i : supports_.held) now_.v[i] = 0;
  for (const auto& motion : supports_.motions) {
    motion.displacement(now_.time + h, place_);
    for (const int i : motion.unknowns) now_.v[i] = 3 * place_[i] - 2 * now_.u[i];
    motion.displacement(now_.time + 2 * h, place_);
    for (const int i : motion.unknowns) now_.v[i] = (now_.v[i] - place_[i]) / h;
  }
  update_reaction();
}

void March::advance(int steps) {
  next_held_ = now_.held;
  advance(steps, next_held_);
}

void March::advance(int steps, const Eigen::VectorXd& held) {
  expect(held.size() == solid_.unknowns());
  const double end = now_.time + steps * options_.step;
  loads_.prepare(solid_, now_.time, end);
  if (contact_ && steps > 0) contact_->prepare(now_.time, end);
  for (int step = 0; step < steps; ++step) {
    if (step < 2 || !loads_.steady()) {
      loads_.evaluate(solid_, now_.time, now_.u, outer_);
      if (step == 0)
        outer_ += 0.5 * (now_.held + held);
      else
        outer_ += held;
    }
    solid_.internal_force(now_.u, inner_);
    if (contact_) feel_walls();
    move_supports();
    kick();
  }
  now_.held = held;
  if (steps > 0) update_reaction();
  require<NumericsError>(now_.u.allFinite(), "the displacement of the structure is not finite any more at ", now_.time,
                         " s: its elements have turned inside out; refine them, lower the load, or shorten the step");
}

void March::feel_walls() {
  const Contact::Instant now{now_.time, options_.step, now_.u, now_.v};
  contact_->push(now_.contact, now, inner_);
  const double power = contact_->power(now_.contact, now);
  now_.supports += 0.5 * options_.step * (power + now_.contact.power);
  now_.contact.power = power;
}

void March::move_supports() {
  for (const auto& motion : supports_.motions) {
    motion.displacement(now_.time + options_.step, place_);
    for (const int i : motion.unknowns) {
      const double before = now_.v[i], after = (place_[i] - now_.u[i]) / options_.step, mean = (before + after) / 2;
      given_[i] = after;
      drag_[i] = solid_.mass()[i] * ((after - before) / options_.step + options_.damping * mean);
      now_.supports += options_.step * mean * (drag_[i] + inner_[i] - outer_[i]);
    }
  }
}

void March::kick() {
  const double h = options_.step;
  const StepArrays arrays{keep_.data(),  push_.data(),  given_.data(),
                          outer_.data(), inner_.data(), solid_.mass().data(),
                          now_.u.data(), now_.v.data(), h};
  const Powers powers = step_all(arrays, now_.u.size());
  now_.loads += h * powers.loads;
  now_.lost += h * options_.damping * powers.lost;
  now_.time += h;
}

void March::update_reaction() {
  for (const int i : supports_.held) now_.reaction[i] = inner_[i] - outer_[i] + drag_[i];
}

Energies March::energies() const {
  const Eigen::VectorXd before = now_.u - options_.step * now_.v;
  Eigen::VectorXd force(before.size());
  solid_.internal_force(before, force);
  const double half = 0.5 * options_.step * now_.v.dot(force);
  const double strain = (solid_.linear() ? 0.5 * before.dot(force) : solid_.strain_energy(before)) + half;
  const double then = now_.time - options_.step;
  const double contact = contact_ ? contact_->energy(now_.contact, {then, options_.step, before, now_.v}) : 0;
  return {.kinetic = 0.5 * now_.v.cwiseAbs2().dot(solid_.mass()),
          .strain = strain,
          .contact = contact,
          .lost = now_.lost,
          .loads = now_.loads,
          .supports = now_.supports};
}

}  // namespace greenwater
