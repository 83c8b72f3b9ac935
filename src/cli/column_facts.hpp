/// What the columns of a log did not hold, and what that does to a calibration.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fit_words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

struct ColumnFact {
  std::string column;              ///< name in the log
  std::string of;                  ///< id of the sensor, "temperature" or "roll_group"
  std::uint64_t rows_without = 0;  ///< rows in which it had no number
  std::uint64_t rows = 0;          ///< of so many
  bool dead = false;               ///< a sensor that said nothing, or the same in every row
  std::string words;
};

/// Columns that lacked something, in the order of the array file; then temperature and roll group.
std::vector<ColumnFact> column_facts(const CalibrationRun& run, const io::ArrayFile& array);

/// What a reader would have counted in these samples of `sensors` channels.
io::LogStatistics statistics_of(const std::vector<Sample>& samples, int sensors);

/// Whether a sensor said nothing in the whole log, or the same in every row.
bool dead_channel(const io::LogStatistics& log, int sensor);

/// The refusal of a log in which a channel is dead: no attitude mends that.
std::optional<Refusal> column_refusal(const CalibrationRun& run, const io::ArrayFile& array);

/// Temperatures that are hardly degC, as a question with the likely unit; empty where they are plausible.
std::string temperature_unit_words(const CalibrationRun& run, const io::ArrayFile& array);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
