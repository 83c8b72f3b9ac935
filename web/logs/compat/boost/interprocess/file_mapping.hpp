/// Boost maps a file into memory; in a browser no file can be mapped. This header stands before Boost's own and reads
/// the window instead: as much of Boost.Interprocess as plumb/io/mapped_file.hpp uses.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <exception>
#include <utility>

namespace boost {
namespace interprocess {

using offset_t = long long;

enum mode_t { read_only };

class interprocess_exception : public std::exception {};

class file_mapping {
 public:
  struct Handle {
    int handle;
  };

  file_mapping() = default;
  file_mapping(const char* path, mode_t) : descriptor_(::open(path, O_RDONLY)) {
    if (descriptor_ < 0) throw interprocess_exception();
  }
  file_mapping(file_mapping&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  file_mapping& operator=(file_mapping&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~file_mapping() {
    if (descriptor_ >= 0) (void)::close(descriptor_);
  }

  Handle get_mapping_handle() const noexcept { return {descriptor_}; }

 private:
  int descriptor_ = -1;
};

}  // namespace interprocess
}  // namespace boost
