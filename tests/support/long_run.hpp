/// What only `scripts/test --long` runs in full.
#pragma once

#include <cstdlib>

namespace plumb_test {

/// True where the environment asks for the tests that take minutes (PLUMB_LONG=1).
inline bool long_run() {
  const char* asked = std::getenv("PLUMB_LONG");
  return asked != nullptr && asked[0] == '1';
}

}  // namespace plumb_test
