#pragma once
// What this program was built from and with; goes into the banner and into every result file, so that a run can be
// repeated. The text is written by the build (cmake/facts.cmake). Free of Kokkos.

#include <string_view>

namespace greenwater {

struct BuildFacts {
  std::string_view version;
  std::string_view git;  ///< `git describe` of the sources, "-dirty" if they were changed; "unknown" outside a checkout
  std::string_view compiler;
  std::string_view build_type;
  std::string_view flags;
  std::string_view kokkos_version;
  std::string_view kokkos_devices;  ///< back-ends that this Kokkos has
  std::string_view kokkos_arch;     ///< processor compiled for: Kokkos' own names and our -march; "none" without any
  std::string_view kokkos_kernels;  ///< version, or "none"
};

const BuildFacts& build_facts();

}  // namespace greenwater
