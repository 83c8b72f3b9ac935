# Dependencies are Debian packages, found where they are needed and named when they are missing.

function(plumb_missing what package)
  message(FATAL_ERROR
    "plumb needs ${what}, which was not found. On Debian: apt-get install ${package}\n"
    "(scripts/demo and scripts/test install everything that is missing; scripts/packages lists it.)")
endfunction()

# plumb_find_package(NAME DEBIAN <package> TARGET <imported target> [arguments of find_package...])
# A macro, so that imported targets and variables arrive in the caller's scope.
macro(plumb_find_package name)
  cmake_parse_arguments(PLUMB_FIND "" "DEBIAN;TARGET" "" ${ARGN})
  if(NOT TARGET ${PLUMB_FIND_TARGET})
    find_package(${name} ${PLUMB_FIND_UNPARSED_ARGUMENTS} QUIET)
    if(NOT TARGET ${PLUMB_FIND_TARGET})
      plumb_missing("${name} (CMake target ${PLUMB_FIND_TARGET})" ${PLUMB_FIND_DEBIAN})
    endif()
  endif()
endmacro()

# plumb_find_header(TARGET <name> HEADER <file> DEBIAN <package>): a header-only library that has no CMake
# files of its own becomes the interface target <name>.
function(plumb_find_header)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "TARGET;HEADER;DEBIAN" "")
  if(TARGET ${arg_TARGET})
    return()
  endif()
  string(MAKE_C_IDENTIFIER "PLUMB_${arg_HEADER}_DIR" variable)
  find_path(${variable} "${arg_HEADER}")
  mark_as_advanced(${variable})
  if(NOT ${variable})
    plumb_missing("the header ${arg_HEADER}" ${arg_DEBIAN})
  endif()
  add_library(${arg_TARGET} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${arg_TARGET} SYSTEM INTERFACE "${${variable}}")
endfunction()
