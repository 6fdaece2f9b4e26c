#pragma once
// The only file that asks which Kokkos this is (3.4 to 5.x), and which back-end was wanted.

#include <Kokkos_Core.hpp>
#include <memory>

#if KOKKOS_VERSION < 30400
#error "Kokkos 3.4 or newer is needed"
#endif
#if KOKKOS_VERSION < 40000 && (defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL))
#error "GPU back-ends need Kokkos 4.0 or newer"
#endif

namespace greenwater {

// A build without any device compiler, which may have code for the host alone.
#if !defined(KOKKOS_ENABLE_CUDA) && !defined(KOKKOS_ENABLE_HIP) && !defined(KOKKOS_ENABLE_SYCL)
#define GREENWATER_HOST_ONLY 1
#endif

#if KOKKOS_VERSION >= 30700  // the mathematical functions left Kokkos::Experimental
namespace math = Kokkos;
#else
namespace math = Kokkos::Experimental;
#endif
using math::fabs;
using math::floor;
using math::pow;
using math::sqrt;

template <class T>
KOKKOS_INLINE_FUNCTION constexpr T smaller(T a, T b) {
  return b < a ? b : a;
}
template <class T>
KOKKOS_INLINE_FUNCTION constexpr T larger(T a, T b) {
  return a < b ? b : a;
}

#ifdef GREENWATER_BACKEND_SERIAL  // a Kokkos that also has OpenMP would take that by default
using Space = Kokkos::Serial;
#else
using Space = Kokkos::DefaultExecutionSpace;
#endif
using Device = Space::device_type;  // where fields live and who works on them

/// Kokkos between construction and destruction. `threads` <= 0 leaves the choice to Kokkos and OMP_NUM_THREADS.
/// The command line is never handed to Kokkos: 3.4 takes --help and --threads from it without a prefix.
class Runtime {
 public:
#if KOKKOS_VERSION >= 30700
  explicit Runtime(int threads) {
    Kokkos::InitializationSettings settings;
    settings.set_disable_warnings(true);
    if (threads > 0) settings.set_num_threads(threads);
    guard_ = std::make_unique<Kokkos::ScopeGuard>(settings);
  }
#else
  explicit Runtime(int threads) {
    Kokkos::InitArguments settings;
    settings.disable_warnings = true;
    if (threads > 0) settings.num_threads = threads;
    guard_ = std::make_unique<Kokkos::ScopeGuard>(settings);
  }
#endif
  /// Threads (or device lanes) that a kernel may use.
  static int concurrency() { return Space().concurrency(); }
  static const char* space_name() { return Space::name(); }

 private:
  std::unique_ptr<Kokkos::ScopeGuard> guard_;
};

}  // namespace greenwater
