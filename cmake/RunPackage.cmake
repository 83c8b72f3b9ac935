# cmake -DBUILD=<plumb's build> -DSOURCE=<plumb> -DWORK=<directory> -DFLAGS=<flags> -DGENERATOR=<of CMake> -P RunPackage.cmake
# Packs plumb, unpacks the package aside, and builds and runs programs in C++ and C that find it there: by CMake with GCC
# and Clang as C++17 and C++20 without exceptions and run-time types, and by pkg-config; then one that has plumb as a
# subdirectory. A compiler that is not here is said and left out.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()
function(must_watch program)  # both examples play the same fault
  must("${program}")
  if(NOT output MATCHES "suspect -> degraded  cause isolated_fault")
    message(FATAL_ERROR "${program} ran, but did not isolate the fault:\n${output}")
  endif()
endfunction()

# build_against(NAME COMPONENT LIBRARY): ${WORK}/NAME/main.cpp as a project that finds the installed plumb; ${WORK}/NAME/build/program
function(build_against name component library)
  file(WRITE "${WORK}/${name}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(program LANGUAGES CXX)
find_package(plumb 1 CONFIG REQUIRED COMPONENTS ${component})
add_executable(program main.cpp)
target_link_libraries(program PRIVATE ${library})
")
  must("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK}/${name}" -B "${WORK}/${name}/build" "-DCMAKE_PREFIX_PATH=${prefix}"
       "-DCMAKE_CXX_FLAGS=${FLAGS}")
  must("${CMAKE_COMMAND}" --build "${WORK}/${name}/build")
endfunction()

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
find_program(cpack cpack REQUIRED)
find_program(dpkg_deb dpkg-deb)
if(NOT dpkg_deb)
  message("skipped: there is no dpkg-deb here")
  return()
endif()
must("${cpack}" -G DEB --config "${BUILD}/CPackConfig.cmake" -B "${WORK}/pack")
file(GLOB package "${WORK}/pack/plumb_1*.deb")
must("${dpkg_deb}" -x "${package}" "${WORK}/root")
set(prefix "${WORK}/root/usr")
file(GLOB_RECURSE found RELATIVE "${prefix}" "${prefix}/*")
foreach(wanted IN ITEMS "share/doc/plumb/LICENSE" "share/doc/plumb/NOTICE" "include/plumb/c/plumb.h"
        "include/plumb/health/health_monitor.hpp" "pkgconfig/plumb\\.pc" "cmake/plumb/plumbConfig\\.cmake")
  if(NOT "${found}" MATCHES "${wanted}")
    message(FATAL_ERROR "the package has no ${wanted}")
  endif()
endforeach()

if("${found}" MATCHES "bin/plumb;")  # a package with the tool tells how it is used
  foreach(wanted IN ITEMS "share/man/man1/plumb\\.1" "share/bash-completion/completions/plumb"
          "share/zsh/vendor-completions/_plumb" "share/fish/vendor_completions\\.d/plumb\\.fish")
    if(NOT "${found}" MATCHES "${wanted}")
      message(FATAL_ERROR "the package has no ${wanted}")
    endif()
  endforeach()
endif()

set(count 0)
foreach(compiler IN ITEMS "g++;gcc" "clang++;clang")
  list(GET compiler 0 cxx)
  list(GET compiler 1 cc)
  find_program(${cxx}_path ${cxx})
  if(NOT ${cxx}_path)
    message("${cxx} is not here: left out")
    continue()
  endif()
  foreach(standard IN ITEMS 17 20)
    set(dir "${WORK}/${cxx}-${standard}")
    must("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${SOURCE}/examples/embed" -B "${dir}" "-DCMAKE_PREFIX_PATH=${prefix}"
         "-DCMAKE_CXX_COMPILER=${cxx}" "-DCMAKE_C_COMPILER=${cc}" "-DCMAKE_CXX_STANDARD=${standard}"
         "-DCMAKE_CXX_FLAGS=-fno-exceptions -fno-rtti -Wall -Wextra -Werror ${FLAGS}" "-DCMAKE_C_FLAGS=${FLAGS}")
    must("${CMAKE_COMMAND}" --build "${dir}")
    must_watch("${dir}/plumb_monitor_loop")
    must_watch("${dir}/plumb_monitor_loop_c")
    must_watch("${dir}/plumb_ring_loop")
    math(EXPR count "${count} + 3")
  endforeach()
endforeach()

# A component that is not there is told by name, with what to do.
foreach(case IN ITEMS "host;-" "paper;-" "nonsense;there is no component nonsense: there are paper, host and testing")
  list(GET case 0 component)
  list(GET case 1 told)
  file(WRITE "${WORK}/${component}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(component LANGUAGES CXX)
find_package(plumb 1 CONFIG REQUIRED COMPONENTS ${component})
")
  execute_process(COMMAND "${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK}/${component}" -B "${WORK}/${component}/build" "-DCMAKE_PREFIX_PATH=${prefix}"
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if("${found}" MATCHES "plumb(Host|Paper)Targets" AND component MATCHES "^(host|paper)$")
    set(told "-- Configuring done")
  elseif(component MATCHES "^(host|paper)$")
    set(told "component ${component} is not in this installation")
  endif()
  if(NOT output MATCHES "${told}")
    message(FATAL_ERROR "COMPONENTS ${component} (${status}) is not answered by \"${told}\":\n${output}")
  endif()
endforeach()

# The paper's monitor, for who sets it beside plumb's.
find_program(pkg_config pkg-config)
if("${found}" MATCHES "plumbPaperTargets")
  file(WRITE "${WORK}/with-paper/main.cpp" "#include <plumb/paper/paper_monitor.hpp>
static plumb::PaperSetup setup;
static plumb::PaperMonitor monitor;
int main() { return monitor.configure(setup).error().code == plumb::Errc::wrong_mode ? 0 : 1; }
")
  build_against("with-paper" paper plumb::paper)
  must("${WORK}/with-paper/build/program")
  math(EXPR count "${count} + 1")
  if(pkg_config)
    file(GLOB_RECURSE pc "${prefix}/*/plumb-paper.pc")
    get_filename_component(pc_dir "${pc}" DIRECTORY)
    set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
    must("${pkg_config}" --cflags --libs plumb-paper)
    separate_arguments(told NATIVE_COMMAND "${output}")
    separate_arguments(flags NATIVE_COMMAND "${FLAGS}")
    must(g++ -std=c++17 ${flags} "${WORK}/with-paper/main.cpp" -o "${WORK}/with-paper/by-pkg-config" ${told})
    must("${WORK}/with-paper/by-pkg-config")
    math(EXPR count "${count} + 1")
  endif()
endif()

# The host libraries: an array file and no log make a calibration that is refused, for a reason with a name.
if("${found}" MATCHES "plumbHostTargets")
  file(WRITE "${WORK}/with-session/main.cpp" "#include <plumb/findings/refusal.hpp>
#include <plumb/session/calibration_pipeline.hpp>
int main(int, char** argv) {
  const auto array = plumb::io::read_array_file(argv[1]);
  if (!array) return 1;
  const auto run = plumb::session::run_calibration(*array, std::vector<plumb::Sample>{});
  return plumb::findings::refusal_of(run, *array).front().code == plumb::findings::FindingCode::no_stretch_at_rest ? 0 : 1;
}
")
  build_against("with-session" host plumb::session)
  must("${WORK}/with-session/build/program" "${SOURCE}/examples/paper_tool.toml")
  math(EXPR count "${count} + 1")
  file(WRITE "${WORK}/with-verification/main.cpp" "#include <plumb/verification/verdict.hpp>
using namespace plumb::verification;
int main() { return judge(UserLimits{}, Facts{}).fit == Result::not_met ? 0 : 1; }  // of no array nothing is shown
")
  build_against("with-verification" host plumb::verification)
  must("${WORK}/with-verification/build/program")
  math(EXPR count "${count} + 1")
endif()

if(pkg_config)
  file(GLOB_RECURSE pc "${prefix}/*/plumb.pc")
  get_filename_component(pc_dir "${pc}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
  separate_arguments(flags NATIVE_COMMAND "${FLAGS}")
  foreach(case IN ITEMS "plumb;g++;-std=c++17;cpp" "plumb-c;gcc;-std=c99;c")
    list(GET case 0 name)
    list(GET case 1 compiler)
    list(GET case 2 standard)
    list(GET case 3 kind)
    must("${pkg_config}" --cflags --libs "${name}")
    separate_arguments(told NATIVE_COMMAND "${output}")
    must("${compiler}" "${standard}" ${flags} "${SOURCE}/examples/embed/monitor_loop.${kind}" -o "${WORK}/by-${name}" ${told})
    must_watch("${WORK}/by-${name}")
    math(EXPR count "${count} + 1")
  endforeach()
endif()

# As a subdirectory of another project, by FetchContent, which calls add_subdirectory; ccache, where it is, knows the objects
# already.
file(WRITE "${WORK}/parent/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES CXX C)
include(FetchContent)
FetchContent_Declare(plumb SOURCE_DIR \"${SOURCE}\")
FetchContent_MakeAvailable(plumb)
add_subdirectory(${SOURCE}/examples/embed embed)
")
find_program(ccache ccache)
set(launcher)
if(ccache)
  set(launcher "-DCMAKE_CXX_COMPILER_LAUNCHER=${ccache}")
endif()
must("${CMAKE_COMMAND}" -G "${GENERATOR}" -S "${WORK}/parent" -B "${WORK}/parent/build" -DCMAKE_BUILD_TYPE=Release
     "-DCMAKE_CXX_FLAGS_RELEASE=-O2 -DNDEBUG" "-DCMAKE_CXX_FLAGS=${FLAGS}" ${launcher})
must("${CMAKE_COMMAND}" --build "${WORK}/parent/build" --parallel 2 --target plumb_monitor_loop plumb_monitor_loop_c)
must_watch("${WORK}/parent/build/embed/plumb_monitor_loop")
must_watch("${WORK}/parent/build/embed/plumb_monitor_loop_c")
math(EXPR count "${count} + 2")
message("${count} programs built and run against the package and the subdirectory")
