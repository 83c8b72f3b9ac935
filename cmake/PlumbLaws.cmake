# The laws of isolation over a hundred thousand cases each (tests/laws).

plumb_test_executable(plumb_law_tests LABEL law ROOMS laws LIBRARIES plumb_8)
