# cmake -DBUILD=<plumb's build> -DSOURCE=<project> -DWORK=<directory> -DGENERATOR=<of CMake> -DPROGRAM=<name> -P RunConsumer.cmake:
# installs plumb aside, then configures and builds a project that finds it there, and runs one of its programs.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}")
  endif()
endfunction()
file(REMOVE_RECURSE "${WORK}")
must("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/stage")
must("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${SOURCE}" -B "${WORK}/build" "-DCMAKE_PREFIX_PATH=${WORK}/stage" "-DCMAKE_CXX_COMPILER=${CXX}"
     -DCMAKE_BUILD_TYPE=Release "-DCMAKE_CXX_FLAGS=${FLAGS}")
must("${CMAKE_COMMAND}" --build "${WORK}/build")
must("${WORK}/build/${PROGRAM}")
