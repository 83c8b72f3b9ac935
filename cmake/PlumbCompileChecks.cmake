# Things that must not compile or must not link, as tests (label compile). Each has a twin that must work, so
# that a check cannot pass for the wrong reason.

# plumb_compile_check(NAME SOURCE <file below tests/compile>
#                     [MUST_FAIL_WITH <regular expression>]  without it the file must compile (and link)
#                     [DEFINES <name=value>...] [OPTIONS <flag>...] [LINK <library target>])
function(plumb_compile_check name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SOURCE;MUST_FAIL_WITH;LINK" "DEFINES;OPTIONS")
  set(command "${CMAKE_CXX_COMPILER}" -std=c++17 ${arg_OPTIONS} "-I${PROJECT_SOURCE_DIR}/include")
  list(APPEND command "-isystem$<JOIN:$<TARGET_PROPERTY:tl::expected,INTERFACE_INCLUDE_DIRECTORIES>,;-isystem>")
  foreach(define IN LISTS arg_DEFINES)
    list(APPEND command "-D${define}")
  endforeach()
  list(APPEND command "${PROJECT_SOURCE_DIR}/tests/compile/${arg_SOURCE}")
  if(arg_LINK)
    separate_arguments(flags NATIVE_COMMAND "${CMAKE_CXX_FLAGS} ${CMAKE_EXE_LINKER_FLAGS}")
    list(APPEND command ${flags} "$<TARGET_FILE:${arg_LINK}>" -o "${CMAKE_CURRENT_BINARY_DIR}/${name}.out")
  else()
    list(APPEND command -fsyntax-only)
  endif()
  add_test(NAME ${name}
    COMMAND "${CMAKE_COMMAND}" "-DMUST_FAIL_WITH=${arg_MUST_FAIL_WITH}"
            -P "${PROJECT_SOURCE_DIR}/cmake/RunCompileCheck.cmake" -- ${command}
    COMMAND_EXPAND_LISTS)
  set_tests_properties(${name} PROPERTIES LABELS compile TIMEOUT 300)
endfunction()

# Verifies: REQ-164
plumb_compile_check(compile.config_works SOURCE include_config.cpp)
# Negative: REQ-164
plumb_compile_check(compile.fast_math_is_refused
  SOURCE include_config.cpp OPTIONS -ffast-math MUST_FAIL_WITH "remove -ffast-math")
# Negative: REQ-164
plumb_compile_check(compile.finite_math_is_refused
  SOURCE include_config.cpp OPTIONS -ffinite-math-only MUST_FAIL_WITH "remove -ffast-math")
# Negative: REQ-164
plumb_compile_check(compile.older_language_is_refused
  SOURCE include_config.cpp OPTIONS -std=c++14 MUST_FAIL_WITH "compile with -std=c\\+\\+17")
# Negative: REQ-164
plumb_compile_check(compile.capacity_of_5_is_refused
  SOURCE include_config.cpp DEFINES PLUMB_CAPACITY=5 MUST_FAIL_WITH "PLUMB_CAPACITY must be 4, 8, 16 or 24")
# A first calibration is a fit.
# Negative: REQ-164
plumb_compile_check(compile.first_calibration_without_fits_is_refused
  SOURCE include_config.cpp DEFINES PLUMB_RECALIBRATION=0 PLUMB_FIRST_CALIBRATION=1
  MUST_FAIL_WITH "PLUMB_FIRST_CALIBRATION=1 needs PLUMB_RECALIBRATION=1")

# The state of a monitor, in bytes; the last of the three shows that the check can fail.
# Verifies: REQ-165
plumb_compile_check(compile.monitor_of_4_is_small
  SOURCE monitor_size.cpp DEFINES PLUMB_CAPACITY=4 LIMIT_KIB=12)
# Verifies: REQ-165
plumb_compile_check(compile.monitor_of_8_is_small
  SOURCE monitor_size.cpp DEFINES PLUMB_CAPACITY=8 LIMIT_KIB=34)
# Negative: REQ-165
plumb_compile_check(compile.monitor_beyond_its_size_is_refused
  SOURCE monitor_size.cpp DEFINES PLUMB_CAPACITY=8 LIMIT_KIB=1 MUST_FAIL_WITH "larger than the requirement allows")

file(GLOB array_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/array/*.cpp")
if(array_sources)
  # Verifies: REQ-164
  plumb_compile_check(compile.same_capacity_links SOURCE uses_array.cpp DEFINES PLUMB_CAPACITY=8 LINK plumb_8)
  # Negative: REQ-164
  plumb_compile_check(compile.other_capacity_does_not_link
    SOURCE uses_array.cpp DEFINES PLUMB_CAPACITY=4 LINK plumb_8 MUST_FAIL_WITH "undefined.*cap4::make_id")
  # Negative: REQ-164
  plumb_compile_check(compile.leaner_build_does_not_link
    SOURCE uses_array.cpp DEFINES PLUMB_CAPACITY=8 PLUMB_RECALIBRATION=0 LINK plumb_8
    MUST_FAIL_WITH "undefined.*cap8_fixed::make_id")
endif()

# --- What the core libraries refer to: heap, exceptions, run-time types. Unoptimised code refers to branches that never
# run, so only the build that ships is looked at; the decoy shows that the check can fail.
if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  # Verifies: REQ-160
  add_test(NAME symbols.core_has_no_heap COMMAND bash "${PROJECT_SOURCE_DIR}/scripts/check_symbols" "${PROJECT_BINARY_DIR}")
  add_library(plumb_decoy STATIC "${PROJECT_SOURCE_DIR}/tests/compile/uses_heap.cpp")
  set_target_properties(plumb_decoy PROPERTIES
    OUTPUT_NAME plumb_8 ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}/decoy")
  # Negative: REQ-160
  add_test(NAME symbols.a_heap_is_found COMMAND bash "${PROJECT_SOURCE_DIR}/scripts/check_symbols" "${CMAKE_CURRENT_BINARY_DIR}/decoy")
  set_tests_properties(symbols.core_has_no_heap PROPERTIES LABELS compile TIMEOUT 120)
  set_tests_properties(symbols.a_heap_is_found PROPERTIES LABELS compile TIMEOUT 120
    PASS_REGULAR_EXPRESSION "libplumb_8.a refers to:.*operator new")
endif()

# Every header compiles alone: a user may include any public one first.
set(system_includes "-isystem$<JOIN:$<TARGET_PROPERTY:tl::expected,INTERFACE_INCLUDE_DIRECTORIES>,;-isystem>")
add_test(NAME compile.headers_stand_alone
  COMMAND bash "${PROJECT_SOURCE_DIR}/tests/compile/headers.sh" "${PROJECT_SOURCE_DIR}/include" "${CMAKE_CXX_COMPILER}"
          -DPLUMB_CAPACITY=8 ${system_includes}
  COMMAND_EXPAND_LISTS)
set_tests_properties(compile.headers_stand_alone PROPERTIES LABELS "compile;slow" TIMEOUT 300)
