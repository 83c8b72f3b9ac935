# How every target of plumb is compiled. Third-party headers are SYSTEM (imported targets are by default).

set(PLUMB_WARNINGS
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wold-style-cast
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -Werror)

if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  list(APPEND PLUMB_WARNINGS -Wnull-dereference)  # GCC's at -O2 reports false positives through inlined Eigen
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  list(APPEND PLUMB_WARNINGS -Wno-maybe-uninitialized)  # GCC's manual: false positives under sanitizers
endif()

# plumb_compile_settings(TARGET): C++17 without extensions, warnings as errors, no fused multiply-add
# contraction (results must not depend on the compiler's choice of instructions, and the rounding that proofs/ bounds
# is that of separate multiplications and additions). Nobody reads errno or the floating-point flags: without that promise
# the compiler may not take a root, or choose by a comparison, for several triples at once.
function(plumb_compile_settings target)
  target_compile_features(${target} PUBLIC cxx_std_17)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  if(NOT CMAKE_SYSTEM_NAME STREQUAL "Generic")  # without an operating system nobody would fill the table of addresses
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_compile_options(${target} PUBLIC -ffp-contract=off PRIVATE -fno-math-errno -fno-trapping-math ${PLUMB_WARNINGS})
endfunction()
