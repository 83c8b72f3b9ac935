# The host's half of scripts/baremetal: the recorder, the replay that a target has to repeat bit for bit, and the judge
# of both. Not part of `all`.
add_executable(metal_record EXCLUDE_FROM_ALL "${PROJECT_SOURCE_DIR}/baremetal/record.cpp")
plumb_compile_settings(metal_record)
target_link_libraries(metal_record PRIVATE plumb_scenario plumb_24)
add_executable(metal_judge EXCLUDE_FROM_ALL "${PROJECT_SOURCE_DIR}/baremetal/judge.cpp")
plumb_compile_settings(metal_judge)
set(replays)
foreach(capacity IN ITEMS 4 8)
  if(TARGET plumb_${capacity})
    add_executable(metal_host_${capacity} EXCLUDE_FROM_ALL "${PROJECT_SOURCE_DIR}/baremetal/host_main.cpp"
      "${PROJECT_SOURCE_DIR}/baremetal/replay.cpp")
    plumb_compile_settings(metal_host_${capacity})
    target_link_libraries(metal_host_${capacity} PRIVATE plumb_${capacity})
    list(APPEND replays metal_host_${capacity})
  endif()
endforeach()
add_custom_target(plumb_metal_host DEPENDS metal_record metal_judge ${replays})
