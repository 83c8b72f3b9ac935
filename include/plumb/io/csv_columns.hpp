/// The number columns of a CSV whose layout no array file describes.
///
/// The same CSV that LogReader reads: a header row with the names, cells separated by commas, an empty cell or nan
/// where there is no number.
#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/io/file_error.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

struct CsvColumns {
  std::vector<std::string> names;           ///< of the columns below
  std::vector<std::vector<double>> values;  ///< one vector a column, as long as there are rows; NaN: no number there
  std::vector<std::string> left_out;        ///< names of columns whose first row holds text, or that hold no number
  std::uint64_t rows_bad = 0;               ///< skipped
  bool complete = true;                     ///< false: the numbers beyond `most_values` were not read
};

/// Numbers kept of one file at most: 1.6 GB.
inline constexpr std::size_t kMostCsvValues = 200'000'000;

/// The whole file; "-" is standard input. Ends early once *stop != 0. Errors: unreadable, empty, without names, a bad
/// row (text in a column of numbers, other than the header's number of cells) under BadRowPolicy::stop, no row of
/// numbers, more than 4096 columns.
FileExpected<CsvColumns> read_csv_columns(const std::string& path, BadRowPolicy policy,
                                          const volatile std::sig_atomic_t* stop = nullptr,
                                          std::size_t most_values = kMostCsvValues);

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
