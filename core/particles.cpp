#include "core/particles.hpp"

#include <utility>

namespace greenwater {
namespace {

void number_from_zero(const IndexField& id) {
  Kokkos::parallel_for(
      "greenwater::number_particles", Range(0, static_cast<int>(id.extent(0))),
      KOKKOS_LAMBDA(const int i) { id(i) = i; });
}

template <int Dim>
void gather_in(const Particles& from, const IndexField& order, const Particles& to, int count) {
  const auto id = Read<IndexField>(from.id);
  const auto x = Read<CoordField>(from.position);
  const auto u = Read<VectorField>(from.velocity);
  const auto p = Read<ScalarField>(from.pressure);
  const auto surface = Read<FlagField>(from.surface);
  const auto new_id = to.id;
  const auto new_x = to.position;
  const auto new_u = to.velocity;
  const auto new_p = to.pressure;
  const auto new_surface = to.surface;
  Kokkos::parallel_for(
      "greenwater::reorder", Range(0, count), KOKKOS_LAMBDA(const int k) {
        const int i = order(k);
        new_id(k) = id(i);
        for (int d = 0; d < Dim; ++d) new_x(k, d) = x(i, d);
        for (int d = 0; d < Dim; ++d) new_u(k, d) = u(i, d);
        new_p(k) = p(i);
        new_surface(k) = surface(i);
      });
}

void gather_extra(const VectorField& from, const IndexField& order, const VectorField& to, int count) {
  const int dim = static_cast<int>(from.extent(1));
  Kokkos::parallel_for(
      "greenwater::reorder_extra", Range(0, count), KOKKOS_LAMBDA(const int k) {
        for (int d = 0; d < dim; ++d) to(k, d) = from(order(k), d);
      });
}

template <class Field>
void copy_field(const Field& from, Field& to) {
  if (to.extent(0) != from.extent(0))
    to = Field(Kokkos::view_alloc(from.label() + "_copy", Kokkos::WithoutInitializing), from.layout());
  Kokkos::deep_copy(to, from);
}

}  // namespace

void copy(const Particles& from, Particles& to) {
  to.dim = from.dim;
  to.count = from.count;
  copy_field(from.id, to.id);
  copy_field(from.position, to.position);
  copy_field(from.velocity, to.velocity);
  copy_field(from.acceleration, to.acceleration);
  copy_field(from.pressure, to.pressure);
  copy_field(from.number_density, to.number_density);
  copy_field(from.surface, to.surface);
  to.extras.resize(from.extras.size());
  for (std::size_t k = 0; k < from.extras.size(); ++k) {
    to.extras[k].name = from.extras[k].name;
    to.extras[k].unit = from.extras[k].unit;
    copy_field(from.extras[k].values, to.extras[k].values);
  }
}

Particles make_particles(int dim, int count) {
  Particles p;
  p.dim = dim;
  p.count = count;
  const int room = padded(count);
  p.id = IndexField("greenwater::id", room);
  p.position = CoordField("greenwater::position", room, dim);
  p.velocity = VectorField("greenwater::velocity", room, dim);
  p.acceleration = VectorField("greenwater::acceleration", room, dim);
  p.pressure = ScalarField("greenwater::pressure", room);
  p.number_density = ScalarField("greenwater::number_density", room);
  p.surface = FlagField("greenwater::surface", room);
  number_from_zero(p.id);
  return p;
}

int add_extra(Particles& particles, const std::string& name, const std::string& unit) {
  particles.extras.push_back({name, unit, VectorField("greenwater::" + name, particles.id.extent(0), particles.dim)});
  return static_cast<int>(particles.extras.size()) - 1;
}

// Acceleration and n are not carried over: every step writes them anew before anybody reads them.
void Reorder::apply(Particles& particles, const IndexField& order, int kept) {
  const std::size_t room = particles.id.extent(0);
  if (other_.id.extent(0) != room || other_.dim != particles.dim) {
    other_.dim = particles.dim;
    other_.id = uncleared<IndexField>("greenwater::reorder_id", room);
    other_.position = uncleared<CoordField>("greenwater::reorder_position", room, particles.dim);
    other_.velocity = uncleared<VectorField>("greenwater::reorder_velocity", room, particles.dim);
    other_.pressure = uncleared<ScalarField>("greenwater::reorder_pressure", room);
    other_.surface = uncleared<FlagField>("greenwater::reorder_surface", room);
  }
  particles.dim == 2 ? gather_in<2>(particles, order, other_, kept) : gather_in<3>(particles, order, other_, kept);
  std::swap(particles.id, other_.id);
  std::swap(particles.position, other_.position);
  std::swap(particles.velocity, other_.velocity);
  std::swap(particles.pressure, other_.pressure);
  std::swap(particles.surface, other_.surface);
  for (ExtraField& extra : particles.extras) {
    if (extra_.extent(0) != room) extra_ = uncleared<VectorField>("greenwater::reorder_extra", room, particles.dim);
    gather_extra(extra.values, order, extra_, kept);
    std::swap(extra.values, extra_);
  }
  particles.count = kept;
}

}  // namespace greenwater
