/// Why a run of the monitor judged nothing: the log is read once more, and looked at.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/findings/log_diagnosis.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

enum class NothingJudged : std::uint8_t {
  too_few_sensors,       ///< in most rows fewer than three have a number
  rows_are_stations,     ///< and a block has several rows
  too_short,             ///< fewer rows than a block has
  rows_without_numbers,  ///< they leave no stretch that is long enough for a block
  unknown_rotation,      ///< it turns, and the lever arms are not known
  full_scale,            ///< fewer than three sensors are within their range in most rows
  never_at_rest,         ///< the rows say how: `log`
};

struct NothingJudgedStudy {
  NothingJudged cause = NothingJudged::never_at_rest;
  std::uint64_t rows = 0;
  std::uint64_t rows_empty = 0;    ///< without a number from any sensor: each of them begins a block anew
  std::uint64_t longest_run = 0;   ///< of rows between those
  std::uint64_t rows_lacking = 0;  ///< without a number from some sensor, the empty ones among them
  SensorSet sensors;               ///< that have no number, or are at full scale, in most rows
  std::vector<Finding> log;        ///< of the rows against the array file
};

/// Takes the rows of the log in order.
class NothingJudgedStudent {
 public:
  explicit NothingJudgedStudent(const io::ArrayFile& array) : array_(&array), diagnosis_(array) {}
  void add(const Sample& sample, bool turning);
  NothingJudgedStudy study() const;

 private:
  /// Sensors for which this many rows are more than half.
  SensorSet mostly(const std::array<std::uint64_t, kCapacity>& rows) const;

  const io::ArrayFile* array_;
  LogDiagnosis diagnosis_;
  std::uint64_t rows_ = 0, turning_ = 0;
  std::uint64_t rows_empty_ = 0, rows_lacking_ = 0, run_ = 0, longest_run_ = 0;
  std::array<std::uint64_t, kCapacity> empty_{}, clipped_{};
};

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
