#include "ulog_writer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "little_endian.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// The largest stamp that tools with signed numbers take for a time.
constexpr std::uint64_t kLatestStamp_us = std::numeric_limits<std::int64_t>::max();

std::uint64_t stamp_of(double time_s) noexcept {
  const double time_us = std::round(time_s * 1e6);
  if (!(time_us > 0.0)) return 0;
  return time_us < static_cast<double>(kLatestStamp_us) ? static_cast<std::uint64_t>(time_us) : kLatestStamp_us;
}

}  // namespace

void UlogWriter::begin_row(double time_s) {
  stamp_us_ = std::max(stamp_us_, stamp_of(time_s));
  if (rows_ == 0) block_stamp_us_ = stamp_us_;
}

void UlogWriter::put(bool present, double value) {
  if (present) present_ |= std::uint64_t{1} << numbers_;
  put_double(row_, present ? value : std::numeric_limits<double>::quiet_NaN());
  ++numbers_;
}

FileExpected<void> UlogWriter::end_row(OutputFile& file) {
  rows_text_ += row_head_;
  put_u64(rows_text_, stamp_us_);
  put_u64(rows_text_, present_);
  rows_text_ += row_;
  row_.clear();
  present_ = 0;
  numbers_ = 0;
  ++rows_;
  return rows_ == header_.block_rows ? write_block(file) : FileExpected<void>();
}

/// A block of no rows is the end mark.
FileExpected<void> UlogWriter::write_block(OutputFile& file) {
  std::string block = block_head_;
  put_u64(block, rows_ > 0 ? block_stamp_us_ : stamp_us_);
  put_u64(block, written_);
  put_u32(block, rows_);
  put_u32(block, crc32_of(rows_text_.data(), rows_text_.size(), crc32_of(block.data(), block.size())));
  block += rows_text_;
  written_ += rows_;
  rows_ = 0;
  rows_text_.clear();
  return file.write(block);
}

FileExpected<void> UlogWriter::finish(OutputFile& file) {
  if (rows_ > 0) {
    const FileExpected<void> done = write_block(file);
    if (!done) return done;
  }
  return write_block(file);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
