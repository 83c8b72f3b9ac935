/// Logs of ArduPilot turned into text: a line a message (private to src/logs).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "csv_records.hpp"
#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

/// "IMU, 1000000, 0, 0.1, ...", with "FMT, ..." or "IMU, TimeUS, I, ..." before or without; or
/// "2024-05-01 12:00:00.00: IMU {TimeUS : 1000000, I : 0, ...}" as mavlogdump prints.
bool is_long_form(const std::vector<std::string>& lines);

class CsvLong {
 public:
  CsvLong(LogSink& sink, CsvNotes& notes, CsvRecords& records) : sink_(sink), notes_(notes), records_(records) {}

  /// `is_whole` is false for a last line that just stops.
  void take(std::string_view line, bool is_whole, std::uint64_t offset, std::uint64_t number);

 private:
  using Cells = std::vector<std::string_view>;
  using Columns = std::vector<std::string>;

  void define(std::string_view name, const Cells& cells, std::size_t first);
  const Columns* columns_of(std::string_view name, const Cells& cells, std::uint64_t offset);
  void reading(std::string_view name, const Columns& columns, const Cells& cells, std::uint64_t offset,
               std::uint64_t number);
  void parameter(const Cells& cells);
  void keyed(std::string_view name, std::string_view content, std::uint64_t offset, std::uint64_t number);

  LogSink& sink_;
  CsvNotes& notes_;
  CsvRecords& records_;
  std::map<std::string, Columns, std::less<>> columns_;
  Cells cells_;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
