/// See file_mapping.hpp beside it.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <vector>

#include "boost/interprocess/file_mapping.hpp"

namespace boost {
namespace interprocess {

class mapped_region {
 public:
  enum advice_types { advice_sequential };

  mapped_region() = default;
  mapped_region(const file_mapping& file, mode_t, offset_t offset, std::size_t size) : bytes_(size) {
    for (std::size_t done = 0; done < size;) {
      const ssize_t count = ::pread(file.get_mapping_handle().handle, bytes_.data() + done, size - done,
                                    static_cast<off_t>(offset) + static_cast<off_t>(done));
      if (count <= 0) throw interprocess_exception();
      done += static_cast<std::size_t>(count);
    }
  }

  void* get_address() const noexcept { return const_cast<unsigned char*>(bytes_.data()); }
  std::size_t get_size() const noexcept { return bytes_.size(); }
  bool advise(advice_types) noexcept { return true; }

 private:
  std::vector<unsigned char> bytes_;
};

}  // namespace interprocess
}  // namespace boost
