/// Gathers rows to the blocks of a ULog (private to src/io).
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "plumb/io/output_file.hpp"
#include "ulog_header.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class UlogWriter {
 public:
  explicit UlogWriter(UlogHeader header)
      : header_(std::move(header)), row_head_(ulog_row_head(header_.numbers())), block_head_(ulog_block_head()) {}

  FileExpected<void> begin(OutputFile& file) { return file.write(ulog_header_bytes(header_)); }
  /// The stamp is in whole microseconds, not below 0 nor below the one before: what other tools take for the time.
  void begin_row(double time_s);
  /// The next number of the row; a row has as many as the header has columns of numbers.
  void put(bool present, double value);
  FileExpected<void> end_row(OutputFile& file);
  /// What is left, and the end mark.
  FileExpected<void> finish(OutputFile& file);

 private:
  FileExpected<void> write_block(OutputFile& file);

  UlogHeader header_;
  std::string row_head_, block_head_;
  std::string rows_text_;             ///< of the block that is being gathered
  std::string row_;                   ///< the numbers of the row at hand
  std::uint64_t stamp_us_ = 0;        ///< of the row at hand, or of the last one
  std::uint64_t block_stamp_us_ = 0;  ///< of the first row of the block
  std::uint64_t present_ = 0;
  std::size_t numbers_ = 0;
  std::uint32_t rows_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
