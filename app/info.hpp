#pragma once
// What this program is and what it runs on.

#include <string>

namespace greenwater {

/// Version, build, Kokkos, back-end, threads, memory and limits, as lines or as JSON. Kokkos must be initialised.
std::string info_text(bool json);

}  // namespace greenwater
