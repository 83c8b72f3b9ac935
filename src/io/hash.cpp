#include "plumb/io/hash.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

std::uint64_t fnv1a(const void* data, std::size_t size, std::uint64_t start) noexcept {
  const auto* bytes = static_cast<const unsigned char*>(data);
  std::uint64_t hash = start;
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 1099511628211ULL;
  return hash;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
