#include "plumb/io/mapped_file.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kWindow = 1U << 22U;

/// 0 for what is no regular file.
std::uint64_t size_of(const boost::interprocess::file_mapping& file) noexcept {
  struct stat status {};
  const int descriptor = file.get_mapping_handle().handle;
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return 0;
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

bool MappedFile::open(const std::string& path) {
  // Asked before it is opened: to open a pipe a second time would wait for another writer, and take its bytes.
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  try {
    file_ = boost::interprocess::file_mapping(path.c_str(), boost::interprocess::read_only);
  } catch (const boost::interprocess::interprocess_exception&) {
    return false;
  }
  size_ = size_of(file_);
  return size_ > 0;
}

const unsigned char* MappedFile::at(std::uint64_t offset, std::size_t count) {
  if (offset > size_ || count > size_ - offset) return nullptr;
  if (offset < begin_ || offset - begin_ + count > window_.get_size()) {
    size_ = std::min(size_, size_of(file_));
    if (offset > size_ || count > size_ - offset) return nullptr;
    try {
      window_ = boost::interprocess::mapped_region();  // the old one goes before the new one comes
      const std::uint64_t rest = size_ - offset;
      window_ = boost::interprocess::mapped_region(
          file_, boost::interprocess::read_only, static_cast<boost::interprocess::offset_t>(offset),
          static_cast<std::size_t>(std::min<std::uint64_t>(rest, std::max(kWindow, count))));
    } catch (const boost::interprocess::interprocess_exception&) {
      return nullptr;
    }
    begin_ = offset;
    (void)window_.advise(boost::interprocess::mapped_region::advice_sequential);
  }
  return static_cast<const unsigned char*>(window_.get_address()) + (offset - begin_);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
