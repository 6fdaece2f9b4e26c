# Target `tidy`: clang-tidy over all our sources, with the checks of .clang-tidy. Before 16 it does not know
# std::source_location, so Debian 12's default, 14, will not do; clang-tidy-16 and -19 are in Debian 12 as well.
find_program(CLANG_TIDY_RUNNER NAMES run-clang-tidy-19 run-clang-tidy-18 run-clang-tidy-17 run-clang-tidy-16)
if(CLANG_TIDY_RUNNER)
  add_custom_target(tidy
    COMMAND ${CLANG_TIDY_RUNNER} -quiet -p ${CMAKE_CURRENT_BINARY_DIR}
            "^${CMAKE_CURRENT_SOURCE_DIR}/(core|kernels|fem|io|coupling|app|tests|bench)/"
    DEPENDS greenwater_facts_text
    WORKING_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
    USES_TERMINAL VERBATIM)
else()
  add_custom_target(tidy
    COMMAND ${CMAKE_COMMAND} -E echo "clang-tidy 16 or newer is missing; on Debian: apt-get install clang-tidy-19 libomp-19-dev"
    COMMAND ${CMAKE_COMMAND} -E false
    VERBATIM)
endif()
