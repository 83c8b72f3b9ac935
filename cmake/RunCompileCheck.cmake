# cmake -DMUST_FAIL_WITH=<regex or nothing> -P RunCompileCheck.cmake -- <compiler command...>
# Runs the command. Empty MUST_FAIL_WITH: it has to succeed. Otherwise it has to fail with that message.
include("${CMAKE_CURRENT_LIST_DIR}/CommandOfScript.cmake")

set(ENV{LC_ALL} C)
execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
list(JOIN command " " shown)
if(MUST_FAIL_WITH STREQUAL "")
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "had to work, but failed (${result}): ${shown}\n${output}")
  endif()
elseif(result EQUAL 0)
  message(FATAL_ERROR "had to fail with \"${MUST_FAIL_WITH}\", but worked: ${shown}")
elseif(NOT output MATCHES "${MUST_FAIL_WITH}")
  message(FATAL_ERROR "failed, but not with \"${MUST_FAIL_WITH}\": ${shown}\n${output}")
endif()
