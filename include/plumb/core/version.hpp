/// The version of plumb, as a number that can be written into files and compared.
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// major * 2^16 + minor * 2^8 + patch. The project's version in CMakeLists.txt (a test compares the two).
inline constexpr std::uint32_t kLibraryVersion = 0x01'00'00U;

}  // namespace PLUMB_ABI
}  // namespace plumb
