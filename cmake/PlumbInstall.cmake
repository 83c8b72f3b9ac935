# cmake --install: headers, libraries, tool, licence, and the package plumb for find_package(plumb CONFIG).
#   find_package(plumb CONFIG)                  -> plumb::plumb (8 sensors), plumb::plumb_4, _8, _16, _24;
#                                                  plumb::c (the C functions, 8 sensors), plumb::c_4, _8, _16, _24
#   find_package(plumb CONFIG COMPONENTS host)  -> plumb::scenario, plumb::study, plumb::io, plumb::report as well
#   find_package(plumb CONFIG COMPONENTS testing) -> plumb::testing, with RapidCheck and GoogleTest

include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/plumb")

set(core_targets ${PLUMB_CAPACITIES})
list(TRANSFORM core_targets PREPEND plumb_)
set(c_targets ${PLUMB_CAPACITIES})
list(TRANSFORM c_targets PREPEND plumb_c_)
install(TARGETS ${core_targets} ${c_targets} EXPORT plumbTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT plumbTargets NAMESPACE plumb:: DESTINATION "${package_dir}")
set(rooms ${PLUMB_CORE_ROOMS} c)

set(PLUMB_INSTALLED_HOST FALSE)
foreach(name IN ITEMS scenario study io report)
  if(TARGET plumb_${name})
    install(TARGETS plumb_${name} EXPORT plumbHostTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
    list(APPEND rooms ${name})
    set(PLUMB_INSTALLED_HOST TRUE)
  endif()
endforeach()
if(PLUMB_INSTALLED_HOST)
  install(EXPORT plumbHostTargets NAMESPACE plumb:: DESTINATION "${package_dir}")
endif()

if(TARGET plumb_testing)
  install(TARGETS plumb_testing EXPORT plumbTestingTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(EXPORT plumbTestingTargets NAMESPACE plumb:: DESTINATION "${package_dir}")
  list(APPEND rooms testing)
endif()

foreach(room IN LISTS rooms)
  if(IS_DIRECTORY "${PROJECT_SOURCE_DIR}/include/plumb/${room}")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/include/plumb/${room}"
      DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/plumb"
      FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
  endif()
endforeach()

if(TARGET plumb_tool)
  install(TARGETS plumb_tool RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endif()

install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/NOTICE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")

configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/plumbConfig.cmake.in"
  "${CMAKE_CURRENT_BINARY_DIR}/plumbConfig.cmake" INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/plumbConfigVersion.cmake"
  COMPATIBILITY SameMajorVersion)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/plumbConfig.cmake"
  "${CMAKE_CURRENT_BINARY_DIR}/plumbConfigVersion.cmake"
  DESTINATION "${package_dir}")
