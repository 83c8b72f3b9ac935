# How every target of plumb is compiled. Third-party headers are SYSTEM (imported targets are by default).

set(PLUMB_WARNINGS
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Werror)

if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  list(APPEND PLUMB_WARNINGS -Wnull-dereference)  # GCC's at -O2 reports false positives through inlined Eigen
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  list(APPEND PLUMB_WARNINGS -Wno-maybe-uninitialized)  # GCC's manual: false positives under sanitizers
endif()

if(PLUMB_COVERAGE AND NOT (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 19))
  message(FATAL_ERROR "PLUMB_COVERAGE needs Clang 19 (clang-19): -DCMAKE_CXX_COMPILER=clang++-19")
endif()

# plumb_compile_settings(TARGET): C++17 without extensions, warnings as errors, no fused multiply-add
# contraction (results must not depend on the compiler's choice of instructions, and the rounding that proofs/ bounds
# is that of separate multiplications and additions). Nobody reads errno or the floating-point flags: without that promise
# the compiler may not take a root, or choose by a comparison, for several triples at once.
function(plumb_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(NOT CMAKE_SYSTEM_NAME STREQUAL "Generic")  # without an operating system nobody would fill the table of addresses
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  if(PLUMB_COVERAGE)  # a decision that it cannot follow is a warning that -Werror does not reach: scripts/coverage refuses it
    target_compile_options(${target} PUBLIC -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc)
    target_link_options(${target} PUBLIC -fprofile-instr-generate)
  endif()
  if(PROJECT_IS_TOP_LEVEL AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # GCC tidies its memory less often: a tenth of its time
    target_compile_options(${target} PRIVATE "SHELL:--param ggc-min-expand=400" "SHELL:--param ggc-min-heapsize=400000")
  endif()
  target_compile_options(${target} PUBLIC -ffp-contract=off PRIVATE -fno-math-errno -fno-trapping-math ${PLUMB_WARNINGS})
endfunction()

# plumb_precompile(TARGET HEADER...): the headers that most sources of a target include, read once. Measured with GCC 12: half of
# the time of the core's libraries. Only in a fast build: any other build notices a source that includes too little.
function(plumb_precompile target)
  if(PLUMB_FAST_BUILD AND PROJECT_IS_TOP_LEVEL)
    target_precompile_headers(${target} PRIVATE ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)  # for ccache
  endif()
endfunction()

# plumb_optimise_less(TARGET): a fast build compiles what reads files and writes text once per run with -O1: a quarter of the
# time of GCC. What goes over samples stays as it ships.
function(plumb_optimise_less target)
  if(PLUMB_FAST_BUILD)
    target_compile_options(${target} PRIVATE -O1)
  endif()
endfunction()

# plumb_batch(TARGET): a fast build compiles several sources of the target at a time, for they share the templates that they
# cost. Names stay free: sources that have a name of namespace scope in common come into different batches.
function(plumb_batch target)
  if(NOT PLUMB_FAST_BUILD)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    get_source_file_property(alone "${source}" SKIP_UNITY_BUILD_INCLUSION)
    if(alone)
      continue()
    endif()
    file(READ "${source}" text)
    string(REGEX REPLACE "[;[]" "(" text "${text}")  # both end a declarator, and CMake's lists split at them
    string(REPLACE "]" ")" text "${text}")
    string(REGEX MATCHALL "\n[a-zA-Z_][^\n(={]*[(={]" heads "${text}")
    set(names)
    foreach(head IN LISTS heads)
      string(REGEX MATCH "([A-Za-z_0-9]+)( : [a-zA-Z: ]+)? *[(={]$" matched "${head}")
      list(APPEND names "${CMAKE_MATCH_1}")
    endforeach()
    list(REMOVE_DUPLICATES names)
    list(REMOVE_ITEM names namespace plumb PLUMB_ABI campaign cli coefficients commission findings geomagnetic io logs noise render review session survey verification scenario study bool double int size_t std void "")
    set(batch 0)
    while(TRUE)
      math(EXPR batch "${batch} + 1")
      set(others ${names_${batch}})
      list(LENGTH others before)
      list(REMOVE_ITEM others ${names} "")
      list(LENGTH others after)
      list(LENGTH sources_${batch} size)
      if(before EQUAL after AND size LESS 9)
        break()
      endif()
    endwhile()
    list(APPEND names_${batch} ${names})
    list(APPEND sources_${batch} "${source}")
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP "${target}_${batch}")
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
