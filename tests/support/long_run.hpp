/// What only `scripts/test --long` runs in full.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace plumb_test {

/// True where the environment asks for the tests that take minutes (PLUMB_LONG=1).
inline bool long_run() {
  const char* asked = std::getenv("PLUMB_LONG");
  if (asked == nullptr || std::strcmp(asked, "") == 0 || std::strcmp(asked, "0") == 0) return false;
  if (std::strcmp(asked, "1") == 0) return true;
  std::fprintf(stderr, "PLUMB_LONG is \"%s\": set it to 1 for the long run, or leave it away\n", asked);
  std::exit(2);
}

}  // namespace plumb_test
