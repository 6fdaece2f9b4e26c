# Run at every build: cmake -D known=FILE -P write_facts.cmake
# The source is only touched when its text changes; otherwise an incremental build would link everything anew.
cmake_minimum_required(VERSION 3.22)
include(${known})

set(fact_git unknown)
find_program(git_program git)
if(git_program)
  # A source tree unpacked inside some other repository must not report that one's state.
  execute_process(COMMAND ${git_program} -C ${source_dir} rev-parse --show-cdup
    OUTPUT_VARIABLE up OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
  if(status EQUAL 0 AND up STREQUAL "")
    # Without the locks: somebody may be committing at this very moment.
    execute_process(COMMAND ${git_program} --no-optional-locks -C ${source_dir} describe --always --tags --dirty
      OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
    if(status EQUAL 0 AND NOT described STREQUAL "")
      set(fact_git ${described})
    endif()
  endif()
endif()

foreach(name IN ITEMS version git compiler build_type flags kokkos_version kokkos_devices kokkos_arch kokkos_kernels)
  string(REPLACE "\\" "\\\\" fact_${name} "${fact_${name}}")
  string(REPLACE "\"" "\\\"" fact_${name} "${fact_${name}}")
endforeach()
configure_file(${template} ${output} @ONLY)
