#include "plog_writer.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// From the number of rows on; the check sum comes in front when the block is complete.
void put_head(std::string& block, std::uint32_t rows, std::uint64_t first_row) {
  put_u32(block, rows);
  put_u64(block, first_row);
}

FileExpected<void> write_checked(OutputFile& file, const std::string& checked) {
  std::string crc;
  put_u32(crc, crc32_of(checked.data(), checked.size()));
  const FileExpected<void> done = file.write(crc);
  return done ? file.write(checked) : done;
}

}  // namespace

void PlogWriter::put(bool present, double value) {
  if (present) present_ |= std::uint64_t{1} << numbers_;
  put_double(row_, present ? value : 0.0);
  ++numbers_;
}

FileExpected<void> PlogWriter::end_row(OutputFile& file) {
  put_u64(rows_text_, present_);
  rows_text_ += row_;
  row_.clear();
  present_ = 0;
  numbers_ = 0;
  ++rows_;
  return rows_ == header_.block_rows ? write_block(file) : FileExpected<void>();
}

FileExpected<void> PlogWriter::write_block(OutputFile& file) {
  std::string block;
  put_head(block, rows_, written_);
  block += rows_text_;
  written_ += rows_;
  rows_ = 0;
  rows_text_.clear();
  return write_checked(file, block);
}

FileExpected<void> PlogWriter::finish(OutputFile& file) {
  if (rows_ > 0) {
    const FileExpected<void> done = write_block(file);
    if (!done) return done;
  }
  std::string mark;
  put_head(mark, 0, written_);
  return write_checked(file, mark);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
