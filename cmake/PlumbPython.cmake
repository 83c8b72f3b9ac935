# The Python module: target plumb_python, file plumb.<tag>.so in <build>/python. Built where Python's headers, numpy and
# pybind11 are found; PLUMB_BUILD_PYTHON=ON insists on them, OFF leaves it out.
#
# The interpreter is Debian's, /usr/bin/python3, unless -DPython_EXECUTABLE names another: the packages that are found
# below belong to it.
set(PLUMB_BUILD_PYTHON AUTO CACHE STRING "Build the Python module: AUTO (where its packages are found), ON or OFF")
set_property(CACHE PLUMB_BUILD_PYTHON PROPERTY STRINGS AUTO ON OFF)
if(NOT TARGET plumb_session OR NOT TARGET plumb_render OR CMAKE_CXX_FLAGS MATCHES "-fsanitize")  # a sanitizer has to be there first
  return()
endif()
if(NOT PLUMB_BUILD_PYTHON)
  plumb_leaves_out("the Python module" "PLUMB_BUILD_PYTHON is OFF")
  return()
endif()

# plumb_without_python(WHAT PACKAGE): no module, or no build where it was asked for.
macro(plumb_without_python what package)
  if(NOT PLUMB_BUILD_PYTHON STREQUAL "AUTO")
    plumb_missing("${what} (PLUMB_BUILD_PYTHON=${PLUMB_BUILD_PYTHON})" "${package}")
  endif()
  plumb_leaves_out("the Python module" "${what} not found (Debian: apt-get install ${package})")
  return()
endmacro()

if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python interpreter")
endif()
find_package(Python QUIET COMPONENTS Interpreter Development.Module NumPy)
if(NOT Python_FOUND)
  plumb_without_python("Python with its headers and numpy" "python3-dev python3-numpy")
endif()
find_package(pybind11 CONFIG QUIET)
if(NOT TARGET pybind11::module)
  plumb_without_python("pybind11" pybind11-dev)
endif()

file(GLOB python_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/python/*.cpp")
pybind11_add_module(plumb_python MODULE NO_EXTRAS ${python_sources})
set_target_properties(plumb_python PROPERTIES
  OUTPUT_NAME plumb LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/python")
plumb_compile_settings(plumb_python)
target_compile_definitions(plumb_python PRIVATE PLUMB_VERSION="${PROJECT_VERSION}")
target_link_libraries(plumb_python PRIVATE plumb_session plumb_render)
# Nothing of the libraries inside is to be seen beside other modules of a notebook.
target_link_options(plumb_python PRIVATE -Wl,--exclude-libs,ALL)
