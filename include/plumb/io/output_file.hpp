/// Output that says so when it cannot be written, and that never leaves half a result behind.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class OutputFile {
 public:
  enum class Mode : std::uint8_t {
    whole,   ///< written beside the target and renamed by `commit`; without commit nothing appears
    stream,  ///< written in place: what was written before an interruption stays
  };

  /// "-" is standard output (always a stream).
  static FileExpected<OutputFile> create(const std::string& path, Mode mode);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  FileExpected<void> write(std::string_view text);
  FileExpected<void> flush();
  /// Flushes, closes, and in Mode::whole puts the file in its place.
  FileExpected<void> commit();
  const std::string& path() const noexcept { return path_; }

 private:
  OutputFile() = default;
  void close_quietly() noexcept;
  FileError failure(const char* doing, int error_number) const;

  std::string path_;
  std::string place_;      ///< where the path leads through links: what is replaced
  std::string temporary_;  ///< empty in Mode::stream
  std::string buffer_;
  int descriptor_ = -1;
};

/// The whole text, in one step.
FileExpected<void> write_file(const std::string& path, std::string_view text);
/// The whole file as text; "-" is not accepted. Errors: unreadable, a directory, larger than 256 MiB.
FileExpected<std::string> read_file(const std::string& path);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
