/// Packed bytes, unpacked within a bound (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// Takes memory as it is filled, never more than `most`: a size that is only stated costs nothing.
class Unpacker {
 public:
  enum class Outcome : std::uint8_t {
    whole,     ///< ended where the packed bytes did
    cut,       ///< the packed bytes ended within it; what was unpacked until then is right
    too_long,  ///< more than `most`
    damaged,
    unknown,  ///< another way of packing
    failed,   ///< no memory for the library
  };

  /// `method` is "zstd" or "lz4" (frames).
  Outcome unpack(std::string_view method, const unsigned char* packed, std::size_t size, std::size_t most);
  const unsigned char* data() const noexcept { return out_.data(); }
  std::size_t size() const noexcept { return size_; }

 private:
  Outcome zstd(const unsigned char* packed, std::size_t size, std::size_t most);
  Outcome lz4(const unsigned char* packed, std::size_t size, std::size_t most);
  std::size_t room(std::size_t most);

  std::vector<unsigned char> out_;
  std::size_t size_ = 0;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
