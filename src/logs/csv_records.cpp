#include "csv_records.hpp"

#include <algorithm>
#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace logs {
namespace {

constexpr std::int64_t kSecond_ns = 1000000000;
/// Clocks that began with the machine do not reach this; those since 1970 passed it in 1973.
constexpr std::int64_t kSince1970_s = 100000000;
/// Larger ones are no readings, and their squares may overflow.
constexpr double kLargestReading = 1e9;

std::string in_line(std::uint64_t line) { return "line " + std::to_string(line) + ": "; }

}  // namespace

const char* words_of(CsvTroubleKind trouble) noexcept {
  switch (trouble) {
    case CsvTroubleKind::guess: return "what the names of columns do not say";
    case CsvTroubleKind::line: return "lines that are no rows";
    case CsvTroubleKind::cell: return "cells that are no numbers";
    case CsvTroubleKind::value: return "readings that are not finite";
    case CsvTroubleKind::time: return "times that are none, or go back";
    case CsvTroubleKind::source: return "instances that cannot be";
    case CsvTroubleKind::count: break;
  }
  return "";
}

double CsvRecords::time_s(std::int64_t time_ns) {
  if (!has_zero_) {
    has_zero_ = true;
    zero_s_ = time_ns / kSecond_ns >= kSince1970_s ? time_ns / kSecond_ns : 0;
    if (zero_s_ > 0) sink_.parameter("log_zero_unix_s", static_cast<double>(zero_s_));
  }
  return static_cast<double>(time_ns / kSecond_ns - zero_s_) + static_cast<double>(time_ns % kSecond_ns) * 1e-9;
}

void CsvRecords::take(const ImuSource& source, std::int64_t time_ns, ImuRecord record, std::uint64_t offset,
                      std::uint64_t line) {
  const auto& force = record.specific_force_mps2;
  if (!std::all_of(force.begin(), force.end(), [](double x) { return std::abs(x) <= kLargestReading; })) {
    if (notes_.wanted(CsvTroubleKind::value, offset))
      notes_.say(offset, in_line(line) + "the specific force is no number, the row is left out");
    return;
  }
  if (!std::all_of(record.rate_radps.begin(), record.rate_radps.end(),
                   [](double x) { return std::abs(x) <= kLargestReading; }))
    record.rate_radps = kAbsentAxes;
  if (!std::isfinite(record.temperature_degc)) record.temperature_degc = kAbsent;
  auto found = seen_.find(source.name);
  if (found == seen_.end()) {
    if (seen_.size() == kMostSources) {
      if (notes_.wanted(CsvTroubleKind::source, offset))
        notes_.say(offset, in_line(line) + "more than 256 sources, " + source.name + " is left out");
      return;
    }
    found = seen_.emplace(source.name, Seen{seen_.size()}).first;
    sink_.source(found->second.number, source);
  }
  Seen& seen = found->second;
  record.time_s = time_s(time_ns);
  if (record.time_s < seen.last_time_s && notes_.wanted(CsvTroubleKind::time, offset))
    notes_.say(offset, in_line(line) + "the time of " + source.name + " goes back by " +
                           std::to_string(seen.last_time_s - record.time_s) + " s, the record is handed on as it is");
  seen.last_time_s = record.time_s;
  sink_.record(seen.number, record);
  ++records_;
}

}  // namespace logs
}  // namespace PLUMB_ABI
}  // namespace plumb
