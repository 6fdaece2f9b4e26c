#include "core/particles.hpp"

#include <utility>

namespace greenwater {
namespace {

void number_from_zero(const IndexField& id) {
  Kokkos::parallel_for(
      "greenwater::number_particles", Range(0, static_cast<int>(id.extent(0))),
      KOKKOS_LAMBDA(const int i) { id(i) = i; });
}

template <class Field>
void gather(const Field& from, const IndexField& order, const Field& to, int count) {
  Kokkos::parallel_for(
      "greenwater::reorder", Range(0, count), KOKKOS_LAMBDA(const int k) { to(k) = from(order(k)); });
}

template <class Field>
void gather_rows(const Field& from, const IndexField& order, const Field& to, int count) {
  const int dim = static_cast<int>(from.extent(1));
  Kokkos::parallel_for(
      "greenwater::reorder", Range(0, count), KOKKOS_LAMBDA(const int k) {
        for (int d = 0; d < dim; ++d) to(k, d) = from(order(k), d);
      });
}

template <class Field>
void reorder(Field& field, Field& scratch, const IndexField& order, int count) {
  if (scratch.extent(0) != field.extent(0)) scratch = uncleared<Field>("greenwater::reorder_scratch", field.extent(0));
  gather(field, order, scratch, count);
  std::swap(field, scratch);
}

template <class Field>
void reorder_rows(Field& field, Field& scratch, const IndexField& order, int count) {
  if (scratch.extent(0) != field.extent(0) || scratch.extent(1) != field.extent(1))
    scratch = uncleared<Field>("greenwater::reorder_scratch", field.extent(0), field.extent(1));
  gather_rows(field, order, scratch, count);
  std::swap(field, scratch);
}

}  // namespace

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

// The acceleration is not carried over: every step writes it anew before anybody reads it.
void Reorder::apply(Particles& particles, const IndexField& order, int kept) {
  reorder(particles.id, index_, order, kept);
  reorder_rows(particles.position, coord_, order, kept);
  reorder_rows(particles.velocity, vector_, order, kept);
  reorder(particles.pressure, scalar_, order, kept);
  reorder(particles.number_density, scalar_, order, kept);
  reorder(particles.surface, flag_, order, kept);
  for (ExtraField& extra : particles.extras) reorder_rows(extra.values, vector_, order, kept);
  particles.count = kept;
}

}  // namespace greenwater
