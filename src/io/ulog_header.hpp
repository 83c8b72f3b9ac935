/// How the rows of a log lie in a ULog that plumb wrote (private to src/io): definitions, columns, check sums.
/// docs/array-file.md is its contract.
///
///   beginning    header of a ULog, no flag bits, `sys_name` = plumb: the same bytes in every log
///   definitions  version, columns with their names and units, formats of a row and of a block, CRC-32 of all bytes so
///                far; subscriptions: rows are message 0, blocks message 1
///   blocks       a message plumb_block (its first row, how many rows, CRC-32 of itself and of them), then the messages
///                plumb_row: stamp, a bit per column that has a value, a double per column
///   end          a block of no rows, whose first row is the number of rows of the log
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/io/ulog_format.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::uint32_t kUlogLayoutVersion = 1;
/// Presence is one bit per column in 64.
inline constexpr std::size_t kUlogColumns = 64;
/// A block stays below 2.3 MB, so that a reader needs little memory.
inline constexpr std::uint32_t kUlogBlockRows = 4096;
inline constexpr std::size_t kUlogLongestHeader = 131072;
/// Size and kind of a message, number of its topic.
inline constexpr std::size_t kUlogDataHead = kUlogMessageHeader + 2;
/// Before the numbers of a row: stamp and presence.
inline constexpr std::size_t kUlogRowStamp = kUlogDataHead;
inline constexpr std::size_t kUlogRowMarks = kUlogRowStamp + 8;
inline constexpr std::size_t kUlogRowNumbers = kUlogRowMarks + 8;
/// A message plumb_block: stamp, first row, rows, check sum.
inline constexpr std::size_t kUlogBlockSize = kUlogDataHead + 24;
inline constexpr std::size_t kUlogBlockSum = kUlogBlockSize - 4;

struct UlogColumn {
  std::string field;  ///< what other tools see
  std::string name;   ///< of the array file
  /// A number in every row, or one text for the whole log.
  bool constant = false;
  std::string text;  ///< the unit of the numbers ("" where they have none), or the text
};

struct UlogHeader {
  std::vector<UlogColumn> columns;  ///< those with numbers come first
  std::uint32_t block_rows = 512;   ///< no block has more
  double rate_hz = 0.0;             ///< of a log without a column of time; 0: it has one, or its rows are stations

  /// Columns with a number in every row.
  std::size_t numbers() const noexcept;
  std::size_t row_bytes() const noexcept { return kUlogRowNumbers + 8 * numbers(); }
  /// A column of numbers. Its field is `wanted` in letters that a ULog allows, made unlike those that there are.
  void add_numbers(const std::string& wanted, const std::string& name, const std::string& unit);
};

/// What a block says of itself.
struct UlogBlock {
  std::uint64_t first_row = 0;
  std::uint32_t rows = 0;
  std::uint32_t crc = 0;
};

/// CRC-32 as in zlib, PNG and Ethernet, of these bytes behind those with `before`.
std::uint32_t crc32_of(const void* data, std::size_t size, std::uint32_t before = 0) noexcept;

/// Size, kind and topic of a row and of a block.
std::string ulog_row_head(std::size_t numbers);
std::string ulog_block_head();
UlogBlock ulog_block(const unsigned char* at) noexcept;

/// The bytes that every log of plumb begins with.
std::string ulog_beginning();
/// Why this header cannot be written; "" where it can.
std::string ulog_misfit(const UlogHeader& header);
std::string ulog_header_bytes(const UlogHeader& header);
/// Whether a message is the last of the definitions; two subscriptions of `ulog_subscriptions` follow it.
bool ulog_ends_definitions(std::string_view message) noexcept;
const std::string& ulog_subscriptions();
/// From all its bytes, the subscriptions included.
FileExpected<UlogHeader> ulog_header_of(std::string_view bytes, const std::string& path);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
