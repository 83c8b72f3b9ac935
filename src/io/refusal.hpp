/// How a FileError travels inside io (private to src/io): the public functions catch it at the boundary.
#pragma once

#include <exception>
#include <utility>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class Refusal : public std::exception {
 public:
  explicit Refusal(FileError error) : error_(std::move(error)) {}
  const FileError& error() const noexcept { return error_; }
  const char* what() const noexcept override { return error_.what.c_str(); }

 private:
  FileError error_;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
