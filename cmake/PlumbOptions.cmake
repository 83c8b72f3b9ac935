# Options, default build type, compiler cache, and the one flag that plumb refuses.

option(PLUMB_ALL_CAPACITIES "Build floors 1-4 for 4 and 16 sensors too (8 is always built, 24 for the host)" ON)
option(PLUMB_RECALIBRATION "The monitor can estimate biases and scales anew; OFF spares an instrument the code" ON)
option(PLUMB_FIRST_CALIBRATION "The monitor can make its very first calibration (needs PLUMB_RECALIBRATION)" ON)
set(PLUMB_SCALAR double CACHE STRING "Type of what runs at every sample: double, or float for a processor without double precision")
set_property(CACHE PLUMB_SCALAR PROPERTY STRINGS double float)
option(PLUMB_FAST_STEP "Compile what runs at every sample with -O2, for builds at -Os" OFF)
option(PLUMB_BUILD_HOST "Build the host libraries (scenario, io, render)" ${PROJECT_IS_TOP_LEVEL})
option(PLUMB_BUILD_TOOL "Build the plumb command line tool (needs PLUMB_BUILD_HOST)" ${PROJECT_IS_TOP_LEVEL})
option(PLUMB_BUILD_TESTS "Build the tests (needs their libraries; the preset tests turns them on)" OFF)
option(PLUMB_PLANT_DEFECTS "With the tests: link the laws with every planted defect that they must catch" ON)
option(PLUMB_BUILD_MPI "Build plumb-campaign-mpi where MPI is found" ON)
option(PLUMB_BUILD_BENCH "Build the benchmarks (Google Benchmark)" OFF)
option(PLUMB_FAST_BUILD "Precompile the core's headers, compile several sources of host and tests at a time: scripts/demo and scripts/test do, other builds notice a missing include" OFF)
option(PLUMB_BUILD_FUZZ "Build the fuzzers (Clang)" OFF)
option(PLUMB_ONE_PROCESS "The quick tests of a test program are one test of ctest: for builds whose programs are slow to start" OFF)
option(PLUMB_COVERAGE "Count which branches and conditions run (Clang 19, scripts/coverage)" OFF)
option(PLUMB_INSTALL "Provide the install rules" ${PROJECT_IS_TOP_LEVEL})
set(PLUMB_RC_PARAMS "seed=20180227 max_success=200" CACHE STRING "RC_PARAMS (RapidCheck) of every test run by ctest")

if(PLUMB_BUILD_TOOL AND NOT PLUMB_BUILD_HOST)
  message(FATAL_ERROR "PLUMB_BUILD_TOOL needs PLUMB_BUILD_HOST: switch both off, -DPLUMB_BUILD_HOST=OFF -DPLUMB_BUILD_TOOL=OFF")
endif()

if(PLUMB_BUILD_HOST AND NOT (PLUMB_RECALIBRATION AND PLUMB_FIRST_CALIBRATION))
  message(FATAL_ERROR "PLUMB_BUILD_HOST, PLUMB_BUILD_TOOL and the tests need PLUMB_RECALIBRATION and PLUMB_FIRST_CALIBRATION: switch "
    "them off, -DPLUMB_BUILD_HOST=OFF -DPLUMB_BUILD_TOOL=OFF -DPLUMB_BUILD_TESTS=OFF")
endif()

if(NOT PLUMB_SCALAR MATCHES "^(double|float)$")
  message(FATAL_ERROR "PLUMB_SCALAR is double or float; found \"${PLUMB_SCALAR}\"")
endif()

if(PLUMB_BUILD_HOST AND NOT PLUMB_SCALAR STREQUAL "double")
  message(FATAL_ERROR "PLUMB_BUILD_HOST, PLUMB_BUILD_TOOL and the tests need PLUMB_SCALAR=double (24 sensors): switch them off, "
    "-DPLUMB_BUILD_HOST=OFF -DPLUMB_BUILD_TOOL=OFF -DPLUMB_BUILD_TESTS=OFF; the target plumb_4_float is there in either build")
endif()

if(PROJECT_IS_TOP_LEVEL)
  get_property(is_multi_config GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
  if(NOT CMAKE_BUILD_TYPE AND NOT is_multi_config)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  endif()
  set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

  find_program(PLUMB_CCACHE ccache)
  mark_as_advanced(PLUMB_CCACHE)
  if(PLUMB_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${PLUMB_CCACHE}")
  endif()
endif()

if(NOT CMAKE_CXX_COMPILER_ID MATCHES "^(GNU|Clang|AppleClang)$")
  message(FATAL_ERROR "plumb is built with GCC or Clang; found ${CMAKE_CXX_COMPILER_ID}")
endif()

# plumb_leaves_out(WHAT WHY): remembered, and told at the end of the configuration. A build without a part is no error.
function(plumb_leaves_out what why)
  set_property(GLOBAL APPEND PROPERTY PLUMB_LEFT_OUT "${what}: ${why}")
endfunction()

# plumb_tell_what_is_left_out(): one line per part.
function(plumb_tell_what_is_left_out)
  get_property(parts GLOBAL PROPERTY PLUMB_LEFT_OUT)
  foreach(part IN LISTS parts)
    message(STATUS "plumb leaves out ${part}")
  endforeach()
endfunction()

# Fast-math lets the compiler assume that no NaN exists: every channel gate would be optimised away. The
# header plumb/core/config.hpp refuses it too; here it is refused before a line is compiled.
function(plumb_refuse_fast_math)
  get_directory_property(directory_options COMPILE_OPTIONS)
  set(given "${CMAKE_CXX_FLAGS} ${CMAKE_EXE_LINKER_FLAGS} ${CMAKE_SHARED_LINKER_FLAGS} ${directory_options}")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  if(build_type)
    string(APPEND given " ${CMAKE_CXX_FLAGS_${build_type}} ${CMAKE_EXE_LINKER_FLAGS_${build_type}}")
  else()
    string(APPEND given " ${CMAKE_CXX_FLAGS_RELEASE} ${CMAKE_CXX_FLAGS_DEBUG}")
  endif()
  foreach(flag -ffast-math -Ofast -ffinite-math-only -funsafe-math-optimizations -fassociative-math
               -freciprocal-math -fno-signed-zeros)
    string(REGEX MATCH "(^|[ ;])${flag}($|[ ;])" hit "${given}")
    if(hit)
      message(FATAL_ERROR
        "plumb refuses ${flag}: it removes the NaN checks that keep a broken channel out of a sum, or reorders "
        "sums that must be exact. Take it out of CMAKE_CXX_FLAGS (or of the environment variable CXXFLAGS).")
    endif()
  endforeach()
endfunction()
plumb_refuse_fast_math()
