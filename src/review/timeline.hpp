/// When the vehicle stood still, and the cells of time in which chips are compared while it moved (private to
/// src/review).
#pragma once

#include <cstdint>
#include <vector>

#include "plumb/review/log_review.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// Blocks from `from` up to but not including `to`.
struct Span {
  std::int64_t from = 0, to = 0;
};

/// Spans at rest of kShortestStretch_s or more, in order. A window is at rest where most of the sources that are fast
/// enough to tell show little more than their least scatter, and their mean stays where it was.
std::vector<Span> spans_at_rest(const LogDigest& digest);

/// What chips read within a span: NaN and 0 where a chip has too few readings.
struct Cell {
  Span span;
  bool at_rest = false;
  std::vector<SourceBlock> readings;  ///< by chip
  double rate_squares = 0.0;          ///< rad^2/s^2, of the gyro that shows most, whichever message it is in
};

/// The log outside of `rest`, cut into cells of so many blocks that the slowest chip has kWindowReadings in one.
std::vector<Cell> cells_in_motion(const LogDigest& digest, const std::vector<ChipSummary>& chips,
                                  const std::vector<Span>& rest);
/// One cell for each span at rest.
std::vector<Cell> cells_at_rest(const LogDigest& digest, const std::vector<ChipSummary>& chips,
                                const std::vector<Span>& rest);

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
