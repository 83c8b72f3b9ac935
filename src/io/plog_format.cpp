#include "plog_format.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "plumb/io/units.hpp"
#include "plumb/scenario/count_text.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

constexpr std::size_t kColumnHead = 8;
constexpr std::size_t kCrcSize = 4;
constexpr std::uint8_t kNumbers = 0;
constexpr std::uint8_t kConstant = 1;

void put_u16(std::string& out, std::size_t value) {
  out += static_cast<char>(value & 0xFFU);
  out += static_cast<char>(value >> 8U & 0xFFU);
}
std::size_t u16_at(const unsigned char* at) noexcept {
  return static_cast<std::size_t>(at[0]) | static_cast<std::size_t>(at[1]) << 8U;
}

const unsigned char* bytes_of(std::string_view text) noexcept {
  return reinterpret_cast<const unsigned char*>(text.data());
}

tl::unexpected<FileError> refuse(const std::string& path, std::string what, std::string remedy) {
  return tl::unexpected<FileError>(FileError{path, 0, "header", std::move(what), std::move(remedy)});
}

const char* const kCopyAgain = "copy the file again in binary mode, or write it anew (plumb convert)";

/// Entry number `k`, at `at`; moves on. False where it reaches beyond the table.
bool read_column(std::string_view table, std::size_t& at, PlogColumn& column) {
  if (table.size() - at < kColumnHead) return false;
  const unsigned char* const head = bytes_of(table) + at;
  const std::size_t name = u16_at(head + 2);
  const std::size_t text = u16_at(head + 4);
  at += kColumnHead;
  if (head[0] > kConstant || name == 0 || table.size() - at < name + text) return false;
  column.constant = head[0] == kConstant;
  column.name = table.substr(at, name);
  column.text = table.substr(at + name, text);
  at += name + text;
  return true;
}

}  // namespace

std::size_t PlogHeader::numbers() const noexcept {
  return static_cast<std::size_t>(
      std::count_if(columns.begin(), columns.end(), [](const PlogColumn& c) { return !c.constant; }));
}

void put_u32(std::string& out, std::uint32_t value) {
  for (unsigned k = 0; k < 4; ++k) out += static_cast<char>(value >> (8 * k) & 0xFFU);
}
void put_u64(std::string& out, std::uint64_t value) {
  put_u32(out, static_cast<std::uint32_t>(value));
  put_u32(out, static_cast<std::uint32_t>(value >> 32U));
}
void put_double(std::string& out, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put_u64(out, bits);
}

std::uint32_t crc32_of(const void* data, std::size_t size) noexcept { return ::libdeflate_crc32(0, data, size); }

namespace {
std::string unit_of_size(Quantity quantity, std::initializer_list<const char*> names, double size) {
  for (const char* name : names) {
    const FileExpected<double> unit = parse_quantity(quantity, std::string("1 ") + name);
    if (unit && *unit == size) return name;
  }
  return "";
}
}  // namespace

std::string plog_time_unit(double unit_s) {
  return unit_of_size(Quantity::time, {"s", "ms", "us", "min", "h"}, unit_s);
}
std::string plog_depth_unit(double unit_m) { return unit_of_size(Quantity::length, {"m", "ft", "km"}, unit_m); }

std::string plog_misfit(const PlogHeader& header) {
  const std::size_t columns = header.columns.size();
  if (columns > kPlogColumns) {
    return "a binary log has at most " + std::to_string(kPlogColumns) + " columns, but the array file needs " +
           std::to_string(columns);
  }
  std::size_t size = kPlogFixedSize + kCrcSize;
  for (const PlogColumn& column : header.columns) size += kColumnHead + column.name.size() + column.text.size();
  return size <= kPlogLongestHeader ? "" : "the column names are too long for the header of a binary log";
}

std::string plog_header_bytes(const PlogHeader& header) {
  std::string table;
  for (const PlogColumn& column : header.columns) {
    table += static_cast<char>(column.constant ? kConstant : kNumbers);
    table += '\0';
    put_u16(table, column.name.size());
    put_u16(table, column.text.size());
    put_u16(table, 0);
    table += column.name;
    table += column.text;
  }
  std::string out(kPlogMagic);
  put_u32(out, kPlogByteOrder);
  put_u32(out, kPlogVersion);
  put_u32(out, static_cast<std::uint32_t>(kPlogFixedSize + table.size() + kCrcSize));
  put_u32(out, static_cast<std::uint32_t>(header.columns.size()));
  put_u32(out, header.block_rows);
  put_u32(out, 0);
  put_double(out, header.rate_hz);
  out += table;
  put_u32(out, crc32_of(out.data(), out.size()));
  return out;
}

FileExpected<std::size_t> plog_header_size(std::string_view fixed, const std::string& path) {
  const unsigned char* const at = bytes_of(fixed);
  if (fixed.substr(0, 5) != kPlogMagic.substr(0, 5)) {
    return refuse(path, "begins with the byte 0x89 of a binary log, but its header is wrong",
                  "name a CSV or a binary log");
  }
  if (fixed.substr(0, kPlogMagic.size()) != kPlogMagic) {
    return refuse(path, "begins like a binary log, but its line ends were changed: it was copied as text", kCopyAgain);
  }
  const std::uint32_t order = u32_at(at + 8);
  if (order == 0x04030201U) {
    return refuse(path, "the log is big-endian; a binary log must be little-endian on every machine",
                  "let the recorder write every number with its lowest byte first");
  }
  if (order != kPlogByteOrder) return refuse(path, "the byte-order mark (bytes 8 to 11) is damaged", kCopyAgain);
  const std::uint32_t version = u32_at(at + 12);
  if (version != kPlogVersion) {
    return refuse(
        path, "is of version " + std::to_string(version) + ", this plumb reads version " + std::to_string(kPlogVersion),
        "convert it to CSV with the version of plumb that wrote it (plumb convert)");
  }
  const std::size_t size = u32_at(at + 16);
  if (size >= kPlogFixedSize + kCrcSize && size <= kPlogLongestHeader) return size;
  return refuse(path,
                "states a length of " + count_text(size, "byte") + ", but the range is " +
                    std::to_string(kPlogFixedSize + kCrcSize) + " to " + std::to_string(kPlogLongestHeader),
                kCopyAgain);
}

FileExpected<PlogHeader> plog_header_of(std::string_view bytes, const std::string& path) {
  const std::size_t table_end = bytes.size() - kCrcSize;
  if (crc32_of(bytes.data(), table_end) != u32_at(bytes_of(bytes) + table_end)) {
    return refuse(path, "its check sum is wrong: the header is damaged", kCopyAgain);
  }
  PlogHeader header;
  const std::size_t columns = u32_at(bytes_of(bytes) + 20);
  header.block_rows = u32_at(bytes_of(bytes) + 24);
  header.rate_hz = double_at(bytes_of(bytes) + 32);
  if (columns < 1 || columns > kPlogColumns) {
    return refuse(path,
                  "names " + count_text(columns, "column") + ", but the range is 1 to " + std::to_string(kPlogColumns),
                  "record only the columns that the array file names");
  }
  if (header.block_rows < 1 || header.block_rows > kPlogBlockRows) {
    return refuse(path,
                  "allows " + count_text(header.block_rows, "row") + " in a block, but the range is 1 to " +
                      std::to_string(kPlogBlockRows),
                  "let the recorder write shorter blocks");
  }
  if (!std::isfinite(header.rate_hz) || header.rate_hz < 0.0 || u32_at(bytes_of(bytes) + 28) != 0) {
    return refuse(path, "its rate is negative or not a number, or a reserved field is not 0",
                  "let the recorder write the format of docs/array-file.md");
  }
  const std::string_view table = bytes.substr(kPlogFixedSize, table_end - kPlogFixedSize);
  std::size_t at = 0;
  bool fits = true;
  for (std::size_t k = 0; k < columns && fits; ++k) fits = read_column(table, at, header.columns.emplace_back());
  if (fits && at == table.size()) return header;
  return refuse(path, "column " + std::to_string(header.columns.size()) + " does not match the table of columns",
                "let the recorder write the format of docs/array-file.md");
}

PlogBlockHead plog_block_head(const unsigned char* at) noexcept {
  return PlogBlockHead{u32_at(at), u32_at(at + 4), u64_at(at + 8)};
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
