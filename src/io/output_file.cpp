#include "plumb/io/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kBuffer = 1U << 16U;
/// No file that is read as a whole comes near it; a device like /dev/zero never ends.
constexpr std::size_t kLargestWhole = 256U << 20U;

std::string remedy_for(int error_number) {
  switch (error_number) {
    case ENOENT: return "create the directory first, or choose another path";
    case EACCES:
    case EPERM:
    case EROFS: return "choose a directory that you may write to";
    case EISDIR: return "name a file, not a directory";
    case ENOTDIR: return "choose another path: a part of this one is a file, not a directory";
    case ENOSPC:
    case EDQUOT: return "free space on the disk, or choose another disk";
    case EPIPE: return "the reader of the pipe has closed it; run again";
    default: return "choose another path, or correct what the system reports";
  }
}

/// Where a path leads through links; the path itself where the system cannot say.
std::string real_path(const std::string& path) {
  char* const found = ::realpath(path.c_str(), nullptr);
  std::string out = found != nullptr ? found : path;
  std::free(found);  // NOLINT(*-no-malloc,*-owning-memory) realpath allocates it
  return out;
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
  file.place_ = path;
  if (mode == Mode::whole && replaceable) {
    if (exists) file.place_ = real_path(path);  // a link stays a link
    file.temporary_ = file.place_ + ".part" + std::to_string(::getpid());
    (void)::unlink(file.temporary_.c_str());  // of a process that had the same number and was killed
  }
  const bool beside = !file.temporary_.empty();
  const std::string& target = beside ? file.temporary_ : file.place_;
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (beside ? O_EXCL : O_TRUNC);
  file.descriptor_ = ::open(target.c_str(), flags, 0666);  // NOLINT(*-vararg)
  if (file.descriptor_ < 0) {
    const int error_number = errno;
    file.temporary_.clear();  // it is not ours
    return tl::unexpected<FileError>(file.failure("write", error_number));
  }
  if (beside && exists) (void)::fchmod(file.descriptor_, status.st_mode & 07777U);  // who may read it stays the same
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      place_(std::move(other.place_)),
      temporary_(std::exchange(other.temporary_, {})),
      buffer_(std::exchange(other.buffer_, {})),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    close_quietly();
    path_ = std::move(other.path_);
    place_ = std::move(other.place_);
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
    if (std::rename(temporary_.c_str(), place_.c_str()) != 0) {
      const int error_number = errno;
      (void)::unlink(temporary_.c_str());
      return tl::unexpected<FileError>(failure("rename", error_number));
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
  while (error_number == 0 && text.size() <= kLargestWhole) {
    const std::size_t before = text.size();
    text.resize(before + kBuffer);
    const ssize_t count = ::read(descriptor, &text[before], kBuffer);
    text.resize(before + (count > 0 ? static_cast<std::size_t>(count) : 0U));
    if (count == 0) break;
    if (count < 0 && errno != EINTR) error_number = errno;
  }
  if (descriptor >= 0) (void)::close(descriptor);
  if (text.size() > kLargestWhole) {
    error.what = "is larger than 256 MiB, the most that is read as a whole";
    error.remedy = "check the path: array, calibration, scenario, campaign and result files and snapshots are smaller";
    return tl::unexpected<FileError>(std::move(error));
  }
  if (error_number == 0) return text;
  error.what = std::string("cannot be read: ") + system_message(error_number);
  error.remedy = error_number == EISDIR ? "name a file, not a directory" : "check the path and the permissions";
  return tl::unexpected<FileError>(std::move(error));
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
