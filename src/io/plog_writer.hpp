/// Gathers rows to the blocks of a binary log (private to src/io).
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "plog_format.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class PlogWriter {
 public:
  explicit PlogWriter(PlogHeader header) : header_(std::move(header)) {}

  FileExpected<void> begin(OutputFile& file) { return file.write(plog_header_bytes(header_)); }
  /// The next number of the row; a row has as many as the header has columns of numbers.
  void put(bool present, double value);
  FileExpected<void> end_row(OutputFile& file);
  /// What is left, and the end mark.
  FileExpected<void> finish(OutputFile& file);

 private:
  FileExpected<void> write_block(OutputFile& file);

  PlogHeader header_;
  std::string rows_text_;  ///< of the block that is being gathered
  std::string row_;
  std::uint64_t present_ = 0;
  std::size_t numbers_ = 0;
  std::uint32_t rows_ = 0;
  std::uint64_t written_ = 0;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
