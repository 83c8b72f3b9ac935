/// FNV-1a, 64 bit: tells whether bytes changed by accident. No protection against intent.
#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::uint64_t kFnvStart = 14695981039346656037ULL;

/// Hash of the bytes, going on from `start`, so that a stream may be hashed piece by piece.
std::uint64_t fnv1a(const void* data, std::size_t size, std::uint64_t start = kFnvStart) noexcept;

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
