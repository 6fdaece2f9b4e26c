#include "coupling/coupler.hpp"

#include <algorithm>
#include <cmath>

#include "core/check.hpp"
#include "fem/modes.hpp"

namespace greenwater {
namespace {

Reading reading_of(LoadReading load) {
  return load == LoadReading::kernel_average ? Reading::average : Reading::neumann;
}

void put(const Eigen::RowVectorXd& from, double factor, real* to) {
  for (Eigen::Index i = 0; i < from.size(); ++i) to[i] = static_cast<real>(factor * from[i]);
}

void fill(Exchange<CoordField>& field, const Eigen::VectorXd& values, int dim) {
  for (Eigen::Index i = 0; i < values.size(); ++i) field.host(i / dim, i % dim) = values[i];
  field.push();
}

}  // namespace

Coupler::Coupled::Coupled(ElasticBody given, const WallFaces& walls, int first)
    : body(std::move(given)), name(walls.bodies[walls.faces[body.first_face].body].name), first_unknown(first) {
  const int dim = walls.dim, corners = body.surface.corners();
  velocity = Exchange<CoordField>("greenwater::corner_velocity", corners, dim);
  acceleration = Exchange<CoordField>("greenwater::corner_acceleration", corners, dim);
  placed = body.surface.at_corners(body.march->displacement());
  base = speed = load = applied = pressed = Eigen::VectorXd::Zero(dim * corners);
  before = body.surface.at_corners(body.march->velocity());
  const auto& faces = body.surface.corner_of_face();
  Exchange<IndexField> corner_of_face("greenwater::corner_of_face", dim * faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (int e = 0; e < dim; ++e) corner_of_face.host(dim * f + e) = faces[f][e];
  corner_of_face.push();
  motion = {walls.faces[body.first_face].body, body.first_face, corner_of_face.device, velocity.device,
            acceleration.device};
}

Coupler::Coupler(std::vector<ElasticBody> bodies, const WallFaces& walls, const CouplingOptions& options)
    : options_(options), relaxation_(options.first_relaxation) {
  for (ElasticBody& body : bodies) {
    bodies_.emplace_back(std::move(body), walls, unknowns_);
    unknowns_ += walls.dim * bodies_.back().body.surface.corners();
  }
  if (!any()) return;
  felt_ = Exchange<ScalarField>("greenwater::corner_load", unknowns_);
  change_ = Exchange<ScalarField>("greenwater::corner_change", unknowns_);
}

/// From the start of the step. The paper's load is that of the instant; one that is found later acts half in the first
/// kick (fem/march.hpp).
void Coupler::march(Coupled& one, const Eigen::VectorXd& load, double dt) {
  Region region("structures");
  const Eigen::VectorXd force = one.body.surface.on_nodes(load);
  one.body.march->set_state(one.start);
  if (options_.way == CouplingWay::staggered) one.body.march->set_held(force);
  try {
    one.body.march->advance(substeps(one.body, dt), force);
  } catch (const NumericsError& error) {
    throw NumericsError(text_of("\"", one.name, "\": ", error.what(), " -> ", cure_of_divergence()));
  }
  one.speed = (one.body.surface.at_corners(one.body.march->displacement()) - one.placed) / dt;
}

Eigen::VectorXd Coupler::acceleration_of(const Coupled& one, double dt) const {
  if (!options_.walls_accelerate) return Eigen::VectorXd::Zero(one.speed.size());
  return (one.speed - one.before) / dt;
}

void Coupler::give_speeds(Fluid& fluid, Coupled& one, double dt) {
  const int dim = fluid.faces.dim;
  fill(one.velocity, one.speed, dim);
  fill(one.acceleration, acceleration_of(one, dt), dim);
  set_wall_motion(fluid.walls, dim, one.motion);
}

void Coupler::foresee(Fluid& fluid, double dt) {
  if (!any()) return;
  passes_ = 1;
  disagreed_ = false;
  last_residual_.resize(0);
  renew_answers(dt);
  for (Coupled& one : bodies_) {
    one.start = one.body.march->state();
    one.applied = one.load;
    march(one, one.load, dt);
    one.foreseen = one.body.march->state();
    one.base = one.speed;
    give_speeds(fluid, one, dt);
  }
}

void Coupler::join(const Fluid& fluid, const Survey& survey, PressureSystem& system, double dt) {
  if (!any()) return;
  Region region("coupling");
  look_at_walls(fluid, survey, system, dt);
  if (options_.way != CouplingWay::joint) return;
  hand_over_answers(fluid, dt);
  system.set_added(&term_);
  Eigen::VectorXd change(unknowns_);
  for (Coupled& one : bodies_) {
    // What the speeds would be without pressure, as the answer tells it: what the answer is wrong by is then that of the
    // load's change.
    const Eigen::VectorXd other = one.known + one.layer * one.before - one.load;
    one.base = one.answer.with_layer(one.speed + one.answer.matrix() * other);
    change.segment(one.first_unknown, one.base.size()) = one.base - one.speed;
  }
  change_source(fluid, system, change, dt);
}

/// D, and the difference between what it makes of the walls' speeds and what the survey has made of them.
void Coupler::look_at_walls(const Fluid& fluid, const Survey& survey, PressureSystem& system, double dt) {
  const int dim = fluid.faces.dim;
  std::vector<AddedEntry> rows;
  for (Coupled& one : bodies_) {
    const auto pushes = wall_pushes(fluid, survey, one.motion.body);
    if (one.quadrature.points().empty())
      one.quadrature =
          quadrature_of(one.body.surface, fluid.faces, one.body.first_face, fluid.grid.shape(), fluid.spacing);
    else
      one.quadrature.move_to(fluid.faces);
    one.quadrature.weigh(pushes);
    add_wall_rows(pushes, one.quadrature, one.body.surface, dim, one.body.first_face, one.first_unknown, rows);
    one.known = known_load(pushes, one.quadrature, one.body.surface, dim, one.body.first_face, fluid.rho);
    one.layer = layer_mass(pushes, one.quadrature, one.body.surface, dim, one.body.first_face, fluid.rho) / dt;
    if (options_.way == CouplingWay::joint) {
      answers_changed_ |= one.answer.take_layer(one.layer);
      one.layer = one.answer.layer();
    }
    swept_.gather(pushes, one.quadrature, [&](int face, const Triple& x) {
      const auto shares = shares_at(fluid.faces.faces[face], dim, x);
      const auto& corners = one.body.surface.corner_of_face()[face - one.body.first_face];
      Triple v{};
      for (int e = 0; e < dim; ++e)
        for (int d = 0; d < dim; ++d) v[d] += shares[e] * one.speed[dim * corners[e] + d];
      return v;
    });
  }
  term_.set_rows(unknowns_, rows);
  swept_.add_to(system.rhs(), system.fixed(), source_per_volume(fluid, dt));
}

void Coupler::renew_answers(double dt) {
  if (options_.way != CouplingWay::joint) return;
  for (Coupled& one : bodies_) answers_changed_ |= one.answer.renew(one.body, one.placed, dt);
}

void Coupler::hand_over_answers(const Fluid& fluid, double dt) {
  if (!answers_changed_ && dt == handed_dt_) return;
  answers_changed_ = false;
  handed_dt_ = dt;
  const double scale = -source_per_volume(fluid, dt);
  std::vector<real> C(static_cast<std::size_t>(unknowns_) * unknowns_, 0), leading;
  for (const Coupled& one : bodies_) {
    const Eigen::MatrixXd &matrix = one.answer.matrix_with_layer(), &rows = one.answer.leading_with_layer();
    for (Eigen::Index row = 0; row < matrix.rows(); ++row)
      put(matrix.row(row), scale, &C[(one.first_unknown + row) * unknowns_ + one.first_unknown]);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      leading.resize(leading.size() + unknowns_, 0);
      put(rows.row(k), std::sqrt(scale), leading.data() + leading.size() - unknowns_ + one.first_unknown);
    }
  }
  term_.set_answer(C, leading);
}

void Coupler::read_loads(const Fluid& fluid, const PressureSystem* system) {
  Region region("coupling");
  if (options_.load == LoadReading::transpose) {
    expect(system != nullptr);
    term_.feel(fluid.particles.pressure, felt_.device);
    felt_.pull();
    for (Coupled& one : bodies_) {
      for (Eigen::Index i = 0; i < one.load.size(); ++i) one.pressed[i] = felt_.host(one.first_unknown + i);
      one.load = one.pressed + one.known - one.layer * (seen(one) - one.before);
    }
    return;
  }
  for (Coupled& one : bodies_)
    one.load =
        greenwater::read_loads(sampler_, fluid, one.body.surface, one.body.first_face, reading_of(options_.load));
}

/// The speeds of the walls as the solve had them.
Eigen::VectorXd Coupler::seen(const Coupled& one) const {
  if (options_.way != CouplingWay::joint) return one.base;
  return one.base + one.answer.matrix_with_layer() * one.pressed;
}

Eigen::VectorXd Coupler::residual() const {
  Eigen::VectorXd all(unknowns_);
  for (const Coupled& one : bodies_) all.segment(one.first_unknown, one.speed.size()) = one.speed - seen(one);
  return all;
}

bool Coupler::agreed(const Eigen::VectorXd& residual, const Fluid& fluid, double dt) const {
  constexpr double at_rest = 1e-9;  // x spacing / dt
  double fastest = 0;
  for (const Coupled& one : bodies_) fastest = std::max(fastest, one.speed.lpNorm<Eigen::Infinity>());
  return residual.lpNorm<Eigen::Infinity>() <= options_.tolerance * fastest + at_rest * fluid.spacing / dt;
}

/// Aitken's relaxation: omega_k+1 = -omega_k r_k . (r_k+1 - r_k) / |r_k+1 - r_k|^2, kept from step to step.
Eigen::VectorXd Coupler::relaxed(const Eigen::VectorXd& residual) {
  constexpr double least = 0.01, most = 1;
  if (last_residual_.size() > 0) {
    const Eigen::VectorXd change = residual - last_residual_;
    const double size2 = change.squaredNorm();
    if (size2 > 0) relaxation_ *= -last_residual_.dot(change) / size2;
    relaxation_ = std::clamp(relaxation_, least, most);
  }
  last_residual_ = residual;
  return relaxation_ * residual;
}

/// Of the speeds in the right side. Those that the solve has with them answer with the layer of fluid as well.
Eigen::VectorXd Coupler::correction_of(const Eigen::VectorXd& residual) {
  if (options_.way != CouplingWay::joint) return relaxed(residual);
  Eigen::VectorXd by(unknowns_);
  for (const Coupled& one : bodies_) {
    const Eigen::Index first = one.first_unknown, size = one.base.size();
    by.segment(first, size) = one.answer.with_layer(residual.segment(first, size));
  }
  return by;
}

void Coupler::change_source(const Fluid& fluid, PressureSystem& system, const Eigen::VectorXd& by, double dt) {
  for (Eigen::Index i = 0; i < by.size(); ++i) change_.host(i) = static_cast<real>(by[i]);
  change_.push();
  term_.add_source(system.fixed(), source_per_volume(fluid, dt), change_.device, system.rhs());
}

/// A structure that the fluid has not touched and does not touch has gone its way already.
void Coupler::march_under_loads(double dt) {
  ++passes_;
  for (Coupled& one : bodies_) {
    const bool alone = one.load.isZero(0) && one.applied.isZero(0);
    one.applied = one.load;
    if (alone)
      one.body.march->set_state(one.foreseen);
    else
      march(one, one.load, dt);
  }
}

bool Coupler::answer(Fluid& fluid, PressureSystem& system, double dt) {
  if (!any()) return false;
  read_loads(fluid, &system);
  if (options_.way == CouplingWay::staggered) return false;
  march_under_loads(dt);
  const Eigen::VectorXd r = residual();
  const bool good = agreed(r, fluid, dt);
  if (good || passes_ > options_.most_passes) {
    disagreed_ = !good;
    for (Coupled& one : bodies_) {
      one.base = seen(one);
      give_speeds(fluid, one, dt);
    }
    return false;
  }
  const Eigen::VectorXd by = correction_of(r);
  for (Coupled& one : bodies_) one.base += by.segment(one.first_unknown, one.base.size());
  change_source(fluid, system, by, dt);
  return true;
}

bool Coupler::answer_of_whole_step(Fluid& fluid, double dt) {
  if (!any()) return false;
  read_loads(fluid, nullptr);
  if (options_.way == CouplingWay::staggered) return false;
  march_under_loads(dt);
  const Eigen::VectorXd r = residual();
  disagreed_ = !agreed(r, fluid, dt);
  const bool again = disagreed_ && passes_ <= options_.most_passes;
  const Eigen::VectorXd by = again ? relaxed(r) : Eigen::VectorXd::Zero(unknowns_);
  for (Coupled& one : bodies_) one.speed = one.base += by.segment(one.first_unknown, one.base.size());
  return again;
}

const char* Coupler::cure_of_divergence() const {
  return options_.way == CouplingWay::staggered ? "coupling.scheme = \"default\" or \"aitken\""
                                                : "a shorter mps.time_step";
}

/// What has diverged ends here, before walls are made of it.
void Coupler::check_ways(const Fluid& fluid, double dt) const {
  // x spacing; beyond one spacing a step the fluid cannot follow what has not waited for it
  const double far = options_.way == CouplingWay::staggered ? 1 : 100;
  for (const Coupled& one : bodies_) {
    const double way = dt * one.speed.lpNorm<Eigen::Infinity>();
    require<NumericsError>(way <= far * fluid.spacing, "t = ", fluid.time, " s: \"",
                           fluid.faces.bodies[one.motion.body].name, "\" moves ", way,
                           " m in one step of the fluid: it does not march soundly with it -> ", cure_of_divergence());
  }
}

void Coupler::place_walls(Fluid& fluid, double dt) {
  if (!any()) return;
  Region region("moving_walls");
  check_ways(fluid, dt);
  const int dim = fluid.faces.dim;
  for (const Coupled& one : bodies_) {
    const auto& corners = one.body.surface.corner_of_face();
    const Eigen::VectorXd acceleration = acceleration_of(one, dt);
    for (std::size_t f = 0; f < corners.size(); ++f)
      for (int e = 0; e < dim; ++e)
        for (int d = 0; d < dim; ++d) {
          const int i = dim * corners[f][e] + d;
          WallPoint& point = fluid.faces.faces[one.body.first_face + f].corner[e];
          point.position[d] = one.body.surface.rest()[corners[f][e]][d] + one.placed[i] + dt * one.speed[i];
          point.velocity[d] = one.speed[i];
          point.acceleration[d] = acceleration[i];
        }
  }
  try {
    make_mirror_walls(fluid.walls, fluid.faces, fluid.grid.shape(), fluid.spacing);
  } catch (const CaseError& error) {  // nobody's input any more
    throw NumericsError(
        text_of("t = ", fluid.time, " s: a structure has come to where walls cannot be: ", error.what()));
  }
}

void Coupler::finish(const Fluid& fluid, double dt) {
  constexpr double felt = 1e-4;  // x spacing / dt: slower walls may do as they like
  for (Coupled& one : bodies_) {
    one.ledger.add(one.load, one.applied, one.base, one.speed, one.body.surface.fluid_dim(), one.body.surface.depth(),
                   dt, felt * fluid.spacing / dt);
    one.placed += dt * one.speed;
    one.before = one.speed;
  }
}

void Coupler::keep(State& state) const {
  state.lasting.resize(bodies_.size());
  state.marches.resize(bodies_.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    state.lasting[k] = bodies_[k];
    state.marches[k] = bodies_[k].body.march->state();
  }
  state.relaxation = relaxation_;
  state.passes = passes_;
  state.disagreed = disagreed_;
  state.weighs = weighs_;
}

void Coupler::put_back(const State& state) {
  expect(state.lasting.size() == bodies_.size());
  for (std::size_t k = 0; k < bodies_.size(); ++k) {
    static_cast<Lasting&>(bodies_[k]) = state.lasting[k];
    bodies_[k].body.march->set_state(state.marches[k]);
  }
  relaxation_ = state.relaxation;
  passes_ = state.passes;
  disagreed_ = state.disagreed;
  weighs_ = state.weighs;
}

void Coupler::weigh(const Fluid& fluid, const PressureSystem& system, PressureSolver& solver, double dt) {
  constexpr double strong = 1e9;  // m/s^2, so that no absolute tolerance of the solver is met
  weighs_ = false;
  Region region("added_mass");
  const std::size_t room = fluid.particles.id.extent(0);
  ScalarField b("greenwater::added_mass_source", room), p("greenwater::added_mass_pressure", room);
  for (Coupled& one : bodies_) {
    if (one.mode.size() == 0)
      one.mode = one.body.surface.at_corners(lowest_modes(*one.body.solid, *one.body.supports, 1).shapes.col(0));
    Eigen::VectorXd all = Eigen::VectorXd::Zero(unknowns_);
    all.segment(one.first_unknown, one.mode.size()) = one.mode;
    for (Eigen::Index i = 0; i < all.size(); ++i) change_.host(i) = static_cast<real>(strong * all[i]);
    change_.push();
    Kokkos::deep_copy(b, real(0));
    Kokkos::deep_copy(p, real(0));
    term_.add_source(system.fixed(), source_per_volume(fluid, 1), change_.device, b);
    PressureSystem still({});
    still.assemble(fluid, b, system.diagonal(), system.fixed());
    solver.solve(still, p);
    term_.feel(p, felt_.device);
    felt_.pull();
    double mass = 0;
    for (Eigen::Index i = 0; i < one.mode.size(); ++i) mass -= one.mode[i] * felt_.host(one.first_unknown + i);
    mass = mass / strong + dt * one.mode.dot(one.layer * one.mode);
    one.added_mass = one.body.surface.depth() * mass;
  }
}

std::string Coupler::alarm() const {
  constexpr int many = 4;
  if (options_.way != CouplingWay::staggered) return {};
  for (const Coupled& one : bodies_) {
    if (one.ledger.alternations() < many) continue;
    return text_of("the walls' accelerations have changed sign in ", one.ledger.alternations(),
                   " steps in a row, each time ", one.ledger.growth(),
                   " times as large: the added mass of the fluid is that many times the structure's, and a staggered "
                   "march cannot bear more than 1 -> coupling.scheme = \"default\" or \"aitken\"");
  }
  return {};
}

}  // namespace greenwater
