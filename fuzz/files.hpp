/// For harnesses of files.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>
#include <utility>

#include "common.hpp"
#include "plumb/io/array_file.hpp"

namespace fuzz {

/// A file that lives in memory: readers take paths.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("plumb-fuzz", 0)) {
    demand(fd_ >= 0 && write(fd_, data, size) == static_cast<ssize_t>(size), "a file in memory");
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { close(fd_); }
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

/// Every refusal says what is wrong, and is one that a message can be made of.
inline void demand_told(const plumb::io::FileError& error) {
  demand(!error.what.empty(), "a refusal says what is wrong");
  demand(error.text().size() < 200000, "a refusal can be read");
}

/// The paper's tool from the examples, read once.
inline const plumb::io::ArrayFile& paper_tool() {
  static const plumb::io::ArrayFile tool = [] {
    auto read = plumb::io::read_array_file(PLUMB_SOURCE_DIR "/examples/paper_tool.toml");
    demand(read.has_value(), "examples/paper_tool.toml can be read");
    return std::move(*read);
  }();
  return tool;
}

}  // namespace fuzz
