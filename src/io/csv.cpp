#include "csv.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "plumb/io/hash.hpp"
#include "text_tools.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kFirstBuffer = 1U << 18U;
constexpr std::size_t kLongestLine = 1U << 24U;

/// from_chars leaves the value alone where it does not fit a double; strtod says which way.
bool out_of_range_value(std::string_view cell, double& value) noexcept {
  char text[400];
  if (cell.size() >= sizeof text) return false;
  std::memcpy(text, cell.data(), cell.size());
  text[cell.size()] = '\0';
  value = std::strtod(text, nullptr);
  return true;
}

/// Short beside what a person notices, long beside what a look at the file costs. A signal ends it early.
void wait_for_more() noexcept {
  const timespec pause = {0, 20'000'000};
  (void)::nanosleep(&pause, nullptr);
}

}  // namespace

LineSource::~LineSource() {
  for (LineSource* other : beside_) other->beside_.erase(std::find(other->beside_.begin(), other->beside_.end(), this));
  if (beside_.empty() && descriptor_ > STDIN_FILENO) (void)::close(descriptor_);
}

int LineSource::open(const std::string& path) {
  buffer_.resize(kFirstBuffer);
  descriptor_ = path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT(*-vararg)
  return descriptor_ < 0 ? errno : 0;
}

void LineSource::open_beside(LineSource& first) {
  buffer_.resize(kFirstBuffer);
  descriptor_ = first.descriptor_;
  beside_ = first.beside_;
  beside_.push_back(&first);
  for (LineSource* other : beside_) other->beside_.push_back(this);
}

void LineSource::hash_bytes() {
  hashing_ = true;
  hash_ = fnv1a(buffer_.data(), end_);  // the header's chunk has been read already
}

/// As `read` behind what is there: what another source has read already, or what is new, which the others get too.
std::ptrdiff_t LineSource::fetch() {
  char* const to = buffer_.data() + end_;
  const std::size_t room = buffer_.size() - end_;
  if (!waiting_.empty()) {
    const std::size_t count = waiting_.copy(to, room);
    waiting_.erase(0, count);
    return static_cast<std::ptrdiff_t>(count);
  }
  const ssize_t count = ::read(descriptor_, to, room);
  if (count <= 0) return count;
  for (LineSource* other : beside_) other->waiting_.append(to, static_cast<std::size_t>(count));
  return count;
}

/// Reads more behind what is there. False at the end, at an error, or where a stop was asked for.
bool LineSource::refill() {
  if (at_end_ || error_number_ != 0) return false;
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) {
    if (buffer_.size() >= kLongestLine) {
      error_number_ = EMSGSIZE;
      return false;
    }
    buffer_.resize(2 * buffer_.size());
  }
  for (;;) {
    if (stopped()) return false;
    const std::ptrdiff_t count = fetch();
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      error_number_ = errno;
      return false;
    }
    if (count == 0 && following_) {
      wait_for_more();
      continue;
    }
    at_end_ = count == 0;
    const auto fresh = static_cast<std::size_t>(count);
    if (hashing_) hash_ = fnv1a(buffer_.data() + end_, fresh, hash_);
    bytes_ += fresh;
    end_ += fresh;
    return fresh > 0;
  }
}

const unsigned char* LineSource::peek(std::size_t count) {
  while (end_ - begin_ < count) {
    if (!refill()) return nullptr;
  }
  return reinterpret_cast<const unsigned char*>(buffer_.data() + begin_);
}

LineSource::Status LineSource::next(std::string_view& line) {
  std::size_t searched = 0;
  for (;;) {
    if (stopped()) return Status::end;
    const char* first = buffer_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const void* found = held > searched ? std::memchr(first + searched, '\n', held - searched) : nullptr;
    std::size_t length = held;
    if (found != nullptr) {
      length = static_cast<std::size_t>(static_cast<const char*>(found) - first);
      begin_ += length + 1;
    } else {
      searched = held;
      if (refill()) continue;
      if (error_number_ != 0) return Status::failed;
      if (stopped() || held == 0) return Status::end;
      first = buffer_.data() + begin_;  // the last line has no newline
      begin_ = end_;
    }
    if (length > 0 && first[length - 1] == '\r') --length;
    line = std::string_view(first, length);
    return Status::line;
  }
}

std::size_t split_cells(std::string_view line, std::vector<std::string_view>& cells) noexcept {
  const char* at = line.data();
  const char* const end = at + line.size();
  std::size_t count = 0;
  for (;;) {
    const char* const begin = at;
    if (at != end && *at == '"') {
      ++at;
      while (at != end && *at != '"') ++at;
    }
    while (at != end && *at != ',') ++at;
    if (count < cells.size()) cells[count] = std::string_view(begin, static_cast<std::size_t>(at - begin));
    ++count;
    if (at == end) return count;
    ++at;
  }
}

std::string_view bare_cell(std::string_view cell) noexcept {
  cell = trimmed(cell);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  return trimmed(cell.substr(1, cell.size() - 2));
}

CellKind parse_cell(std::string_view cell, double& value) noexcept {
  const char* const end = cell.data() + cell.size();
  auto result = std::from_chars(cell.data(), end, value);
  if (result.ec == std::errc() && result.ptr == end) return CellKind::number;
  cell = bare_cell(cell);
  if (cell.empty()) return CellKind::empty;
  if (cell.front() == '+' && cell.size() > 1 && cell[1] != '-') cell.remove_prefix(1);
  const char* const last = cell.data() + cell.size();
  result = std::from_chars(cell.data(), last, value);
  if (result.ptr != last) return CellKind::text;
  if (result.ec == std::errc()) return CellKind::number;
  return result.ec == std::errc::result_out_of_range && out_of_range_value(cell, value) ? CellKind::number
                                                                                        : CellKind::text;
}

CellKind parse_whole(std::string_view cell, std::int64_t& value) noexcept {
  const char* const end = cell.data() + cell.size();
  const auto result = std::from_chars(cell.data(), end, value);
  if (result.ec == std::errc() && result.ptr == end) return CellKind::number;
  double number = 0.0;
  const CellKind kind = parse_cell(cell, number);
  if (kind != CellKind::number) return kind;
  return to_whole(number, value) ? CellKind::number : CellKind::text;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
