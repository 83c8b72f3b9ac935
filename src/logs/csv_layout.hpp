/// How a table of readings is laid out, found out from its first lines (private to src/logs).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "csv_cells.hpp"
#include "csv_names.hpp"
#include "plumb/core/config.hpp"
#include "plumb/logs/csv_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

constexpr std::size_t kNoColumn = ~std::size_t{0};
using CsvColumns = std::array<std::size_t, 3>;

/// The columns of one chip.
struct CsvSource {
  std::string name;
  int instance = 0;
  bool uncalibrated = false;  ///< as `ImuSource` says it
  CsvColumns force = {kNoColumn, kNoColumn, kNoColumn};
  CsvColumns rate = {kNoColumn, kNoColumn, kNoColumn};
  std::size_t temperature = kNoColumn;
  ColumnUnit force_unit = ColumnUnit::none;
  double force_factor = 0.0;  ///< m/s^2 in one of the unit
  double rate_factor = 0.0;   ///< rad/s in one; 0: not read
};

struct CsvLayout {
  CsvDialect dialect;
  std::vector<std::string> header;
  std::uint64_t header_line = 0;  ///< from 1; 0 where the names came from elsewhere
  std::uint64_t data_line = 0;    ///< the first line of readings
  std::size_t time = kNoColumn;
  TimeForm time_form = TimeForm::seconds;
  std::size_t nanoseconds = kNoColumn;  ///< beside whole seconds: the rest of the time
  std::size_t instance = kNoColumn;
  std::size_t device = kNoColumn;
  std::vector<CsvSource> sources;
  std::vector<std::string> guesses;  ///< what the names did not say
};

/// What the first lines of a file hold. They are whole lines, without their ends.
struct CsvSample {
  std::vector<std::string> lines;
  std::string stem;  ///< name of the file, without directories and its end: "log_3_sensor_accel_0"
};

struct CsvTrouble {
  std::uint64_t line = 0;
  std::string what;
  std::string remedy;
};

/// Nothing where the hints are such as can be.
tl::expected<void, CsvTrouble> check(const CsvHints& hints);

/// The dialect in which most of the sample reads as numbers, its header, and what its columns are.
tl::expected<CsvLayout, CsvTrouble> csv_layout(const CsvSample& sample, const CsvHints& hints);

/// Which columns are of which chip: the part of `csv_layout` behind the header. `rows` are the first rows of readings.
tl::expected<void, CsvTrouble> assign_columns(const std::vector<std::vector<std::string>>& rows,
                                              const CsvSample& sample, const CsvHints& hints, CsvLayout& out);

/// "separated by ';', decimal comma, ..." for people.
std::string text_of(const CsvLayout& layout);

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
