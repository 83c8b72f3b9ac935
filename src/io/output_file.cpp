#include "plumb/io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kBuffer = 1U << 16U;

std::string remedy_for(int error_number) {
  switch (error_number) {
    case ENOENT: return "create the directory first, or choose another path";
    case EACCES:
    case EPERM:
    case EROFS: return "choose a directory that you may write to";
    case EISDIR: return "name a file, not a directory";
    case ENOTDIR: return "a part of the path is a file; choose another path";
    case ENOSPC:
    case EDQUOT: return "free space on the disk, or choose another disk";
    case EPIPE: return "the reader of the pipe has gone; run again without it";
    default: return "choose another path, or mend what the system reports";
  }
}

}  // namespace

FileError OutputFile::failure(const char* doing, int error_number) const {
  FileError error;
  error.file = path_;
  error.what = std::string("cannot ") + doing + ": " + system_message(error_number);
  error.remedy = remedy_for(error_number);
  error.code = ExitCode::other;
  return error;
}

FileExpected<OutputFile> OutputFile::create(const std::string& path, Mode mode) {
  OutputFile file;
  file.path_ = path;
  if (path == "-") {
    file.descriptor_ = STDOUT_FILENO;
    return file;
  }
  struct stat status {};
  const bool exists = ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return tl::unexpected<FileError>(file.failure("write", EISDIR));
  // A device or pipe (/dev/stdout, a fifo) cannot be replaced by renaming: it is written in place.
  const bool replaceable = !exists || S_ISREG(status.st_mode);
  std::string target = path;
  if (mode == Mode::whole && replaceable) target = path + ".part" + std::to_string(::getpid());
  file.descriptor_ = ::open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);  // NOLINT(*-vararg)
  if (file.descriptor_ < 0) return tl::unexpected<FileError>(file.failure("write", errno));
  if (target != path) file.temporary_ = target;
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::exchange(other.buffer_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    close_quietly();
    path_ = std::move(other.path_);
    temporary_ = std::exchange(other.temporary_, {});
    buffer_ = std::exchange(other.buffer_, {});
    descriptor_ = std::exchange(other.descriptor_, -1);
  }
  return *this;
}

OutputFile::~OutputFile() { close_quietly(); }

void OutputFile::close_quietly() noexcept {
  if (descriptor_ < 0) return;
  if (temporary_.empty()) (void)flush();  // what a stream holds is kept, also when leaving by an error
  if (descriptor_ != STDOUT_FILENO) (void)::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) (void)::unlink(temporary_.c_str());
}

FileExpected<void> OutputFile::write(std::string_view text) {
  buffer_.append(text);
  if (buffer_.size() >= kBuffer) return flush();
  return {};
}

FileExpected<void> OutputFile::flush() {
  std::size_t done = 0;
  int error_number = descriptor_ < 0 ? EBADF : 0;
  while (error_number == 0 && done < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + done, buffer_.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EINTR) {
      error_number = errno;
    }
  }
  buffer_.clear();
  if (error_number != 0) return tl::unexpected<FileError>(failure("write", error_number));
  return {};
}

FileExpected<void> OutputFile::commit() {
  FileExpected<void> written = flush();
  if (!written) return written;
  if (descriptor_ == STDOUT_FILENO) {
    descriptor_ = -1;
    return {};
  }
  // Data first, name second: after a power cut the target is the old file or the whole new one.
  if (!temporary_.empty() && ::fsync(descriptor_) != 0 && errno != EINVAL) {
    return tl::unexpected<FileError>(failure("write", errno));
  }
  if (::close(std::exchange(descriptor_, -1)) != 0) {
    const int error_number = errno;
    if (!temporary_.empty()) (void)::unlink(temporary_.c_str());
    return tl::unexpected<FileError>(failure("close", error_number));
  }
  if (!temporary_.empty()) {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
      const int error_number = errno;
      (void)::unlink(temporary_.c_str());
      return tl::unexpected<FileError>(failure("put in place", error_number));
    }
    temporary_.clear();
  }
  return {};
}

FileExpected<void> write_file(const std::string& path, std::string_view text) {
  FileExpected<OutputFile> file = OutputFile::create(path, OutputFile::Mode::whole);
  if (!file) return tl::unexpected<FileError>(file.error());
  FileExpected<void> written = file->write(text);
  return written ? file->commit() : written;
}

FileExpected<std::string> read_file(const std::string& path) {
  FileError error;
  error.file = path;
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT(*-vararg)
  int error_number = descriptor < 0 ? errno : 0;
  std::string text;
  while (error_number == 0) {
    const std::size_t before = text.size();
    text.resize(before + kBuffer);
    const ssize_t count = ::read(descriptor, &text[before], kBuffer);
    text.resize(before + (count > 0 ? static_cast<std::size_t>(count) : 0U));
    if (count == 0) break;
    if (count < 0 && errno != EINTR) error_number = errno;
  }
  if (descriptor >= 0) (void)::close(descriptor);
  if (error_number == 0) return text;
  error.what = std::string("cannot be read: ") + system_message(error_number);
  error.remedy = error_number == EISDIR ? "name a file, not a directory" : "check the path and the permissions";
  return tl::unexpected<FileError>(std::move(error));
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
