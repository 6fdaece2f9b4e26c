# greenwater_facts: the text behind core/build_facts.hpp. What CMake knows is written down here, at configure time; the
# state of the checkout is asked for at every build, by write_facts.cmake, because commits do not re-run CMake.

set(facts_known ${CMAKE_CURRENT_BINARY_DIR}/facts/known.cmake)
set(facts_source ${CMAKE_CURRENT_BINARY_DIR}/facts/build_facts.cpp)
set(kernels_fact ${GREENWATER_KOKKOS_KERNELS_VERSION})
if(NOT kernels_fact)
  set(kernels_fact none)
endif()
string(JOIN "," devices_fact ${Kokkos_DEVICES})
string(JOIN "," arch_fact ${Kokkos_ARCH})
if(GREENWATER_MARCH_FLAG)
  string(JOIN " " arch_fact ${arch_fact} ${GREENWATER_MARCH_FLAG})
endif()
if(NOT arch_fact)
  set(arch_fact none)
endif()
file(CONFIGURE OUTPUT ${facts_known} @ONLY CONTENT [==[
set(source_dir [=[@CMAKE_CURRENT_SOURCE_DIR@]=])
set(template [=[@CMAKE_CURRENT_SOURCE_DIR@/cmake/build_facts.cpp.in]=])
set(output [=[@facts_source@]=])
set(fact_version [=[@PROJECT_VERSION@]=])
set(fact_compiler [=[@CMAKE_CXX_COMPILER_ID@ @CMAKE_CXX_COMPILER_VERSION@]=])
set(fact_build_type [=[@CMAKE_BUILD_TYPE@]=])
set(fact_flags [=[@GREENWATER_FLAGS_TEXT@]=])
set(fact_kokkos_version [=[@Kokkos_VERSION@]=])
set(fact_kokkos_devices [=[@devices_fact@]=])
set(fact_kokkos_arch [=[@arch_fact@]=])
set(fact_kokkos_kernels [=[@kernels_fact@]=])
]==])

add_custom_target(greenwater_facts_text
  COMMAND ${CMAKE_COMMAND} -D known=${facts_known} -P ${CMAKE_CURRENT_SOURCE_DIR}/cmake/write_facts.cmake
  BYPRODUCTS ${facts_source}
  COMMENT "Looking at the state of the checkout"
  VERBATIM)
add_library(greenwater_facts STATIC ${facts_source} core/build_facts.hpp)
target_link_libraries(greenwater_facts PRIVATE greenwater_flags)
add_dependencies(greenwater_facts greenwater_facts_text)
