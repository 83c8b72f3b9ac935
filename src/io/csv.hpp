/// Lines and cells of a CSV stream (private to src/io): one buffer, no allocation per row.
#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

/// Lines of a file or of standard input ("-"). A line is handed out as soon as it is complete, so that a
/// live stream is not held back.
class LineSource {
 public:
  enum class Status : std::uint8_t { line, end, failed };

  LineSource() = default;
  LineSource(const LineSource&) = delete;
  LineSource& operator=(const LineSource&) = delete;
  LineSource(LineSource&&) = delete;
  LineSource& operator=(LineSource&&) = delete;
  ~LineSource();

  /// errno, or 0.
  int open(const std::string& path);
  /// Another reader of all that `first` will read; `first` has been opened, and no source of its bytes has read any.
  void open_beside(LineSource& first);
  /// The next line without its end ("\n" or "\r\n"), valid until the next call. After `failed`,
  /// `error_number` says why (EMSGSIZE: a line beyond 16 MB).
  Status next(std::string_view& line);
  int error_number() const noexcept { return error_number_; }

  /// For a source that does not hold lines: the next `count` bytes (at most 16 MB), valid until the next call; null
  /// where there are not that many.
  const unsigned char* peek(std::size_t count);
  /// Past what was peeked at.
  void skip(std::size_t count) noexcept { begin_ += count; }

  std::uint64_t bytes() const noexcept { return bytes_; }
  std::uint64_t hash() const noexcept { return hash_; }
  void hash_bytes();
  void stop_when(const volatile std::sig_atomic_t* flag) noexcept { stop_ = flag; }
  /// At the end of the file wait for what is appended; only a stop or an error ends the lines then.
  void follow() noexcept { following_ = true; }
  bool following() const noexcept { return following_; }
  bool stopped() const noexcept { return stop_ != nullptr && *stop_ != 0; }

 private:
  bool refill();
  std::ptrdiff_t fetch();

  std::vector<char> buffer_;
  std::vector<LineSource*> beside_;  ///< who else is to have what this one reads
  std::string waiting_;              ///< what one of them has read, and this one has not come to
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  int descriptor_ = -1;
  int error_number_ = 0;
  bool at_end_ = false;
  bool hashing_ = false;
  bool following_ = false;
  std::uint64_t bytes_ = 0;
  std::uint64_t hash_ = 0;
  const volatile std::sig_atomic_t* stop_ = nullptr;
};

/// Cuts a line at its commas; a cell may stand in double quotes (a comma inside does not cut). At most
/// `cells.size()` cells are stored, the number found is returned.
std::size_t split_cells(std::string_view line, std::vector<std::string_view>& cells) noexcept;

/// A cell without surrounding blanks and quotes.
std::string_view bare_cell(std::string_view cell) noexcept;

enum class CellKind : std::uint8_t { number, empty, text };
/// The number in a cell, correctly rounded; nan and inf in any case are numbers.
CellKind parse_cell(std::string_view cell, double& value) noexcept;
/// A whole number ("3", "3.0").
CellKind parse_whole(std::string_view cell, std::int64_t& value) noexcept;
/// `number` as one; false where it is none, or where a double no longer tells it from its neighbours.
inline bool to_whole(double number, std::int64_t& value) noexcept {
  if (!(number < 9007199254740992.0 && number > -9007199254740992.0)) return false;
  const auto whole = static_cast<std::int64_t>(number);
  if (static_cast<double>(whole) != number) return false;
  value = whole;
  return true;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
