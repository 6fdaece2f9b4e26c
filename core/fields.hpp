#pragma once
// Fields: one value, or one vector, for each particle; and small vectors for kernel bodies.

#include <cstdint>
#include <string>

#include "core/kokkos.hpp"
#include "core/real.hpp"

namespace greenwater {

using ScalarField = Kokkos::View<real*, Device>;                       // (i)
using VectorField = Kokkos::View<real**, Kokkos::LayoutLeft, Device>;  // (i, axis), axis < dimension; axis by axis
using CoordField = Kokkos::View<coord**, Kokkos::LayoutLeft, Device>;  // (i, axis)
using FloatField = Kokkos::View<float*, Device>;                       // what needs seven digits and no more
using AccumField = Kokkos::View<accum*, Device>;
using IndexField = Kokkos::View<int*, Device>;
using OffsetField = Kokkos::View<std::int64_t*, Device>;  // where a row begins: more entries than an int counts
using FlagField = Kokkos::View<std::uint8_t*, Device>;
template <class Field>
using Read = typename Field::const_type;  // what a kernel only reads

using Range = Kokkos::RangePolicy<Space, Kokkos::IndexType<int>>;

/// A field that is not cleared: for what a kernel writes entirely before anybody reads it.
template <class Field, class... Extents>
Field uncleared(const std::string& label, Extents... extents) {
  return Field(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), static_cast<std::size_t>(extents)...);
}

/// A vector of `Dim` components in registers.
template <int Dim, class T = real>
struct Vec {
  T c[Dim];
  KOKKOS_INLINE_FUNCTION T& operator[](int d) { return c[d]; }
  KOKKOS_INLINE_FUNCTION T operator[](int d) const { return c[d]; }
};

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION T dot(const Vec<Dim, T>& a, const Vec<Dim, T>& b) {
  T sum{};
  for (int d = 0; d < Dim; ++d) sum += a[d] * b[d];
  return sum;
}

template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec<Dim, T> difference(const Vec<Dim, T>& a, const Vec<Dim, T>& b) {
  Vec<Dim, T> r;
  for (int d = 0; d < Dim; ++d) r[d] = a[d] - b[d];
  return r;
}

/// a + s b
template <int Dim, class T>
KOKKOS_INLINE_FUNCTION Vec<Dim, T> along(const Vec<Dim, T>& a, T s, const Vec<Dim, T>& b) {
  Vec<Dim, T> r;
  for (int d = 0; d < Dim; ++d) r[d] = a[d] + s * b[d];
  return r;
}

/// Row i of a field as a vector.
template <int Dim, class Field>
KOKKOS_INLINE_FUNCTION Vec<Dim, typename Field::non_const_value_type> load(const Field& field, int i) {
  Vec<Dim, typename Field::non_const_value_type> r;
  for (int d = 0; d < Dim; ++d) r[d] = field(i, d);
  return r;
}

template <int Dim, class Field, class T>
KOKKOS_INLINE_FUNCTION void store(const Field& field, int i, const Vec<Dim, T>& v) {
  for (int d = 0; d < Dim; ++d) field(i, d) = v[d];
}

}  // namespace greenwater
