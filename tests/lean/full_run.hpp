/// Knows nothing of plumb's types, which are others in every build.
#pragma once

#include <cstdint>
#include <vector>

namespace lean_test {

std::vector<std::uint64_t> full_run(unsigned& states);

}  // namespace lean_test
