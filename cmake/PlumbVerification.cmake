# What the verification report has to know of its own build: which requirement is checked by which test, and what exactly was
# built. Both are part of the tool, so that an installed one needs no source tree. Included where plumb_render is.

# --- Requirements, hazards, tests, formal items: read by the readers of tests/trace. -----------------------------------
add_executable(plumb_trace_export "${PROJECT_SOURCE_DIR}/src/trace/export.cpp")
plumb_compile_settings(plumb_trace_export)
target_compile_options(plumb_trace_export PRIVATE -O0)  # it runs once for a moment, and is compiled in half the time
target_include_directories(plumb_trace_export PRIVATE "${PROJECT_SOURCE_DIR}/tests")
target_link_libraries(plumb_trace_export PRIVATE nlohmann_json::nlohmann_json)

file(GLOB_RECURSE traced CONFIGURE_DEPENDS
  "${PROJECT_SOURCE_DIR}/docs/requirements/*" "${PROJECT_SOURCE_DIR}/tests/*_test.cpp"
  "${PROJECT_SOURCE_DIR}/cmake/*.cmake" "${PROJECT_SOURCE_DIR}/proofs/*.smt2")
set(traceability "${PROJECT_BINARY_DIR}/generated/traceability_data.cpp")
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/generated")
add_custom_command(OUTPUT "${traceability}"
  COMMAND plumb_trace_export "${PROJECT_SOURCE_DIR}" "${traceability}"
  DEPENDS plumb_trace_export ${traced} "${PROJECT_SOURCE_DIR}/docs/assurance.md"
  COMMENT "Requirements and tests, as the tool knows them" VERBATIM)

# --- Version, commit, compiler, flags. ---------------------------------------------------------------------------------
string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
string(STRIP "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}} -std=c++17 -ffp-contract=off" build_flags)
string(REPLACE "\"" "\\\"" build_flags "${build_flags}")
string(CONCAT identity
  "#define PLUMB_BUILD_COMPILER \"${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}\"\n"
  "#define PLUMB_BUILD_FLAGS \"${build_flags}\"\n"
  "#define PLUMB_BUILD_TYPE \"${CMAKE_BUILD_TYPE}\"\n"
  "#define PLUMB_BUILD_TARGET \"${CMAKE_SYSTEM_NAME} ${CMAKE_SYSTEM_PROCESSOR}\"\n")
file(GENERATE OUTPUT "${PROJECT_BINARY_DIR}/generated/build_identity.txt" CONTENT "${identity}")
add_custom_target(plumb_build_identity
  COMMAND "${CMAKE_COMMAND}" "-DOUT=${PROJECT_BINARY_DIR}/generated/build_identity.hpp"
          "-DROOT=${PROJECT_SOURCE_DIR}" "-DTEXT=${PROJECT_BINARY_DIR}/generated/build_identity.txt"
          -P "${PROJECT_SOURCE_DIR}/cmake/BuildIdentity.cmake"
  BYPRODUCTS "${PROJECT_BINARY_DIR}/generated/build_identity.hpp" VERBATIM)

target_sources(plumb_render PRIVATE "${traceability}")
target_include_directories(plumb_render PRIVATE "${PROJECT_BINARY_DIR}/generated")
target_compile_definitions(plumb_render PRIVATE PLUMB_VERSION="${PROJECT_VERSION}")
add_dependencies(plumb_render plumb_build_identity)
