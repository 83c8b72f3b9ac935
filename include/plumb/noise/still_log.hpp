/// A log at rest as the study of noise needs it: readings on an even grid of time, without gaps and knocks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct LogColumn {
  std::string name;
  std::vector<double> readings;  ///< one a row; not finite: none was delivered
};

struct StillLog {
  std::vector<double> time_s;  ///< of each row, increasing; empty: rows are 1/rate_hz apart
  double rate_hz = 0.0;
  std::vector<LogColumn> columns;
};

/// What stands in the way of one even stretch.
enum class BreakCode : std::uint8_t {  // in the order of Stretch::breaks
  gap,                                 ///< rows are missing: value = seconds without a row
  silent,                              ///< the column delivers nothing: value = seconds
  motion,                              ///< it moves: value = scatter or step over one second, in units of the usual one
};
const char* to_string(BreakCode code) noexcept;

struct Break {
  BreakCode code = BreakCode::gap;
  double time_s = 0.0;  ///< where
  double value = 0.0;
};

inline constexpr std::size_t kBreakCodes = 3;

/// Breaks of one kind.
struct Breaks {
  std::size_t count = 0;
  Break first;
  Break worst;  ///< of the largest value
};

/// Why a column has no stretch to judge.
enum class Refused : std::uint8_t {
  no,
  constant,   ///< all its readings are alike: no noise is seen
  too_short,  ///< fewer than kLeastReadings in a row at rest
  no_rate,    ///< time stands still or holds no even step
};
const char* to_string(Refused refused) noexcept;

struct Stretch {
  Refused refused = Refused::no;
  std::vector<double> readings;  ///< evenly spaced
  double period_s = 0.0;
  double begin_s = 0.0;  ///< time of the first reading
  /// Part of the steps of time that are off by more than half a step; above kIrregular no row counts as missing alone.
  double irregular = 0.0;
  std::size_t filled = 0;                  ///< readings that were missing alone, taken from their neighbours
  std::size_t rows = 0;                    ///< of the whole log
  std::array<Breaks, kBreakCodes> breaks;  ///< in the whole log, by code
  double resolution = 0.0;  ///< the least difference of two readings, where they are few; 0: they are many

  const Breaks& breaks_of(BreakCode code) const noexcept { return breaks[static_cast<std::size_t>(code)]; }
};
inline constexpr double kIrregular = 0.02;

/// The longest stretch of that column that is at rest and without a gap. Up to five missing rows are filled. Rest is
/// judged by the column itself: the scatter within a second and the step to the next one against their medians.
Stretch longest_stretch(const StillLog& log, std::size_t column);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
