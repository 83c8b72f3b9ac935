/// Writes the CSV that `LogReader` reads with the same array file, bit for bit.
#pragma once

#include <string>

#include "plumb/core/sample.hpp"
#include "plumb/io/array_file.hpp"
#include "plumb/io/output_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

class LogWriter {
 public:
  /// Columns: time, station, count, temperature, depth (those that [input] names; the cells of depth stay empty), the
  /// columns of `where` with their values, then the sensors. Without a time column the time is left to the reader.
  static FileExpected<LogWriter> create(const std::string& path, const ArrayFile& array);

  /// A channel that is not in `sample.delivered` becomes an empty cell. Values must be in the log's unit.
  FileExpected<void> write(const Sample& sample);
  FileExpected<void> commit() { return file_.commit(); }

 private:
  LogWriter(OutputFile file, const InputSpec& input);

  OutputFile file_;
  InputSpec input_;
  std::string line_;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
