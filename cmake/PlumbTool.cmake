# The command line tool: target plumb_tool, executable plumb. What its commands do is a library (not installed), for the
# Python module does the same.

plumb_sources(cli_sources cli)
if(cli_sources)
  plumb_find_package(CLI11 DEBIAN libcli11-dev TARGET CLI11::CLI11)
  plumb_find_package(fmt DEBIAN libfmt-dev TARGET fmt::fmt)
  plumb_find_package(Boost DEBIAN libboost-dev TARGET Boost::headers)
  plumb_find_package(Threads DEBIAN libc6-dev TARGET Threads::Threads)

  list(REMOVE_ITEM cli_sources "${PROJECT_SOURCE_DIR}/src/cli/main.cpp")
  add_library(plumb_cli STATIC ${cli_sources})
  plumb_compile_settings(plumb_cli)
  target_include_directories(plumb_cli INTERFACE "${PROJECT_SOURCE_DIR}/src/cli")
  target_compile_definitions(plumb_cli PUBLIC PLUMB_VERSION="${PROJECT_VERSION}")
  foreach(library IN ITEMS plumb_report plumb_io plumb_study plumb_scenario plumb_24)
    if(TARGET ${library})
      target_link_libraries(plumb_cli PUBLIC ${library})
    endif()
  endforeach()
  target_link_libraries(plumb_cli PUBLIC fmt::fmt Boost::headers Threads::Threads PRIVATE CLI11::CLI11)

  set_source_files_properties("${PROJECT_SOURCE_DIR}/src/cli/options.cpp" "${PROJECT_SOURCE_DIR}/src/cli/steppers.cpp"
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # a large header; macros of their own
  plumb_batch(plumb_cli)
  plumb_optimise_less(plumb_cli)

  # What steps the rows of a log, with the monitors for 4, 8 and 24 sensors. By path: a target would hand its capacity on.
  plumb_sources(stepper_sources cli/kernel)
  foreach(capacity IN LISTS PLUMB_KERNELS)
    add_library(plumb_stepper_${capacity} STATIC ${stepper_sources})
    plumb_compile_settings(plumb_stepper_${capacity})
    target_link_libraries(plumb_stepper_${capacity} PUBLIC plumb_${capacity})
    target_link_libraries(plumb_cli PUBLIC "$<LINK_ONLY:plumb_stepper_${capacity}>")
    set_property(SOURCE "${PROJECT_SOURCE_DIR}/src/cli/steppers.cpp" APPEND PROPERTY
      COMPILE_DEFINITIONS PLUMB_STEPPER_${capacity})
  endforeach()

  add_executable(plumb_tool "${PROJECT_SOURCE_DIR}/src/cli/main.cpp")
  set_target_properties(plumb_tool PROPERTIES OUTPUT_NAME plumb)
  plumb_compile_settings(plumb_tool)
  target_link_libraries(plumb_tool PRIVATE plumb_cli)
  if(NOT CMAKE_CROSSCOMPILING)  # the tool prints its own manual page and completion
    add_custom_command(TARGET plumb_tool POST_BUILD
      COMMAND plumb_tool --man > "${PROJECT_BINARY_DIR}/plumb.1"
      COMMAND plumb_tool --completion > "${PROJECT_BINARY_DIR}/plumb.bash"
      COMMAND plumb_tool --completion-zsh > "${PROJECT_BINARY_DIR}/plumb.zsh"
      COMMAND plumb_tool --completion-fish > "${PROJECT_BINARY_DIR}/plumb.fish"
      VERBATIM)
  endif()
endif()

# The campaign over the ranks of an MPI job, where there is MPI.
if(TARGET plumb_report AND NOT PLUMB_BUILD_MPI)
  plumb_leaves_out("plumb-campaign-mpi" "PLUMB_BUILD_MPI is OFF")
elseif(TARGET plumb_report)
  find_package(MPI QUIET COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    add_executable(plumb_campaign_mpi
      src/mpi/campaign_mpi.cpp src/cli/campaign_run.cpp src/cli/options.cpp src/cli/tool.cpp)
    set_target_properties(plumb_campaign_mpi PROPERTIES OUTPUT_NAME plumb-campaign-mpi)
    plumb_compile_settings(plumb_campaign_mpi)
    target_compile_definitions(plumb_campaign_mpi PRIVATE PLUMB_VERSION="${PROJECT_VERSION}" OMPI_SKIP_MPICXX)
    target_link_libraries(plumb_campaign_mpi PRIVATE plumb_report CLI11::CLI11 fmt::fmt MPI::MPI_CXX)
  else()
    plumb_leaves_out("plumb-campaign-mpi" "no MPI was found (Debian package libopenmpi-dev)")
  endif()
endif()
