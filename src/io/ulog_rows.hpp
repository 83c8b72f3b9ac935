/// The rows of a ULog that plumb wrote, one block after the other (private to src/io). No row is given out before the
/// check sum of its block was found right.
#pragma once

#include <cstdint>
#include <string>

#include "csv.hpp"
#include "little_endian.hpp"
#include "plumb/io/mapped_file.hpp"
#include "ulog_header.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class UlogRows {
 public:
  enum class Status : std::uint8_t {
    row,
    end,      ///< behind the end mark, or because a stop was asked for
    damaged,  ///< a block of `rows_lost` rows cannot be trusted; the next one may
    lost,     ///< from here on nothing can be read
    failed,   ///< reading itself, see LineSource::error_number
  };

  /// `source` stands before the magic number. Errors: another program's ULog, what is wrong with the header.
  static FileExpected<UlogRows> open(LineSource& source, const std::string& path);

  UlogRows(UlogRows&&) = default;
  UlogRows& operator=(UlogRows&&) = delete;
  UlogRows(const UlogRows&) = delete;
  UlogRows& operator=(const UlogRows&) = delete;
  ~UlogRows() = default;

  const UlogHeader& header() const noexcept { return header_; }
  /// From here on out of the mapped file, where it is a file. Before the first row.
  void map(const std::string& path);
  /// Back to reading: for a file that grows.
  void unmap() noexcept { mapped_ = false; }
  void hash_bytes();

  /// To the next row of the block at hand; false where it has no more.
  bool advance() noexcept {
    if (left_ == 0) return false;
    --left_;
    ++row_number_;
    row_ += row_bytes_;
    present_ = u64_at(row_ + kUlogRowMarks);
    return true;
  }
  /// To the first row of the next block.
  Status next_block();
  /// Of the row at hand; `number` counts the columns that have a number in every row.
  bool has(std::size_t number) const noexcept { return (present_ >> number & 1U) != 0; }
  bool has_all(std::uint64_t marks) const noexcept { return (present_ & marks) == marks; }
  double value(std::size_t number) const noexcept { return double_at(row_ + kUlogRowNumbers + 8 * number); }
  bool marks_sound() const noexcept { return numbers_ == kUlogColumns || present_ >> numbers_ == 0; }
  std::uint64_t row() const noexcept { return row_number_; }  ///< counted from 1

  const std::string& what() const noexcept { return what_; }  ///< after `damaged` and `lost`
  std::uint64_t rows_lost() const noexcept { return rows_lost_; }
  std::uint64_t bytes() const noexcept { return offset_; }
  std::uint64_t hash() const noexcept { return hash_; }

 private:
  UlogRows(LineSource& source, UlogHeader header, std::string header_bytes);
  const unsigned char* peek(std::size_t count);
  void consume(const unsigned char* bytes, std::size_t count);
  Status cut_short(std::size_t wanted);
  Status end_mark(const unsigned char* at, const UlogBlock& block);
  Status damage(const unsigned char* at, std::size_t size, std::uint32_t rows, const char* what);
  bool are_rows(const unsigned char* at, std::uint32_t rows) const noexcept;
  Status lose(std::string what);

  LineSource* source_;
  UlogHeader header_;
  std::string header_bytes_;
  std::size_t numbers_;
  std::size_t row_bytes_;
  std::string row_head_, block_head_;  ///< what the messages begin with
  MappedFile map_;
  bool mapped_ = false;
  bool hashing_ = false;
  bool ended_ = false;
  std::uint64_t offset_ = 0;  ///< of what comes next
  std::uint64_t hash_ = 0;
  const unsigned char* row_ = nullptr;
  std::uint64_t present_ = 0;
  std::uint32_t left_ = 0;  ///< rows of this block behind the one at hand
  std::uint64_t row_number_ = 0;
  std::uint64_t rows_lost_ = 0;
  std::string what_;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
