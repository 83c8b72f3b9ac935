/// The bytes of a binary log (private to src/io): layout, header, check sums. docs/array-file.md is its contract.
///
///   header   magic, byte order, version, how long, how many columns, rows of a block, rate; one entry per column;
///            CRC-32 of all that
///   blocks   CRC-32 of the rest of the block, number of rows, number of its first row, rows: a bit per column that has
///   a
///            value (64 bits), then a double per column
///   end      a block of no rows, whose first row is the number of rows of the log
///
/// Everything is little-endian, whatever the machine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/io/file_error.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::string_view kPlogMagic{"\x89PLOG\r\n\x1A", 8};
inline constexpr std::uint32_t kPlogByteOrder = 0x01020304U;
inline constexpr std::uint32_t kPlogVersion = 1;
/// Presence is one bit per column in 64.
inline constexpr std::size_t kPlogColumns = 64;
/// A block stays below 2.2 MB, so that a reader needs little memory.
inline constexpr std::uint32_t kPlogBlockRows = 4096;
/// Up to the end of the rate; the columns follow.
inline constexpr std::size_t kPlogFixedSize = 40;
inline constexpr std::size_t kPlogBlockHead = 16;
inline constexpr std::size_t kPlogLongestHeader = 65536;

struct PlogColumn {
  std::string name;
  /// A number in every row, or one text for the whole log.
  bool constant = false;
  std::string text;  ///< the unit of the numbers ("" where they have none), or the text
};

struct PlogHeader {
  std::vector<PlogColumn> columns;
  std::uint32_t block_rows = 512;  ///< no block has more
  double rate_hz = 0.0;            ///< of a log without a column of time; 0: it has one, or its rows are stations

  /// Columns with a number in every row.
  std::size_t numbers() const noexcept;
  std::size_t row_bytes() const noexcept { return 8 + 8 * numbers(); }
};

/// One block: what a writer has gathered, or a reader has before it.
struct PlogBlockHead {
  std::uint32_t crc = 0;
  std::uint32_t rows = 0;
  std::uint64_t first_row = 0;
};

void put_u32(std::string& out, std::uint32_t value);
void put_u64(std::string& out, std::uint64_t value);
void put_double(std::string& out, double value);

/// Numbers as they stand in the file, on a machine of either byte order.
inline std::uint64_t u64_at(const unsigned char* at) noexcept {
  std::uint64_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap64(value);
}
inline std::uint32_t u32_at(const unsigned char* at) noexcept {
  std::uint32_t value = 0;
  std::memcpy(&value, at, sizeof value);
  return __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? value : __builtin_bswap32(value);
}
inline double double_at(const unsigned char* at) noexcept {
  const std::uint64_t bits = u64_at(at);
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// CRC-32 as in zlib, PNG and Ethernet.
std::uint32_t crc32_of(const void* data, std::size_t size) noexcept;

/// "ms" of 1e-3, "ft" of 0.3048; "" of what no unit of time, or of depth, is.
std::string plog_time_unit(double unit_s);
std::string plog_depth_unit(double unit_m);
/// Why this header cannot be written; "" where it can.
std::string plog_misfit(const PlogHeader& header);
std::string plog_header_bytes(const PlogHeader& header);
/// The size of the whole header from its first kPlogFixedSize bytes. Errors: another byte order, another version, a
/// size that cannot be.
FileExpected<std::size_t> plog_header_size(std::string_view fixed, const std::string& path);
/// From all its bytes.
FileExpected<PlogHeader> plog_header_of(std::string_view bytes, const std::string& path);
PlogBlockHead plog_block_head(const unsigned char* at) noexcept;

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
