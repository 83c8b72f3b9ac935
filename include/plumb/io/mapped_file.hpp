/// A file in memory, a window at a time: what is mapped stays small however long the file is.
#pragma once

#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class MappedFile {
 public:
  /// False where `path` is no regular file, or cannot be mapped.
  bool open(const std::string& path);
  std::uint64_t size() const noexcept { return size_; }
  /// `count` bytes from `offset` on, valid until the next call; null where the file has none there (any more), or the
  /// system refuses. Who cuts a file short while it is mapped ends the program: that is how mappings are.
  const unsigned char* at(std::uint64_t offset, std::size_t count);

 private:
  boost::interprocess::file_mapping file_;
  boost::interprocess::mapped_region window_;
  std::uint64_t begin_ = 0;
  std::uint64_t size_ = 0;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
