# cmake --install: headers, libraries, tool, licence, and the package plumb for find_package(plumb CONFIG).
#   find_package(plumb CONFIG)                  -> plumb::plumb (8 sensors), plumb::plumb_4, _8, _16, _24;
#                                                  plumb::c (the C functions, 8 sensors), plumb::c_4, _8, _16, _24
#   find_package(plumb CONFIG COMPONENTS paper) -> plumb::paper, the paper's algorithm to compare with (24 sensors)
#   find_package(plumb CONFIG COMPONENTS host)  -> plumb::paper, scenario, study, commission, io, logs, coefficients, geomagnetic, survey, noise, findings, session, campaign,
#                                                  verification, render as well
#   find_package(plumb CONFIG COMPONENTS testing) -> plumb::testing, with RapidCheck and GoogleTest
#   pkg-config plumb, plumb-4, ...; plumb-c, plumb-c-4, ...; plumb-paper   -> the same libraries without CMake
#   cpack -G DEB                                              -> a Debian package of all of it

include(CMakePackageConfigHelpers)
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/plumb")

set(core_targets ${PLUMB_CAPACITIES})
list(TRANSFORM core_targets PREPEND plumb_)
set(c_targets ${PLUMB_CAPACITIES})
list(TRANSFORM c_targets PREPEND plumb_c_)
install(TARGETS ${core_targets} ${c_targets} EXPORT plumbTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT plumbTargets NAMESPACE plumb:: DESTINATION "${package_dir}")
set(rooms ${PLUMB_CORE_ROOMS} c)

if(TARGET plumb_paper)
  install(TARGETS plumb_paper EXPORT plumbPaperTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(EXPORT plumbPaperTargets NAMESPACE plumb:: DESTINATION "${package_dir}")
  list(APPEND rooms paper)
endif()

set(PLUMB_INSTALLED_HOST FALSE)
foreach(name IN ITEMS scenario study commission io logs coefficients geomagnetic survey review noise findings session campaign verification render)
  if(TARGET plumb_${name})
    install(TARGETS plumb_${name} EXPORT plumbHostTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
    list(APPEND rooms ${name})
    set(PLUMB_INSTALLED_HOST TRUE)
  endif()
endforeach()
foreach(capacity IN LISTS PLUMB_CAPACITIES)
  foreach(inner IN ITEMS campaign stepper)  # inner loops, one a capacity
    if(TARGET plumb_${inner}_${capacity})
      install(TARGETS plumb_${inner}_${capacity} EXPORT plumbHostTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
    endif()
  endforeach()
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
  if(NOT CMAKE_CROSSCOMPILING)
    install(FILES "${PROJECT_BINARY_DIR}/plumb.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
    install(FILES "${PROJECT_BINARY_DIR}/plumb.bash" RENAME plumb
      DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions")
    install(FILES "${PROJECT_BINARY_DIR}/plumb.zsh" RENAME _plumb
      DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions")
    install(FILES "${PROJECT_BINARY_DIR}/plumb.fish" DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d")
  endif()
  if(TARGET plumb_campaign_mpi)
    install(TARGETS plumb_campaign_mpi RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  endif()
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

# --- pkg-config: relative to where the file lies, so that the tree may be moved. ------------------------------------
file(RELATIVE_PATH PLUMB_PC_TO_PREFIX "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
# plumb_pkg_config(NAME TEXT FLAGS LIBS)
function(plumb_pkg_config PLUMB_PC_NAME PLUMB_PC_TEXT PLUMB_PC_CFLAGS PLUMB_PC_LIBS)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/plumb.pc.in" "${CMAKE_CURRENT_BINARY_DIR}/${PLUMB_PC_NAME}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${PLUMB_PC_NAME}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endfunction()
set(left_out "")
foreach(definition IN LISTS PLUMB_LEFT_OUT)
  string(APPEND left_out " -D${definition}")
endforeach()
foreach(capacity IN LISTS PLUMB_CAPACITIES)
  set(names "-${capacity}")
  if(capacity EQUAL 8)
    list(APPEND names "")
  endif()
  foreach(suffix IN LISTS names)
    plumb_pkg_config("plumb${suffix}" "${PROJECT_DESCRIPTION}, up to ${capacity} sensors"
      "-DPLUMB_CAPACITY=${capacity}${left_out} -ffp-contract=off" "-lplumb_${capacity}")
    plumb_pkg_config("plumb-c${suffix}" "${PROJECT_DESCRIPTION}, functions for C, up to ${capacity} sensors"
      "-DPLUMB_CAPACITY=${capacity}" "-lplumb_c_${capacity} -lplumb_${capacity}")
  endforeach()
endforeach()
if(TARGET plumb_paper)
  plumb_pkg_config("plumb-paper" "The paper's algorithm, to compare plumb with, up to 24 sensors"
    "-DPLUMB_CAPACITY=24 -ffp-contract=off" "-lplumb_paper -lplumb_24")
endif()

# --- A Debian package. The libraries are static: what a program needs is in it, and the headers need two packages. ----
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)  # cpack packs what was built
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_NAME plumb)
  set(CPACK_PACKAGE_CONTACT "the authors of plumb <plumb@localhost>")
  set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
  set(CPACK_PACKAGING_INSTALL_PREFIX "/usr")
  set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_PACKAGE_DEPENDS "libc6, libstdc++6, libgcc-s1, libexpected-dev")
  if(PLUMB_INSTALLED_HOST)
    string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", libfmt9, libfmt-dev, libdeflate-dev, libzstd-dev, liblz4-dev, libsqlite3-dev, libtoml11-dev, nlohmann-json3-dev")
  endif()
  include(CPack)
endif()
