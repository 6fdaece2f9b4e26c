# Finds Kokkos, makes sure that it can do what this build is for, and offers
#   greenwater_kokkos           Kokkos itself
#   greenwater_kokkos_kernels   Kokkos Kernels, or nothing when it is not there

set(GREENWATER_BACKEND OPENMP CACHE STRING "Kokkos back-end the particles are computed on")
set_property(CACHE GREENWATER_BACKEND PROPERTY STRINGS OPENMP SERIAL CUDA HIP)
if(NOT GREENWATER_BACKEND MATCHES "^(OPENMP|SERIAL|CUDA|HIP)$")
  message(FATAL_ERROR "GREENWATER_BACKEND is '${GREENWATER_BACKEND}'; it can be OPENMP, SERIAL, CUDA or HIP.")
endif()

# Where scripts/setup keeps the Kokkos it built. It is only a hint: CMake looks at Kokkos_ROOT, Kokkos_DIR and
# CMAKE_PREFIX_PATH first, so a Kokkos that the user names wins, and at /usr last.
set(kokkos_hint "")
if(GREENWATER_BACKEND MATCHES "OPENMP|SERIAL")
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env CXX=${CMAKE_CXX_COMPILER}
            ${CMAKE_CURRENT_SOURCE_DIR}/scripts/setup --prefix --march ${GREENWATER_MARCH}
    OUTPUT_VARIABLE kokkos_hint OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  # CMake remembers what it found. One that set-up built for another processor, or with a compiler that has since been
  # upgraded, gives way to the one for this build.
  set(remembered "${Kokkos_DIR}/../../..")
  if(EXISTS ${remembered}/built-by-greenwater AND EXISTS ${kokkos_hint}/built-by-greenwater)
    file(REAL_PATH ${remembered} remembered)
    file(REAL_PATH ${kokkos_hint} wanted)
    if(NOT remembered STREQUAL wanted)
      unset(Kokkos_DIR CACHE)
      unset(KokkosKernels_DIR CACHE)
    endif()
  endif()
endif()

# A plain minimum. A range such as 3.4...<6 would be refused by every 3.x, whose version file accepts only a range
# within its own major version; since 4.0 a minimum accepts anything newer. core/kokkos.hpp copes with 3.4 to 5.x.
find_package(Kokkos 3.4 QUIET CONFIG HINTS ${kokkos_hint})
if(NOT Kokkos_FOUND)
  # Since its minimum is of another major version, CMake may have looked at a Kokkos and turned it down.
  set(seen "")
  if(Kokkos_CONSIDERED_CONFIGS)
    set(seen "\nLooked at, but of no use: ${Kokkos_CONSIDERED_CONFIGS} (version ${Kokkos_CONSIDERED_VERSIONS})")
  endif()
  message(FATAL_ERROR
    "No Kokkos 3.4 or newer was found.${seen}\n"
    "For the CPU, run:     scripts/setup --march ${GREENWATER_MARCH}\n"
    "To use your own:      cmake --preset ... -DKokkos_ROOT=/path/to/kokkos\n"
    "See docs/building.md.")
endif()

set(backend_missing OFF)
if(NOT GREENWATER_BACKEND IN_LIST Kokkos_DEVICES)
  set(backend_missing ON)
endif()
if(backend_missing)
  set(found_in ${Kokkos_DIR})
  # Forgotten, so that the next configure looks again instead of coming back to this one.
  unset(Kokkos_DIR CACHE)
  set(cure "Give a Kokkos that has it, with -DKokkos_ROOT=/path/to/kokkos, or choose another preset.")
  if(GREENWATER_BACKEND MATCHES "OPENMP|SERIAL")
    set(cure "Run scripts/setup --march ${GREENWATER_MARCH}, which builds one, or give your own with \
-DKokkos_ROOT=/path/to/kokkos. (Debian's package libtrilinos-kokkos-dev has the back-end SERIAL only.)")
  endif()
  message(FATAL_ERROR
    "This build is for the back-end ${GREENWATER_BACKEND}, but the Kokkos in\n  ${found_in}\n"
    "has only: ${Kokkos_DEVICES}.\n${cure}")
endif()

message(STATUS "Kokkos ${Kokkos_VERSION} in ${Kokkos_DIR}")
message(STATUS "Kokkos devices: ${Kokkos_DEVICES}; this build computes on ${GREENWATER_BACKEND}")
if(Kokkos_ARCH)
  message(STATUS "Kokkos architectures: ${Kokkos_ARCH}")
endif()

add_library(greenwater_kokkos INTERFACE)
target_link_libraries(greenwater_kokkos INTERFACE Kokkos::kokkos)
# Kokkos takes OpenMP by default whenever it has it. A SERIAL build on such a Kokkos has to be told, so that
# core/kokkos.hpp can choose the execution space; for the other back-ends the default is the right one.
target_compile_definitions(greenwater_kokkos INTERFACE GREENWATER_BACKEND_${GREENWATER_BACKEND})
if(GREENWATER_BOUNDS)
  # The checks are in Kokkos' headers behind this macro, and the library itself does not depend on it, so no second
  # Kokkos is needed. Defined as empty, as Kokkos' own configuration would do: the same definition twice is allowed.
  target_compile_definitions(greenwater_kokkos INTERFACE KOKKOS_ENABLE_DEBUG_BOUNDS_CHECK=)
endif()

add_library(greenwater_kokkos_kernels INTERFACE)
set(KokkosKernels_FOUND OFF)
if(GREENWATER_KOKKOS_KERNELS)
  # Beside Kokkos, or where the user says; never the one of the system, which belongs to the system's Kokkos.
  find_package(KokkosKernels QUIET CONFIG HINTS ${Kokkos_DIR}/../../.. ${Kokkos_DIR}/../../../..
    NO_SYSTEM_ENVIRONMENT_PATH NO_CMAKE_PACKAGE_REGISTRY NO_CMAKE_SYSTEM_PATH NO_CMAKE_SYSTEM_PACKAGE_REGISTRY)
endif()
set(GREENWATER_KOKKOS_KERNELS_VERSION "")
if(KokkosKernels_FOUND)
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" kokkos_series "${Kokkos_VERSION}")
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" kernels_series "${KokkosKernels_VERSION}")
  if(KokkosKernels_VERSION STREQUAL "")
    # So it is with Debian's: nothing tells whether it fits.
    message(STATUS "Kokkos Kernels in ${KokkosKernels_DIR} does not name its version and is left out")
  elseif(kokkos_series STREQUAL kernels_series)
    set(GREENWATER_KOKKOS_KERNELS_VERSION ${KokkosKernels_VERSION})
    target_link_libraries(greenwater_kokkos_kernels INTERFACE Kokkos::kokkoskernels)
    target_compile_definitions(greenwater_kokkos_kernels INTERFACE GREENWATER_HAVE_KOKKOS_KERNELS=1)
  else()
    message(STATUS "Kokkos Kernels ${KokkosKernels_VERSION} in ${KokkosKernels_DIR} does not belong to this Kokkos")
  endif()
endif()
if(GREENWATER_KOKKOS_KERNELS_VERSION)
  message(STATUS "BLAS-1: Kokkos Kernels ${GREENWATER_KOKKOS_KERNELS_VERSION}")
else()
  message(STATUS "BLAS-1: own loops")
endif()
