# The programs: the tool (target plumb_tool, executable plumb), and the campaign over the ranks of an MPI job. None of what
# they are made of is a library for others: what they call is.

# What both have of a command line: options, messages, and the campaign.
plumb_sources(command_sources command)
if(TARGET plumb_render AND TARGET plumb_session AND command_sources)
  plumb_find_package(CLI11 DEBIAN libcli11-dev TARGET CLI11::CLI11)
  plumb_find_package(fmt DEBIAN libfmt-dev TARGET fmt::fmt)
  add_library(plumb_command STATIC ${command_sources})
  plumb_compile_settings(plumb_command)
  target_link_libraries(plumb_command PUBLIC plumb_session plumb_render plumb_io fmt::fmt PRIVATE CLI11::CLI11)
  set_source_files_properties("${PROJECT_SOURCE_DIR}/src/command/options.cpp"
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # a large header
  plumb_batch(plumb_command)
  plumb_optimise_less(plumb_command)
endif()

# The commands of the tool are a library, so that they are compiled while its main is; nothing but the tool links it, which
# docs.floors_hold sees to.
plumb_sources(cli_sources cli)
if(TARGET plumb_command AND cli_sources)
  plumb_find_package(Boost DEBIAN libboost-dev TARGET Boost::headers)
  plumb_find_package(Threads DEBIAN libc6-dev TARGET Threads::Threads)

  list(REMOVE_ITEM cli_sources "${PROJECT_SOURCE_DIR}/src/cli/main.cpp")
  add_library(plumb_cli STATIC ${cli_sources})
  plumb_compile_settings(plumb_cli)
  target_compile_definitions(plumb_cli PUBLIC PLUMB_VERSION="${PROJECT_VERSION}")
  foreach(library IN ITEMS plumb_command plumb_session plumb_findings plumb_render plumb_io plumb_study plumb_scenario plumb_24)
    if(TARGET ${library})
      target_link_libraries(plumb_cli PUBLIC ${library})
    endif()
  endforeach()
  target_link_libraries(plumb_cli PUBLIC fmt::fmt Boost::headers Threads::Threads)
  plumb_batch(plumb_cli)
  plumb_optimise_less(plumb_cli)

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
if(TARGET plumb_command AND NOT PLUMB_BUILD_MPI)
  plumb_leaves_out("plumb-campaign-mpi" "PLUMB_BUILD_MPI is OFF")
elseif(TARGET plumb_command)
  find_package(MPI QUIET COMPONENTS CXX)
  if(MPI_CXX_FOUND)
    add_executable(plumb_campaign_mpi src/mpi/campaign_mpi.cpp)
    set_target_properties(plumb_campaign_mpi PROPERTIES OUTPUT_NAME plumb-campaign-mpi)
    plumb_compile_settings(plumb_campaign_mpi)
    target_compile_definitions(plumb_campaign_mpi PRIVATE PLUMB_VERSION="${PROJECT_VERSION}" OMPI_SKIP_MPICXX)
    target_link_libraries(plumb_campaign_mpi PRIVATE plumb_command MPI::MPI_CXX)
  else()
    plumb_leaves_out("plumb-campaign-mpi" "no MPI was found (Debian package libopenmpi-dev)")
  endif()
endif()
