# The libraries. Sources are found per room, so that adding a file needs no change here; a room that is
# still empty is no error, a library without any source is not made.

include(GNUInstallDirs)

set(PLUMB_CORE_ROOMS core numeric array gravity calibration detection navigation motion health)
set(PLUMB_CAPACITIES 8)
if(PLUMB_SCALAR STREQUAL "float")
  list(APPEND PLUMB_CAPACITIES 4)  # those that config.hpp allows
elseif(PLUMB_ALL_CAPACITIES)
  list(APPEND PLUMB_CAPACITIES 4 16 24)
elseif(PLUMB_BUILD_HOST)
  list(APPEND PLUMB_CAPACITIES 24)
endif()

plumb_find_package(tl-expected DEBIAN libexpected-dev TARGET tl::expected)

# plumb_sources(VARIABLE ROOM...): the sources of the named rooms.
function(plumb_sources variable)
  set(patterns ${ARGN})
  list(TRANSFORM patterns REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/src/\\1/*.cpp")
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(${variable} "${sources}" PARENT_SCOPE)
endfunction()

# Common to all libraries: headers in place and installed, one alias plumb::<name>.
function(plumb_library target export_name)
  add_library(plumb::${export_name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${export_name})
  target_include_directories(${target} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  plumb_compile_settings(${target})
  if(NOT PROJECT_IS_TOP_LEVEL)
    set_target_properties(${target} PROPERTIES EXCLUDE_FROM_ALL TRUE)  # a parent builds what it links
  endif()
endfunction()

set(PLUMB_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <cstring> <limits> <type_traits> <utility> <tl/expected.hpp>)

# --- Floors 1 to 4: one static library per capacity; a mixture of two does not link. ---------------------
plumb_sources(core_sources ${PLUMB_CORE_ROOMS})
if(NOT core_sources)
  message(FATAL_ERROR "no sources below src/ in any of: ${PLUMB_CORE_ROOMS}")
endif()
# plumb_core_library(TARGET CAPACITY [DEFINITION...])
function(plumb_core_library target capacity)
  add_library(${target} STATIC ${core_sources})
  plumb_library(${target} ${target})
  target_compile_definitions(${target} PUBLIC PLUMB_CAPACITY=${capacity} ${ARGN})
  target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti)
  target_link_libraries(${target} PUBLIC tl::expected)
  plumb_precompile(${target} ${PLUMB_COMMON_HEADERS})
  # A planted defect takes the place of one object of the archive: there every source keeps its own.
  if(NOT (PLUMB_PLANT_DEFECTS AND PLUMB_BUILD_TESTS AND target MATCHES "^plumb_(8|24)$"))
    plumb_batch(${target})
  endif()
  if(PLUMB_FAST_STEP)
    set(often calibration/sensor_model core/storage_map detection/block detection/channel_monitor detection/combination_mae
      detection/lanes detection/near_lengths health/health_monitor health/intake health/memory)
    list(TRANSFORM often REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/src/\\1.cpp")
    set_source_files_properties(${often} TARGET_DIRECTORY ${target} PROPERTIES COMPILE_OPTIONS -O2)
  endif()
endfunction()

set(PLUMB_LEFT_OUT)
if(NOT PLUMB_RECALIBRATION)
  list(APPEND PLUMB_LEFT_OUT PLUMB_RECALIBRATION=0)
elseif(NOT PLUMB_FIRST_CALIBRATION)
  list(APPEND PLUMB_LEFT_OUT PLUMB_FIRST_CALIBRATION=0)
endif()
if(PLUMB_SCALAR STREQUAL "float")
  list(APPEND PLUMB_LEFT_OUT PLUMB_SCALAR=float)
endif()
foreach(capacity IN LISTS PLUMB_CAPACITIES)
  plumb_core_library(plumb_${capacity} ${capacity} ${PLUMB_LEFT_OUT})
endforeach()
add_library(plumb::plumb ALIAS plumb_8)

# What a build may leave out, and single precision, for the tests and scripts/baremetal: built where they ask for it.
if(4 IN_LIST PLUMB_CAPACITIES AND NOT PLUMB_LEFT_OUT)
  plumb_core_library(plumb_4_held 4 PLUMB_FIRST_CALIBRATION=0)
  plumb_core_library(plumb_4_fixed 4 PLUMB_RECALIBRATION=0)
  plumb_core_library(plumb_4_float 4 PLUMB_SCALAR=float)
  set_target_properties(plumb_4_held plumb_4_fixed plumb_4_float PROPERTIES EXCLUDE_FROM_ALL TRUE)
endif()

# --- The C functions: the same monitor for programs in C, one library per capacity; a program links one of them. ---
plumb_sources(c_sources c)
foreach(capacity IN LISTS PLUMB_CAPACITIES)
  add_library(plumb_c_${capacity} STATIC ${c_sources})
  plumb_library(plumb_c_${capacity} c_${capacity})
  target_compile_options(plumb_c_${capacity} PRIVATE -fno-exceptions -fno-rtti)
  target_link_libraries(plumb_c_${capacity} PUBLIC plumb_${capacity})
endforeach()
add_library(plumb::c ALIAS plumb_c_8)

# --- Host libraries, always with 24 sensors. ----------------------------------------------------------------
if(NOT PLUMB_BUILD_HOST)
  return()
endif()

plumb_find_package(Eigen3 DEBIAN libeigen3-dev TARGET Eigen3::Eigen NO_MODULE)
# plumb_with_eigen(TARGET): in its sources, not in what a user of the library compiles.
function(plumb_with_eigen target)
  target_link_libraries(${target} PRIVATE "$<BUILD_INTERFACE:Eigen3::Eigen>")
endfunction()

# The paper's algorithm, to compare with: above the instrument's libraries, which know nothing of it.
# plumb_paper_library(TARGET EXPORT_NAME CAPACITY): for another capacity than the host's where something compares there.
plumb_sources(paper_sources paper)
function(plumb_paper_library target export_name capacity)
  add_library(${target} STATIC ${paper_sources})
  plumb_library(${target} ${export_name})
  target_compile_options(${target} PRIVATE -fno-exceptions -fno-rtti)
  target_link_libraries(${target} PUBLIC plumb_${capacity})
  plumb_with_eigen(${target})
  plumb_precompile(${target} ${PLUMB_COMMON_HEADERS})
endfunction()
plumb_paper_library(plumb_paper paper 24)

plumb_sources(scenario_sources scenario)
if(scenario_sources)
  plumb_find_header(TARGET plumb_random123 HEADER Random123/philox.h DEBIAN librandom123-dev)
  add_library(plumb_scenario STATIC ${scenario_sources})
  plumb_library(plumb_scenario scenario)
  target_link_libraries(plumb_scenario PUBLIC plumb_24 PRIVATE "$<BUILD_INTERFACE:plumb_random123>")
  plumb_batch(plumb_scenario)
endif()

plumb_sources(study_sources study)
if(study_sources)
  plumb_find_package(Boost DEBIAN libboost-dev TARGET Boost::headers)
  add_library(plumb_study STATIC ${study_sources})
  plumb_library(plumb_study study)
  plumb_with_eigen(plumb_study)
  target_link_libraries(plumb_study PUBLIC plumb_paper plumb_scenario plumb_24 PRIVATE "$<BUILD_INTERFACE:Boost::headers>")
  plumb_batch(plumb_study)
endif()

# What a monitor of motion is configured with, from a recording in motion.
plumb_sources(commission_sources commission)
if(commission_sources)
  add_library(plumb_commission STATIC ${commission_sources})
  plumb_library(plumb_commission commission)
  plumb_with_eigen(plumb_commission)
  target_link_libraries(plumb_commission PUBLIC plumb_24)
  plumb_batch(plumb_commission)
endif()

plumb_sources(io_sources io)
if(io_sources)
  plumb_find_package(toml11 DEBIAN libtoml11-dev TARGET toml11::toml11)
  plumb_find_package(nlohmann_json DEBIAN nlohmann-json3-dev TARGET nlohmann_json::nlohmann_json)
  plumb_find_package(fmt DEBIAN libfmt-dev TARGET fmt::fmt)
  add_library(plumb_io STATIC ${io_sources})
  plumb_library(plumb_io io)
  plumb_find_package(Boost DEBIAN libboost-dev TARGET Boost::headers)
  plumb_find_header(TARGET plumb_deflate HEADER libdeflate.h DEBIAN libdeflate-dev)
  target_link_libraries(plumb_io PUBLIC plumb_paper plumb_24 toml11::toml11 nlohmann_json::nlohmann_json fmt::fmt
    PRIVATE "$<BUILD_INTERFACE:Boost::headers>" "$<BUILD_INTERFACE:plumb_deflate>" deflate)
  if(TARGET plumb_scenario)
    target_link_libraries(plumb_io PUBLIC plumb_scenario)
  endif()
  plumb_batch(plumb_io)
endif()

# What users test their own arrays with. The library itself needs neither RapidCheck nor GoogleTest: its headers do.
plumb_sources(testing_sources testing)
if(testing_sources)
  add_library(plumb_testing STATIC ${testing_sources})
  plumb_library(plumb_testing testing)
  target_link_libraries(plumb_testing PUBLIC plumb_io plumb_scenario plumb_24
    "$<INSTALL_INTERFACE:rapidcheck>" "$<INSTALL_INTERFACE:GTest::gtest>")
endif()

# The inner loop of a campaign with the monitors for 4, 8 and 24 sensors: four sensors are stepped by the monitor for four.
# That for 16 is left out: copying it back to its start costs as much as copying the one for 24.
set(PLUMB_KERNELS ${PLUMB_CAPACITIES})
list(REMOVE_ITEM PLUMB_KERNELS 16)
plumb_sources(kernel_sources campaign/kernel)
if(TARGET plumb_scenario)
  set(kernel_scenario_sources ${scenario_sources})
  list(FILTER kernel_scenario_sources INCLUDE REGEX
    "/(attitude|delivery|fault|fault_kinds|fault_words|injector|instability|noise|random|truth)\\.cpp$")
  foreach(capacity IN LISTS PLUMB_KERNELS)
    if(capacity EQUAL 24)
      add_library(plumb_campaign_${capacity} STATIC ${kernel_sources})
      target_link_libraries(plumb_campaign_${capacity} PUBLIC plumb_scenario)
    else()
      # The scenario room once more, for this capacity: it stands in another namespace.
      add_library(plumb_campaign_${capacity} STATIC ${kernel_sources} ${kernel_scenario_sources})
      target_link_libraries(plumb_campaign_${capacity} PUBLIC plumb_${capacity}
        PRIVATE "$<BUILD_INTERFACE:plumb_random123>")
    endif()
    plumb_library(plumb_campaign_${capacity} campaign_${capacity})
    if(NOT capacity EQUAL 24)
      plumb_precompile(plumb_campaign_${capacity} ${PLUMB_COMMON_HEADERS} <string> <vector>)
    endif()
  endforeach()
endif()

# Logs of other programs.
plumb_sources(logs_sources logs)
if(TARGET plumb_io AND logs_sources)
  add_library(plumb_logs STATIC ${logs_sources})
  plumb_library(plumb_logs logs)
  plumb_find_header(TARGET plumb_zstd HEADER zstd.h DEBIAN libzstd-dev)
  plumb_find_header(TARGET plumb_lz4 HEADER lz4frame.h DEBIAN liblz4-dev)
  plumb_find_header(TARGET plumb_sqlite3 HEADER sqlite3.h DEBIAN libsqlite3-dev)
  target_link_libraries(plumb_logs PUBLIC plumb_io plumb_24
    PRIVATE "$<BUILD_INTERFACE:Boost::headers>" "$<BUILD_INTERFACE:plumb_deflate>" deflate
      "$<BUILD_INTERFACE:plumb_zstd>" zstd "$<BUILD_INTERFACE:plumb_lz4>" lz4 "$<BUILD_INTERFACE:plumb_sqlite3>" sqlite3)
  plumb_batch(plumb_logs)
endif()

# What a log says of its accelerometers, without an array file.
plumb_sources(review_sources review)
if(TARGET plumb_logs AND review_sources)
  add_library(plumb_review STATIC ${review_sources})
  plumb_library(plumb_review review)
  target_link_libraries(plumb_review PUBLIC plumb_logs)
  plumb_batch(plumb_review)
endif()

# What noise a log at rest shows.
plumb_sources(noise_sources noise)
if(TARGET plumb_io AND noise_sources)
  add_library(plumb_noise STATIC ${noise_sources})
  plumb_library(plumb_noise noise)
  plumb_with_eigen(plumb_noise)
  target_link_libraries(plumb_noise PUBLIC plumb_io plumb_24 PRIVATE "$<BUILD_INTERFACE:Boost::headers>")
  plumb_batch(plumb_noise)
endif()

# The Earth's magnetic field at a place and a date.
plumb_sources(geomagnetic_sources geomagnetic)
if(TARGET plumb_io AND geomagnetic_sources)
  add_library(plumb_geomagnetic STATIC ${geomagnetic_sources})
  plumb_library(plumb_geomagnetic geomagnetic)
  target_link_libraries(plumb_geomagnetic PUBLIC plumb_io plumb_24 PRIVATE fmt::fmt)
  plumb_batch(plumb_geomagnetic)
endif()

# Inclination, azimuth and path of a tool with accelerometers and magnetometers, checked against gravity and field.
plumb_sources(survey_sources survey)
if(TARGET plumb_geomagnetic AND survey_sources)
  add_library(plumb_survey STATIC ${survey_sources})
  plumb_library(plumb_survey survey)
  plumb_with_eigen(plumb_survey)
  target_link_libraries(plumb_survey PUBLIC plumb_geomagnetic plumb_24 PRIVATE fmt::fmt "$<BUILD_INTERFACE:Boost::headers>")
  plumb_batch(plumb_survey)
endif()

# Coefficients that others have found, and calibrations in the forms of others.
plumb_sources(coefficients_sources coefficients)
if(TARGET plumb_io AND coefficients_sources)
  add_library(plumb_coefficients STATIC ${coefficients_sources})
  plumb_library(plumb_coefficients coefficients)
  target_compile_definitions(plumb_coefficients PRIVATE PLUMB_VERSION="${PROJECT_VERSION}")  # in what it writes
  target_link_libraries(plumb_coefficients PUBLIC plumb_io plumb_24)
  plumb_batch(plumb_coefficients)
endif()

# What is wrong with an array, a recording or a fit.
plumb_sources(findings_sources findings)
if(TARGET plumb_io AND findings_sources)
  add_library(plumb_findings STATIC ${findings_sources})
  plumb_library(plumb_findings findings)
  plumb_with_eigen(plumb_findings)
  target_link_libraries(plumb_findings PUBLIC plumb_io plumb_paper plumb_24)
  plumb_batch(plumb_findings)
  plumb_optimise_less(plumb_findings)
endif()

# From an array file, a calibration and a log to verdicts: what the tool, the Python module and the benchmarks share.
plumb_sources(session_sources session)
if(TARGET plumb_io AND session_sources)
  plumb_find_package(Threads DEBIAN libc6-dev TARGET Threads::Threads)
  add_library(plumb_session STATIC ${session_sources})
  plumb_library(plumb_session session)
  plumb_with_eigen(plumb_session)
  target_compile_definitions(plumb_session PRIVATE PLUMB_VERSION="${PROJECT_VERSION}")  # in what it writes
  target_link_libraries(plumb_session PUBLIC plumb_findings plumb_commission plumb_io plumb_scenario plumb_24 fmt::fmt Threads::Threads)
  set_source_files_properties("${PROJECT_SOURCE_DIR}/src/session/steppers.cpp"
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # macros of its own
  plumb_batch(plumb_session)
  plumb_optimise_less(plumb_session)

  # What steps the rows of a log, with the monitors for 4, 8 and 24 sensors. By path: a target would hand its capacity on.
  plumb_sources(stepper_sources session/kernel)
  foreach(capacity IN LISTS PLUMB_KERNELS)
    add_library(plumb_stepper_${capacity} STATIC ${stepper_sources})
    plumb_library(plumb_stepper_${capacity} stepper_${capacity})
    target_link_libraries(plumb_stepper_${capacity} PUBLIC plumb_${capacity})
    target_link_libraries(plumb_session PUBLIC "$<LINK_ONLY:plumb_stepper_${capacity}>")
    set_property(SOURCE "${PROJECT_SOURCE_DIR}/src/session/steppers.cpp" APPEND PROPERTY
      COMPILE_DEFINITIONS PLUMB_BUILT_FOR_${capacity})
  endforeach()
endif()

# Campaigns with the kernels of all capacities, those but the host's by path: a target would hand its capacity on to the
# sources of the host.
plumb_sources(campaign_sources campaign)
if(TARGET plumb_study AND TARGET plumb_io AND campaign_sources)
  plumb_find_package(Threads DEBIAN libc6-dev TARGET Threads::Threads)
  add_library(plumb_campaign STATIC ${campaign_sources})
  plumb_library(plumb_campaign campaign)
  target_link_libraries(plumb_campaign PUBLIC plumb_campaign_24 plumb_study plumb_io fmt::fmt Threads::Threads)
  foreach(capacity IN LISTS PLUMB_KERNELS)
    if(NOT capacity EQUAL 24)
      target_link_libraries(plumb_campaign PUBLIC "$<LINK_ONLY:plumb_campaign_${capacity}>")
    endif()
    target_compile_definitions(plumb_campaign PRIVATE PLUMB_BUILT_FOR_${capacity})
  endforeach()
  plumb_batch(plumb_campaign)
  plumb_optimise_less(plumb_campaign)
endif()

# What an array is judged by, and the health of a tool over a run: figures and results, in no format.
plumb_sources(verification_sources verification)
if(TARGET plumb_campaign AND verification_sources)
  add_library(plumb_verification STATIC ${verification_sources})
  plumb_library(plumb_verification verification)
  target_link_libraries(plumb_verification PUBLIC plumb_campaign plumb_io fmt::fmt)
  plumb_batch(plumb_verification)
  plumb_optimise_less(plumb_verification)
endif()

plumb_sources(render_sources render)
if(TARGET plumb_session AND TARGET plumb_verification AND render_sources)
  plumb_find_header(TARGET plumb_mustache HEADER kainjow/mustache.hpp DEBIAN libkainjow-mustache-dev)
  plumb_find_package(fmt DEBIAN libfmt-dev TARGET fmt::fmt)
  add_library(plumb_render STATIC ${render_sources})
  plumb_library(plumb_render render)
  plumb_with_eigen(plumb_render)
  target_link_libraries(plumb_render PUBLIC plumb_session plumb_coefficients plumb_findings plumb_noise plumb_review plumb_survey plumb_verification plumb_study plumb_io fmt::fmt
    PRIVATE "$<BUILD_INTERFACE:plumb_mustache>" "$<BUILD_INTERFACE:Boost::headers>")
  plumb_batch(plumb_render)
  plumb_optimise_less(plumb_render)
  include(PlumbVerification)
endif()
