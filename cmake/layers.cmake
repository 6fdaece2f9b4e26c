# greenwater_add_layer(<folder> [ALSO <folder>...] [EXCEPT <file>...] [LINKS <target>...])
#
# Makes the library greenwater_<folder> of all .cpp files in the folder. They are found by pattern, and looked for again
# at every build, so that a new file needs no line here. A folder without any becomes a library of headers.
function(greenwater_add_layer folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "ALSO;EXCEPT;LINKS")
  set(sources "")
  foreach(from IN ITEMS ${folder} ${arg_ALSO})
    file(GLOB found CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${from}/*.cpp)
    list(APPEND sources ${found})
  endforeach()
  if(arg_EXCEPT)
    list(REMOVE_ITEM sources ${arg_EXCEPT})
  endif()
  if(sources)
    add_library(greenwater_${folder} STATIC ${sources})
    # The flags are private, as everything else of ours links them itself.
    target_link_libraries(greenwater_${folder} PRIVATE greenwater_flags PUBLIC ${arg_LINKS})
  else()
    add_library(greenwater_${folder} INTERFACE)
    target_link_libraries(greenwater_${folder} INTERFACE ${arg_LINKS})
  endif()
endfunction()
