# The native half of the explorer's tests: the page's core as a program of this machine, and the tests that hold WebAssembly
# against it. The page itself is built by scripts/web. Not part of a usual build.
if(NOT PLUMB_ALL_CAPACITIES OR NOT TARGET plumb_render)
  return()
endif()
file(GLOB web_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/web/core/*.cpp")
list(FILTER web_sources EXCLUDE REGEX "/(exports|left_out|no_toml)\\.cpp$")  # the browser's own
add_executable(plumb_web_native ${web_sources} "${PROJECT_SOURCE_DIR}/bench/motion/px4_rules.cpp")
plumb_compile_settings(plumb_web_native)
plumb_optimise_less(plumb_web_native)
target_link_libraries(plumb_web_native PRIVATE plumb_render)

add_test(NAME web.stories COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/stories.sh" "$<TARGET_FILE:plumb_web_native>"
  "${PROJECT_SOURCE_DIR}")
set_tests_properties(web.stories PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 1800
  RESOURCE_LOCK explorer_build)  # both build the page in the same folder
if(TARGET plumb_replay)
  add_test(NAME web.replay COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/replay.sh" node "$<TARGET_FILE:plumb_replay>"
    "${PROJECT_SOURCE_DIR}")
  set_tests_properties(web.replay PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 1800 RESOURCE_LOCK explorer_build)
endif()
if(TARGET plumb_tool)
  add_test(NAME web.scenarios COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/scenarios.sh" "$<TARGET_FILE:plumb_tool>"
    "${PROJECT_SOURCE_DIR}")
  set_tests_properties(web.scenarios PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 1800 RESOURCE_LOCK explorer_build)
endif()
if(PLUMB_PYTHON3 AND TARGET plumb_tool)
  add_test(NAME web.drop COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/drop.sh" "$<TARGET_FILE:plumb_tool>"
    "${PROJECT_SOURCE_DIR}" "${PLUMB_PYTHON3}")
  set_tests_properties(web.drop PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 3600 RESOURCE_LOCK explorer_build)
endif()
if(PLUMB_PYTHON3)
  add_test(NAME web.replay_browser COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/replay.sh" browser none "${PROJECT_SOURCE_DIR}"
    "${PLUMB_PYTHON3}")
  set_tests_properties(web.replay_browser PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 1800
    RESOURCE_LOCK explorer_build)
  add_test(NAME web.page COMMAND bash "${PROJECT_SOURCE_DIR}/tests/web/page.sh" "$<TARGET_FILE:plumb_web_native>"
    "${PROJECT_SOURCE_DIR}" "${PLUMB_PYTHON3}")
  set_tests_properties(web.page PROPERTIES LABELS "host;slow" SKIP_RETURN_CODE 77 TIMEOUT 3600 RESOURCE_LOCK explorer_build)
endif()
