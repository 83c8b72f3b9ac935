/// What LogReader keeps between rows. Its members are in log_reader.cpp (the file and its header) and log_row.cpp (one
/// row).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "csv.hpp"
#include "plumb/io/log_reader.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

inline constexpr std::size_t kNoColumn = static_cast<std::size_t>(-1);

struct LogReader::State {
  std::string path;
  InputSpec input;
  BadRowPolicy policy = BadRowPolicy::stop;
  LineSource source;
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
  std::vector<std::size_t> rates;
  Rotation rotation;
  double depth_m = 0.0;  ///< NaN: not known
  int line = 0;
  std::uint64_t index = 0;  ///< of the row among those not filtered out, bad ones included
  double last_temperature_degc = 0.0;
  bool has_temperature = false;
  LogStatistics statistics;
  FileError error;

  // What the row at hand is refused for.
  std::size_t bad_column = kNoColumn;
  std::string bad_what;

  bool refuse(std::size_t column, std::string what) {
    bad_column = column;
    bad_what = std::move(what);
    return false;
  }
  FileError io_failure(int error_number) const;
  FileExpected<void> read_header();
  FileExpected<void> map_columns();
  FileExpected<std::size_t> column_of(const std::string& name, const std::string& role) const;
  FileError bad_row() const;
  bool fill(Sample& sample);
  bool fill_time(Sample& sample);
  bool fill_tag(std::size_t column, const char* what, std::uint32_t& tag);
  bool fill_tags(Sample& sample);
  bool fill_temperature(Sample& sample);
  bool fill_rotation();
  bool fill_depth();
  bool fill_sensors(Sample& sample);
  void note_value(std::size_t sensor, double value);
  bool selected() const noexcept;
  FileError nothing_usable() const;
};

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
