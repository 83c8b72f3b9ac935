# cmake -DSOURCE=<plumb> -DWORK=<directory> -DEXPECTED=<output of the example> -DEXAMPLE=<its C source> -DCXX=<compiler> -P RunEmbedded.cmake
# Writes plumb as one header (scripts/embedded) and uses it as people without its CMake files do: a C program beside one C++
# source, run and compared; the sketch of the Arduino IDE, the component of ESP-IDF, the module of Zephyr and plain CMake, with
# what those tool chains provide put in their place by a few lines here; and for a Cortex-M where that compiler is installed.
function(must)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "failed (${status}): ${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE "${WORK}")
file(MAKE_DIRECTORY "${WORK}")
set(plumb "${WORK}/plumb")
must(python3 -B "${SOURCE}/scripts/embedded.py" "${plumb}")
file(READ "${plumb}/src/plumb.h" header)
string(FIND "${header}" "${SOURCE}" path)
if(NOT path EQUAL -1 OR header MATCHES "\n#include \"")
  message(FATAL_ERROR "plumb.h names a path of this machine, or needs a header of plumb")
endif()

# --- One C++ source, one C program. ---
set(strict -Wall -Wextra -Werror)
file(READ "${EXAMPLE}" program)
string(REPLACE "plumb/c/plumb.h" "plumb.h" program "${program}")
file(WRITE "${WORK}/program.c" "${program}")
must("${CXX}" -std=c++17 -O1 -fno-exceptions -fno-rtti ${strict} -c -o "${WORK}/plumb.o" "${plumb}/src/plumb.cpp")
must(cc -std=c99 -pedantic ${strict} -I "${plumb}/src" -c -o "${WORK}/program.o" "${WORK}/program.c")
must("${CXX}" -o "${WORK}/program" "${WORK}/program.o" "${WORK}/plumb.o" -lm)
must("${WORK}/program")
set(answer "${output}")
must("${EXPECTED}")
if(NOT answer STREQUAL output)
  message(FATAL_ERROR "the one-header build said\n${answer}where the library says\n${output}")
endif()

# --- Without a first calibration it is smaller; with the second compiler it is accepted as well. ---
set(check -std=gnu++17 -fno-exceptions -fno-rtti ${strict} -fsyntax-only)
must("${CXX}" ${check} -DPLUMB_CAPACITY=8 -DPLUMB_FIRST_CALIBRATION=0 "${plumb}/src/plumb.cpp")
find_program(clang clang++)
if(clang)
  must("${clang}" ${check} "${plumb}/src/plumb.cpp")
else()
  message("left out: there is no clang++ here")
endif()

# --- The Arduino IDE: its core is played by this. ---
file(WRITE "${WORK}/Arduino.h" "#include <cstdint>
enum { A0 = 14 };
int analogRead(int);
unsigned long micros();
struct SerialPort { void begin(long); void print(const char*); void println(const char*); };
extern SerialPort Serial;
")
must("${CXX}" ${check} -include "${WORK}/Arduino.h" -I "${plumb}/src" -x c++ "${plumb}/examples/monitor/monitor.ino")

# --- ESP-IDF, Zephyr, plain CMake: what their CMake files define is played by these. ---
function(builds name before after)
  file(WRITE "${WORK}/${name}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.16)
project(${name} LANGUAGES C CXX)
${before}
add_subdirectory(\"${plumb}\" plumb)
${after}
add_executable(program \"${WORK}/program.c\")
target_link_libraries(program PRIVATE ${ARGN} m)
")
  must("${CMAKE_COMMAND}" -S "${WORK}/${name}" -B "${WORK}/${name}/build" "-DCMAKE_CXX_COMPILER=${CXX}")
  must("${CMAKE_COMMAND}" --build "${WORK}/${name}/build")
  must("${WORK}/${name}/build/program")
  if(NOT output STREQUAL answer)
    message(FATAL_ERROR "${name}: the program said\n${output}")
  endif()
endfunction()
builds(esp "set(ESP_PLATFORM 1)
set(CONFIG_PLUMB_CAPACITY 4)
set(COMPONENT_LIB __idf_plumb)
function(idf_component_register)
  cmake_parse_arguments(idf \"\" \"\" \"SRCS;INCLUDE_DIRS\" \${ARGN})
  add_library(__idf_plumb STATIC \${idf_SRCS})
  target_include_directories(__idf_plumb PUBLIC \${idf_INCLUDE_DIRS})
endfunction()" "" __idf_plumb)
builds(zephyr "set(ZEPHYR_BASE /zephyr)
set(CONFIG_PLUMB y)
add_library(zephyr_interface INTERFACE)
function(zephyr_include_directories folder)
  target_include_directories(zephyr_interface INTERFACE \"\${CMAKE_CURRENT_SOURCE_DIR}/\${folder}\")
endfunction()
function(zephyr_library_named name)
  add_library(\${name} STATIC)
  target_link_libraries(\${name} PUBLIC zephyr_interface)
endfunction()
function(zephyr_library_sources)
  target_sources(plumb PRIVATE \${ARGN})
endfunction()" "" plumb)

# --- A Cortex-M7 and an M4F, with the flags that their tool chains use. ---
find_program(arm arm-none-eabi-g++)
if(arm)
  foreach(cpu IN ITEMS "-mcpu=cortex-m7;-mfpu=fpv5-d16" "-mcpu=cortex-m4;-mfpu=fpv4-sp-d16")
    must("${arm}" ${check} -Os -mthumb ${cpu} -mfloat-abi=hard -fno-threadsafe-statics "${plumb}/src/plumb.cpp")
  endforeach()
else()
  message("left out: there is no arm-none-eabi-g++ here (Debian: gcc-arm-none-eabi)")
endif()
