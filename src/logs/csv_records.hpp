/// What a table of text hands on, row by row (private to src/logs).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "log_notes.hpp"
#include "plumb/core/config.hpp"
#include "plumb/logs/flight_log.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {

enum class CsvTroubleKind : std::uint8_t {
  guess,   ///< what the names did not say
  line,    ///< too long, or with other cells than the header
  cell,    ///< a word where a number is wanted
  value,   ///< a reading that is not finite
  time,    ///< no time, or one that goes back
  source,  ///< too many, or an impossible instance
  count
};
const char* words_of(CsvTroubleKind trouble) noexcept;
using CsvNotes = LogNotes<CsvTroubleKind>;

/// Sources and their records; times that count from 1970 count from the whole second of the first one.
class CsvRecords {
 public:
  CsvRecords(LogSink& sink, CsvNotes& notes) : sink_(sink), notes_(notes) {}

  /// A record of the source of this name, which is told where it is new. `where` is "line 12: ".
  void take(const ImuSource& source, std::int64_t time_ns, ImuRecord record, std::uint64_t offset, std::uint64_t line);
  std::uint64_t records() const noexcept { return records_; }

 private:
  static constexpr std::size_t kMostSources = 256;
  struct Seen {
    std::size_t number = 0;
    double last_time_s = -std::numeric_limits<double>::infinity();
  };
  double time_s(std::int64_t time_ns);

  LogSink& sink_;
  CsvNotes& notes_;
  std::map<std::string, Seen> seen_;
  bool has_zero_ = false;
  std::int64_t zero_s_ = 0;
  std::uint64_t records_ = 0;
};

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
