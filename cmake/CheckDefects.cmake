# cmake -DROOT=<plumb> -DOUTPUT=<file> -P CheckDefects.cmake: every planted defect still finds the rule that it takes away. They are
# built with scripts/test --slow only; that one no longer applies shows here.
file(GLOB defects "${ROOT}/tests/laws/defects/*.defect")
foreach(defect IN LISTS defects)
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DDEFECT=${defect}" "-DROOT=${ROOT}" "-DOUTPUT=${OUTPUT}"
                          -P "${ROOT}/cmake/PlantDefect.cmake" COMMAND_ERROR_IS_FATAL ANY)
endforeach()
list(LENGTH defects count)
if(count EQUAL 0)
  message(FATAL_ERROR "there are no planted defects in tests/laws/defects")
endif()
message(STATUS "${count} planted defects apply")
