/// What LogReader keeps between rows. Its members are in log_reader.cpp (the file and its header), log_row.cpp (one
/// row) and log_ulog.cpp (what is different for a ULog).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "csv.hpp"
#include "plumb/io/log_reader.hpp"
#include "ulog_rows.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

/// A cell of a CSV, or the text of a constant column.
bool matches(const ColumnFilter& filter, std::string_view cell) noexcept;

struct LogReader::State {
  std::string path;
  InputSpec input;
  BadRowPolicy policy = BadRowPolicy::stop;
  LineSource source;
  std::optional<UlogRows> binary;         ///< a ULog: its rows
  std::vector<std::size_t> number_place;  ///< ... where in a row the number of a column stands; kNoColumn: a constant
  std::vector<std::size_t> sensor_place;  ///< ... the same of the sensors, where none of them is a constant
  std::uint64_t sensor_marks = 0;         ///< ... and their bits in a row
  std::vector<std::string> header;
  std::vector<std::string_view> cells;
  std::size_t time = kNoColumn;
  std::size_t station = kNoColumn;
  std::size_t roll_group = kNoColumn;
  std::size_t count = kNoColumn;
  std::size_t temperature = kNoColumn;
  std::size_t depth = kNoColumn;
  std::vector<std::size_t> sensors;
  std::vector<std::size_t> filters;
  std::vector<std::size_t> rates, second_rates;
  std::vector<std::size_t> clocks;
  std::vector<double> clock_s;
  Rotation rotation, second_rotation;
  double depth_m = 0.0;  ///< NaN: not known
  int line = 0;
  std::uint64_t index = 0;  ///< of the row among those not filtered out, bad ones included
  double last_temperature_degc = 0.0;
  bool has_temperature = false;
  LogStatistics statistics;
  SensorSet seen;  ///< with a number so far
  FileError error;

  // What the row at hand is refused for.
  std::size_t bad_column = kNoColumn;
  std::string bad_what;

  // Apart from the way of a good row, which is one piece of code without them.
  [[gnu::cold, gnu::noinline]] bool refuse(std::size_t column, std::string_view what);
  [[gnu::cold, gnu::noinline]] bool refuse_cell(std::size_t column, const char* what);
  [[gnu::cold, gnu::noinline]] bool refuse_tag(std::size_t column, const char* what);
  [[gnu::cold, gnu::noinline]] bool refuse_time(double time_s);
  FileError io_failure(int error_number) const;
  FileExpected<void> begin(const std::string& file);
  FileExpected<void> read_header();
  FileExpected<void> map_columns();
  FileExpected<std::size_t> column_of(const std::string& name, const std::string& role) const;
  enum class Kind : std::uint8_t { text, ulog, plog };
  Kind kind_of_log();
  void use_seconds_and_metres();
  FileExpected<void> read_binary_header(const std::string& file);
  FileExpected<void> check_unit(std::size_t column, const std::string& wanted, const char* key) const;
  FileExpected<void> check_binary() const;
  void plan_sensors();
  enum class Got : std::uint8_t { row, skipped, end, error };
  Got next_cells();
  Got next_binary() {
    if (!binary->advance()) return next_block();
    return binary->marks_sound() ? Got::row : refuse_marks();
  }
  Got next_block();
  [[gnu::cold]] Got refuse_marks();
  CellKind text_in(std::size_t column, double& value) const noexcept;
  std::string shown(std::size_t column) const;
  bool matches_binary(const ColumnFilter& filter, std::size_t column) const noexcept;
  FileError bad_row() const;
  Got note_bad(std::uint64_t rows, FileError why);
  /// A row of either kind of log; which kind is decided once for all its cells.
  bool fill(Sample& sample) { return binary ? fill_row<true>(sample) : fill_row<false>(sample); }
  template <bool kBinary>
  CellKind number_in(std::size_t column, double& value) const noexcept;
  template <bool kBinary>
  CellKind whole_in(std::size_t column, std::int64_t& value) const noexcept;
  template <bool kBinary>
  bool fill_row(Sample& sample);
  template <bool kBinary>
  bool fill_time(Sample& sample);
  template <bool kBinary>
  bool fill_tag(std::size_t column, const char* what, std::uint32_t& tag);
  template <bool kBinary>
  bool fill_tags(Sample& sample);
  template <bool kBinary>
  bool fill_temperature(Sample& sample);
  template <bool kBinary>
  bool fill_rotation(const std::vector<std::size_t>& columns, Rotation& out);
  template <bool kBinary>
  bool fill_clocks();
  template <bool kBinary>
  bool fill_depth();
  template <bool kBinary>
  bool fill_sensors(Sample& sample);
  void count_values(const Sample& sample) noexcept;
  void count_each(const Sample& sample) noexcept;
  bool selected() const noexcept;
  FileError nothing_usable() const;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
