/// Which chips a log holds, and what each read over a span of time (private to src/review).
#pragma once

#include <vector>

#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// Sources of one device are one chip. What PX4 has chosen among its chips (sensor_combined, vehicle_acceleration) is a
/// chip only where nothing else is in the log.
std::vector<ChipSummary> chips_of(const LogDigest& digest);

/// Blocks of a source from `from` up to but not including `to` as one.
SourceBlock block_of(const SourceDigest& source, std::int64_t from, std::int64_t to);

/// Blocks from `from` up to but not including `to` as one, with the calibration of the chip; without records where the
/// chip has none there.
SourceBlock reading_of(const LogDigest& digest, const ChipSummary& chip, std::int64_t from, std::int64_t to);

double length_of(const Axes& v) noexcept;
Axes difference(const Axes& a, const Axes& b) noexcept;
/// Between two vectors, in degrees.
double angle_deg(const Axes& a, const Axes& b) noexcept;

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
