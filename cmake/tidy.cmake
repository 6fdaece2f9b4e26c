# Target `tidy`: clang-tidy over all our sources, with the checks of .clang-tidy.
find_program(CLANG_TIDY_RUNNER NAMES run-clang-tidy run-clang-tidy-19 run-clang-tidy-14)
if(CLANG_TIDY_RUNNER)
  add_custom_target(tidy
    COMMAND ${CLANG_TIDY_RUNNER} -quiet -p ${CMAKE_CURRENT_BINARY_DIR}
            "^${CMAKE_CURRENT_SOURCE_DIR}/(core|kernels|fem|io|coupling|app|tests|bench)/"
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    USES_TERMINAL VERBATIM)
else()
  add_custom_target(tidy
    COMMAND ${CMAKE_COMMAND} -E echo "clang-tidy is not installed; on Debian: apt-get install clang-tidy libomp-dev"
    COMMAND ${CMAKE_COMMAND} -E false
    VERBATIM)
endif()
