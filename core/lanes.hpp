#pragma once
// Several particles side by side in one vector register. On a host a kernel body works on `lanes` consecutive particles
// at once, on a GPU, where every thread has one particle, on one: the same text, with Lanes<T, 1> being T itself.
//
// Compilers vectorise the loops over neighbours badly or not at all: their lengths differ from particle to particle, and
// loops over lanes with a constant trip are unrolled before they are looked at. So the vectors are spelt out, with the
// vector types that g++ and clang++ share. What these cannot say has instructions of its own where the CPU has AVX-512
// (GREENWATER_VECTORS), and loops elsewhere: the only file with such instructions.

#include <type_traits>

#include "core/fields.hpp"

#if defined(GREENWATER_HOST_ONLY) && defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__) && \
    !defined(GREENWATER_BOUNDS) && !defined(GREENWATER_PLAIN_LANES)
#define GREENWATER_VECTORS 1
#include <immintrin.h>
#endif

namespace greenwater {

/// Whether kernels run on the host, where one thread works on many particles.
constexpr bool on_host =
    Kokkos::SpaceAccessibility<Kokkos::DefaultHostExecutionSpace, Space::memory_space>::accessible &&
    std::is_same<Space::memory_space, Kokkos::HostSpace>::value;

/// Rows of neighbours that lie side by side in memory: a vector of floats on a host, a warp on a GPU.
constexpr int row_lanes = on_host ? 16 : 32;
/// Particles that a kernel body in `real` works on at once, and one in `float`.
constexpr int pack_lanes = on_host ? 64 / static_cast<int>(sizeof(real)) : 1;
constexpr int float_lanes = on_host ? 16 : 1;

namespace lanes_of {
template <class T, int W>
struct Type {
  typedef T type __attribute__((vector_size(sizeof(T) * W)));
};
template <class T>
struct Type<T, 1> {
  using type = T;
};
}  // namespace lanes_of

template <class T, int W>
using Lanes = typename lanes_of::Type<T, W>::type;

using Pack = Lanes<real, pack_lanes>;
using IndexPack = Lanes<int, pack_lanes>;
using FloatPack = Lanes<float, float_lanes>;

template <class V>
inline constexpr bool is_scalar = std::is_arithmetic<V>::value;

/// One lane to read, and to write.
template <class V>
KOKKOS_INLINE_FUNCTION auto lane(const V& v, [[maybe_unused]] int l) {
  if constexpr (is_scalar<V>)
    return v;
  else
    return v[l];
}

template <class V, class T>
KOKKOS_INLINE_FUNCTION void set_lane(V& v, [[maybe_unused]] int l, T value) {
  if constexpr (is_scalar<V>)
    v = value;
  else
    v[l] = value;
}

/// The same value in every lane.
template <class V, class T>
KOKKOS_INLINE_FUNCTION V all_lanes(T value) {
  if constexpr (is_scalar<V>)
    return static_cast<V>(value);
  else
    return V{} + static_cast<std::remove_cv_t<std::remove_reference_t<decltype(V{}[0])>>>(value);
}

/// 0, 1, 2 ...
template <class V>
KOKKOS_INLINE_FUNCTION V counted_lanes() {
  V v{};
  if constexpr (!is_scalar<V>)
    for (std::size_t l = 0; l < sizeof(V) / sizeof(v[0]); ++l) v[l] = static_cast<int>(l);
  return v;
}

/// As static_cast, lane by lane.
template <class To, class From>
KOKKOS_INLINE_FUNCTION To convert_lanes(const From& v) {
  if constexpr (std::is_same<To, From>::value)
    return v;
  else if constexpr (is_scalar<To>)
    return static_cast<To>(v);
  else
    return __builtin_convertvector(v, To);
}

/// yes ? a : b, lane by lane. `yes` comes from comparing values of the same size as a and b.
template <class Mask, class V>
KOKKOS_INLINE_FUNCTION V select(const Mask& yes, const V& a, const V& b) {
  return yes ? a : b;
}

template <class Mask, class V>
KOKKOS_INLINE_FUNCTION V zero_unless(const Mask& yes, const V& v) {
  return yes ? v : V{};
}

/// v in the first `count` lanes, and 0 in the others.
template <class V>
KOKKOS_INLINE_FUNCTION V first_lanes(int count, const V& v) {
  if constexpr (is_scalar<V>)
    return count > 0 ? v : V{};
  else
    return zero_unless(
        counted_lanes<V>() < static_cast<std::remove_cv_t<std::remove_reference_t<decltype(V{}[0])>>>(count), v);
}

/// Bit l is set where it is so in lane l.
template <class Mask>
KOKKOS_INLINE_FUNCTION unsigned lane_bits(const Mask& yes) {
  if constexpr (is_scalar<Mask>) {
    return yes ? 1 : 0;
  } else {
#ifdef GREENWATER_VECTORS
    if constexpr (sizeof(Mask) == 64 && sizeof(yes[0]) == 8) return _mm512_movepi64_mask((__m512i)yes);
#endif
    using T = std::remove_cv_t<std::remove_reference_t<decltype(Mask{}[0])>>;
    T so[sizeof(Mask) / sizeof(T)];  // copied: g++ 12 with sanitizers reads a mask's lanes wrong
    __builtin_memcpy(so, &yes, sizeof yes);
    unsigned bits = 0;
    for (unsigned l = 0; l < sizeof(Mask) / sizeof(T); ++l) bits |= (so[l] != 0 ? 1u : 0u) << l;
    return bits;
  }
}

/// The sum of all lanes, in accum: of halves, of halves of halves ...
template <class V>
KOKKOS_INLINE_FUNCTION accum sum_lanes(const V& v) {
  if constexpr (is_scalar<V>) {
    return v;
  } else {
    using T = std::remove_cv_t<std::remove_reference_t<decltype(V{}[0])>>;
    constexpr int half = static_cast<int>(sizeof(V) / sizeof(T)) / 2;
    Lanes<T, half> low, high;
    __builtin_memcpy(&low, &v, sizeof low);
    __builtin_memcpy(&high, reinterpret_cast<const char*>(&v) + sizeof low, sizeof high);
    return sum_lanes(convert_lanes<Lanes<accum, half>>(low) + convert_lanes<Lanes<accum, half>>(high));
  }
}

/// Is it so in any lane?
template <class Mask>
KOKKOS_INLINE_FUNCTION bool any_lane(const Mask& yes) {
  return lane_bits(yes) != 0;
}

/// Writes the lanes whose bits are set side by side to `to`, which needs room for all lanes. On a host.
template <class V, class T>
inline void compress_lanes(unsigned bits, const V& v, T* to) {
#ifdef GREENWATER_VECTORS
  // Compressed in the register: compressing on the way to memory is many times slower on some CPUs.
  if constexpr (std::is_same<V, Lanes<double, 8>>::value)
    return _mm512_storeu_pd(to, _mm512_maskz_compress_pd(static_cast<__mmask8>(bits), (__m512d)v));
  else if constexpr (std::is_same<V, Lanes<int, 8>>::value)
    return _mm256_storeu_si256((__m256i*)to, _mm256_maskz_compress_epi32(static_cast<__mmask8>(bits), (__m256i)v));
#endif
  int n = 0;
  for (std::size_t l = 0; l < sizeof(V) / sizeof(v[0]); ++l) {  // without branches, which nobody could foretell
    to[n] = v[l];
    n += (bits >> l) & 1u;
  }
}

/// 1 / v, to the last bit or two, for v in the middle of the range of its type.
/// Dividing or taking a root of a vector of doubles takes a CPU twenty cycles; an estimate and two of Newton's steps take
/// five.
template <class V>
KOKKOS_INLINE_FUNCTION V inverse(const V& v) {
#ifdef GREENWATER_VECTORS
  if constexpr (std::is_same<V, Lanes<double, 8>>::value) {
    V y = (V)_mm512_maskz_rcp14_pd(0xff, (__m512d)v);
    for (int step = 0; step < 2; ++step) y += y * (1 - v * y);
    return y;
  }
#endif
  return 1 / v;
}

/// Square root, to the last bit or two; 0 of 0.
template <class V, typename std::enable_if<!is_scalar<V>, int>::type = 0>
inline V sqrt(const V& v) {
#ifdef GREENWATER_VECTORS
  if constexpr (std::is_same<V, Lanes<double, 8>>::value) {
    const V positive = larger(v, V{} + 1e-300);
    V y = (V)_mm512_maskz_rsqrt14_pd(0xff, (__m512d)positive);
    for (int step = 0; step < 2; ++step) y += y * (0.5 - 0.5 * positive * y * y);
    return v * y;
  } else if constexpr (std::is_same<V, Lanes<float, 8>>::value) {
    return (V)_mm256_maskz_sqrt_ps(0xff, (__m256)v);
  } else if constexpr (std::is_same<V, Lanes<float, 16>>::value) {
    return (V)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
  }
#endif
  V root{};
  for (std::size_t l = 0; l < sizeof(V) / sizeof(v[0]); ++l) root[l] = __builtin_sqrt(v[l]);
  return root;
}

/// Consecutive entries from `from` on.
template <class V, class T>
KOKKOS_INLINE_FUNCTION V load_lanes(const T* from) {
  if constexpr (is_scalar<V>) {
    return *from;
  } else {
    V v;
    __builtin_memcpy(&v, from, sizeof(V));
    return v;
  }
}

template <class V, class T>
KOKKOS_INLINE_FUNCTION void store_lanes(T* to, const V& v) {
  if constexpr (is_scalar<V>)
    *to = v;
  else
    __builtin_memcpy(to, &v, sizeof(V));
}

/// Writes v from `to` on as numbers of another type.
template <class V, class T>
KOKKOS_INLINE_FUNCTION void store_converted(T* to, const V& v) {
  if constexpr (is_scalar<V>) {
    *to = static_cast<T>(v);
  } else {
    using From = std::remove_cv_t<std::remove_reference_t<decltype(V{}[0])>>;
    constexpr int half = static_cast<int>(sizeof(V) / sizeof(From)) / 2;  // more than a register is converted badly
    for (int side = 0; side < 2; ++side) {
      Lanes<From, half> part;
      __builtin_memcpy(&part, reinterpret_cast<const char*>(&v) + side * sizeof part, sizeof part);
      store_lanes(to + side * half, convert_lanes<Lanes<T, half>>(part));
    }
  }
}

/// The cache line at `from` is wanted soon.
template <class T>
KOKKOS_INLINE_FUNCTION void prefetch([[maybe_unused]] const T* from) {
  if constexpr (on_host) __builtin_prefetch(from);
}

/// from[j], lane by lane.
template <class V, class Index, class T>
KOKKOS_INLINE_FUNCTION V gather_lanes(const T* from, const Index& j) {
  if constexpr (is_scalar<V>) {
    return from[j];
  } else {
#ifdef GREENWATER_VECTORS
    // In the masked forms, as g++ 12 takes the plain ones for reading what was never written.
    if constexpr (std::is_same<T, double>::value && sizeof(V) == 64)
      return (V)_mm512_mask_i32gather_pd(_mm512_setzero_pd(), 0xff, (__m256i)j, from, 8);
    if constexpr (std::is_same<T, float>::value && sizeof(V) == 64)
      return (V)_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xffff, (__m512i)j, from, 4);
    if constexpr (std::is_same<T, int>::value && sizeof(V) == 64)
      return (V)_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), 0xffff, (__m512i)j, from, 4);
#endif
    V v{};
    for (std::size_t l = 0; l < sizeof(V) / sizeof(v[0]); ++l) v[l] = from[j[l]];
    return v;
  }
}

/// One lane of a vector of packs.
template <int Dim, class T, class V>
KOKKOS_INLINE_FUNCTION Vec<Dim, T> lane_of(const Vec<Dim, V>& v, int l) {
  Vec<Dim, T> s;
  for (int d = 0; d < Dim; ++d) s[d] = lane(v[d], l);
  return s;
}

/// As convert_lanes, component by component.
template <class To, int Dim, class V>
KOKKOS_INLINE_FUNCTION Vec<Dim, To> convert_lanes_of(const Vec<Dim, V>& v) {
  Vec<Dim, To> s;
  for (int d = 0; d < Dim; ++d) s[d] = convert_lanes<To>(v[d]);
  return s;
}

/// Packs of a field: those of the particles from i on, and of particles j.
template <class Field>
KOKKOS_INLINE_FUNCTION auto load_pack(const Field& field, int i) {
  using T = typename Field::non_const_value_type;
  return load_lanes<Lanes<T, pack_lanes>>(&field(i));
}

template <int Dim, class Field>
KOKKOS_INLINE_FUNCTION auto load_pack(const Field& field, int i) {
  using T = typename Field::non_const_value_type;
  Vec<Dim, Lanes<T, pack_lanes>> v;
  for (int d = 0; d < Dim; ++d) v[d] = load_lanes<Lanes<T, pack_lanes>>(&field(i, d));
  return v;
}

template <class Field>
KOKKOS_INLINE_FUNCTION auto gather_pack(const Field& field, const IndexPack& j) {
  using T = typename Field::non_const_value_type;
  return gather_lanes<Lanes<T, pack_lanes>>(field.data(), j);
}

template <int Dim, class Field>
KOKKOS_INLINE_FUNCTION auto gather_pack(const Field& field, const IndexPack& j) {
  using T = typename Field::non_const_value_type;
  Vec<Dim, Lanes<T, pack_lanes>> v;
  for (int d = 0; d < Dim; ++d) v[d] = gather_lanes<Lanes<T, pack_lanes>>(&field(0, d), j);
  return v;
}

template <int Dim, class Field, class V>
KOKKOS_INLINE_FUNCTION void store_pack(const Field& field, int i, const Vec<Dim, V>& v) {
  for (int d = 0; d < Dim; ++d) store_lanes(&field(i, d), v[d]);
}

/// Kernels over packs of `count` particles; pack k begins with particle pack_lanes k. The last one may reach beyond the
/// last particle, as fields do.
inline Range packs(int count) { return Range(0, (count + pack_lanes - 1) / pack_lanes); }

}  // namespace greenwater
