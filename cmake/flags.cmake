# greenwater_flags: what every target of ours, and only ours, is compiled with.

add_library(greenwater_flags INTERFACE)
target_include_directories(greenwater_flags INTERFACE ${CMAKE_CURRENT_SOURCE_DIR})
# Without errno, which nobody reads, a square root is one instruction.
target_compile_options(greenwater_flags INTERFACE -Wall -Wextra -fno-math-errno)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 takes "text" + std::string for an overlapping copy (its bug 105651).
  target_compile_options(greenwater_flags INTERFACE -Wno-restrict)
endif()
if(GREENWATER_WERROR)
  target_compile_options(greenwater_flags INTERFACE -Werror)
endif()
if(GREENWATER_SINGLE)
  target_compile_definitions(greenwater_flags INTERFACE GREENWATER_SINGLE=1)
endif()

# The processor. All our objects share the flag: Eigen's alignment, for one, follows from it. For CUDA and HIP the
# compiler is told by Kokkos.
set(GREENWATER_MARCH_FLAG "")
if(NOT GREENWATER_MARCH STREQUAL "none" AND GREENWATER_BACKEND MATCHES "OPENMP|SERIAL")
  set(GREENWATER_MARCH_FLAG -march=${GREENWATER_MARCH})
  include(CheckCXXCompilerFlag)
  string(MAKE_C_IDENTIFIER "march_known_${GREENWATER_MARCH}" march_known)
  check_cxx_compiler_flag(${GREENWATER_MARCH_FLAG} ${march_known})
  if(NOT ${march_known})
    message(FATAL_ERROR "The compiler does not know ${GREENWATER_MARCH_FLAG}; choose another GREENWATER_MARCH, or none.")
  endif()
  target_compile_options(greenwater_flags INTERFACE ${GREENWATER_MARCH_FLAG})
elseif(NOT Kokkos_ARCH AND NOT CMAKE_CXX_FLAGS MATCHES "-march=|-mcpu=")
  message(WARNING
    "Neither Kokkos nor the compiler flags name a processor, so the program is compiled for the oldest one that the "
    "compiler supports and may run at half the speed. Set GREENWATER_MARCH unless it has to run on old machines.")
endif()

if(GREENWATER_SANITIZE)
  string(REPLACE ";" "," sanitizers "${GREENWATER_SANITIZE}")
  target_compile_options(greenwater_flags INTERFACE
    -fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  if(sanitizers MATCHES "undefined")
    # The checks at every use of a pointer take as long to compile as all the rest, and what they find the address
    # sanitizer finds too. Overflow, shifts, conversions, divisions and array bounds stay.
    target_compile_options(greenwater_flags INTERFACE -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
  endif()
  target_link_options(greenwater_flags INTERFACE -fsanitize=${sanitizers})
endif()
if(GREENWATER_BOUNDS)
  target_compile_definitions(greenwater_flags INTERFACE _GLIBCXX_ASSERTIONS GREENWATER_BOUNDS=1)
endif()

string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(JOIN " " GREENWATER_FLAGS_TEXT ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} ${GREENWATER_MARCH_FLAG})
if(GREENWATER_SANITIZE)
  string(APPEND GREENWATER_FLAGS_TEXT " -fsanitize=${sanitizers}")
endif()
if(GREENWATER_SINGLE)
  string(APPEND GREENWATER_FLAGS_TEXT " -DGREENWATER_SINGLE")
endif()
if(GREENWATER_BOUNDS)
  string(APPEND GREENWATER_FLAGS_TEXT " -DKOKKOS_ENABLE_DEBUG_BOUNDS_CHECK")
endif()
message(STATUS "Flags: ${GREENWATER_FLAGS_TEXT}")
