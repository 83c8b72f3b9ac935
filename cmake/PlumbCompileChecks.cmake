# Things that must not compile or must not link, as tests (label compile). Each has a twin that must work, so
# that a check cannot pass for the wrong reason.

# plumb_compile_check(NAME SOURCE <file below tests/compile>
#                     [MUST_FAIL_WITH <regular expression>]  without it the file must compile (and link)
#                     [DEFINES <name=value>...] [OPTIONS <flag>...] [LINK <library target>])
function(plumb_compile_check name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "SOURCE;MUST_FAIL_WITH;LINK" "DEFINES;OPTIONS")
  set(command "${CMAKE_CXX_COMPILER}" -std=c++17 ${arg_OPTIONS} "-I${PROJECT_SOURCE_DIR}/include")
  foreach(target IN ITEMS Eigen3::Eigen tl::expected)
    list(APPEND command "-isystem$<JOIN:$<TARGET_PROPERTY:${target},INTERFACE_INCLUDE_DIRECTORIES>,;-isystem>")
  endforeach()
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

plumb_compile_check(compile.config_works SOURCE include_config.cpp)
plumb_compile_check(compile.fast_math_is_refused
  SOURCE include_config.cpp OPTIONS -ffast-math MUST_FAIL_WITH "plumb refuses -ffast-math")
plumb_compile_check(compile.capacity_of_5_is_refused
  SOURCE include_config.cpp DEFINES PLUMB_CAPACITY=5 MUST_FAIL_WITH "PLUMB_CAPACITY is 4, 8, 16 or 24")

file(GLOB array_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/array/*.cpp")
if(array_sources)
  plumb_compile_check(compile.same_capacity_links SOURCE uses_array.cpp DEFINES PLUMB_CAPACITY=8 LINK plumb_8)
  plumb_compile_check(compile.other_capacity_does_not_link
    SOURCE uses_array.cpp DEFINES PLUMB_CAPACITY=4 LINK plumb_8 MUST_FAIL_WITH "undefined.*cap4::make_id")
endif()
