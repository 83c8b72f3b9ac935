# The laws of isolation over some thousand cases each (tests/laws), those that users get (tests/laws/shipped), and
# the planted defects that they must catch (tests/laws/defects, label defect).

# Compiled once, linked once with the library as it is and once with every planted defect.
function(plumb_law_objects name library)
  add_library(${name} OBJECT ${ARGN})
  plumb_test_settings(${name} ${library})
  target_link_libraries(${name} PRIVATE GTest::gtest_main)
endfunction()

file(GLOB law_tests CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/laws/*_test.cpp")
file(GLOB law_helpers CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/support/*.cpp")
plumb_law_objects(plumb_law_objects plumb_8 ${law_tests} ${law_helpers})

# plumb_law_runner(NAME OBJECTS [OBJECT]): the laws, with OBJECT in the place of the library's own of those functions.
function(plumb_law_runner name objects)
  add_executable(${name} ${ARGN} "$<TARGET_OBJECTS:${objects}>")
  target_link_libraries(${name} PRIVATE "$<TARGET_PROPERTY:${objects},LINK_LIBRARIES>")
endfunction()

plumb_law_runner(plumb_law_tests plumb_law_objects)
plumb_discover(plumb_law_tests LABEL law LONGER *)

if(TARGET plumb_testing)
  file(GLOB shipped_law_tests CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/laws/shipped/*_test.cpp")
  plumb_law_objects(plumb_shipped_law_objects plumb_testing ${shipped_law_tests})
  plumb_law_runner(plumb_shipped_law_tests plumb_shipped_law_objects)
  plumb_discover(plumb_shipped_law_tests LABEL law LONGER *)
endif()

# --- Planted defects. ------------------------------------------------------------------------------------------
# The defect's object comes before the archive, whose own member of that name is then never pulled in. Where a symbol
# were missing from it, the member would be pulled in and the linker would refuse the doubles.
function(plumb_planted_defect file)
  get_filename_component(name "${file}" NAME_WE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
  file(STRINGS "${file}" header REGEX "^(rule|source|law|cases|expect): ")
  foreach(line IN LISTS header)
    string(REGEX MATCH "^([a-z]+): (.*)$" matched "${line}")
    set(said_${CMAKE_MATCH_1} "${CMAKE_MATCH_2}")
  endforeach()
  foreach(key rule source law cases expect)
    if(NOT DEFINED said_${key})
      message(FATAL_ERROR "${file}: no line \"${key}: ...\"")
    endif()
  endforeach()
  if(said_law MATCHES "^Law\\.")
    set(capacity 8)
    set(objects plumb_law_objects)
    set(environment "PLUMB_LAW_CASES=${said_cases}")
  else()
    set(capacity 24)
    set(objects plumb_shipped_law_objects)
    set(environment "RC_PARAMS=seed=20180227 max_success=${said_cases}")
    if(NOT TARGET plumb_shipped_law_objects)
      return()
    endif()
  endif()
  set(planted "${PROJECT_BINARY_DIR}/defects/${name}.cpp")
  add_custom_command(OUTPUT "${planted}"
    COMMAND "${CMAKE_COMMAND}" "-DDEFECT=${file}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DOUTPUT=${planted}"
            -P "${PROJECT_SOURCE_DIR}/cmake/PlantDefect.cmake"
    DEPENDS "${file}" "${PROJECT_SOURCE_DIR}/${said_source}" "${PROJECT_SOURCE_DIR}/cmake/PlantDefect.cmake"
    COMMENT "Planting ${name}" VERBATIM)
  set(target plumb_defect_${name})
  get_filename_component(room "${PROJECT_SOURCE_DIR}/${said_source}" DIRECTORY)
  # As the library is compiled, but for warnings: a rule removed may leave a name unused.
  add_library(${target}_object OBJECT "${planted}")
  plumb_compile_settings(${target}_object)
  target_compile_options(${target}_object PRIVATE -fno-exceptions -fno-rtti -w)
  target_include_directories(${target}_object PRIVATE "${room}")
  target_link_libraries(${target}_object PRIVATE plumb_${capacity})
  plumb_law_runner(${target} ${objects} "$<TARGET_OBJECTS:${target}_object>")
  add_test(NAME defect.${name}
    COMMAND "${CMAKE_COMMAND}" "-DEXPECT=${said_expect}" -P "${PROJECT_SOURCE_DIR}/cmake/RunDefect.cmake" --
            "$<TARGET_FILE:${target}>" "--gtest_filter=${said_law}")
  set_tests_properties(defect.${name} PROPERTIES LABELS "defect;slow" TIMEOUT 300 ENVIRONMENT "${environment}")
endfunction()

add_test(NAME defect.all_apply COMMAND "${CMAKE_COMMAND}" "-DROOT=${PROJECT_SOURCE_DIR}"
  "-DOUTPUT=${PROJECT_BINARY_DIR}/defects_applied.cpp" -P "${PROJECT_SOURCE_DIR}/cmake/CheckDefects.cmake")
set_tests_properties(defect.all_apply PROPERTIES LABELS "trace;quick" TIMEOUT 60)

# Only in builds as they ship: under sanitizers nothing new would be learnt from them.
if(PLUMB_PLANT_DEFECTS AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  file(GLOB defects CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/laws/defects/*.defect")
  foreach(defect IN LISTS defects)
    plumb_planted_defect("${defect}")
  endforeach()

  # What guards the defects can fail too.
  foreach(refusal "stale;no longer applies" "doubled;is not clear")
    list(GET refusal 0 name)
    list(GET refusal 1 message)
    add_test(NAME defect.${name}_is_refused
      COMMAND "${CMAKE_COMMAND}" "-DDEFECT=${PROJECT_SOURCE_DIR}/tests/laws/defects/refused/${name}.txt"
              "-DROOT=${PROJECT_SOURCE_DIR}" "-DOUTPUT=${PROJECT_BINARY_DIR}/defects/${name}.cpp"
              -P "${PROJECT_SOURCE_DIR}/cmake/PlantDefect.cmake")
    set_tests_properties(defect.${name}_is_refused PROPERTIES
      LABELS "defect;slow" TIMEOUT 60 PASS_REGULAR_EXPRESSION "${message}")
  endforeach()
  add_test(NAME defect.a_law_that_holds_is_no_catch
    COMMAND "${CMAKE_COMMAND}" "-DEXPECT=law 9" -P "${PROJECT_SOURCE_DIR}/cmake/RunDefect.cmake" --
            "$<TARGET_FILE:plumb_law_tests>" "--gtest_filter=Law.NineF*")
  set_tests_properties(defect.a_law_that_holds_is_no_catch PROPERTIES
    LABELS "defect;slow" TIMEOUT 60 ENVIRONMENT "PLUMB_LAW_CASES=20" PASS_REGULAR_EXPRESSION "the run ended[ \n]*with: 0")
endif()
