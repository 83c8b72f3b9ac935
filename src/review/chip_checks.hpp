/// What a chip shows by itself (private to src/review). Each adds its findings to the review.
#pragma once

#include <vector>

#include "agreement.hpp"
#include "plumb/review/log_review.hpp"
#include "timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// The length of what a chip reads at rest: the stretch where it is furthest from gravity.
void check_length(const std::vector<Cell>& rest, double block_s, const GravityKnown& gravity, LogReview& out);
/// Scatter at rest, against the class of consumer sensors and the other chips. Sets `scatter_mps2`.
void check_noise(const std::vector<Cell>& rest, const LogDigest& digest, LogReview& out);
/// The first third of a stretch against its last: against the other chips where there are three, else the length.
void check_drift(const std::vector<Span>& rest, const LogDigest& digest, LogReview& out);
/// Stretches of one attitude: what a chip reads in a later one against the first.
void check_change(LogReview& out);
/// Vibration and clipping. Sets `vibration_mps2`.
void check_vibration(const std::vector<Cell>& motion, const LogDigest& digest, LogReview& out);
void check_clipping(const LogDigest& digest, LogReview& out);
/// Axes and chips that stand still.
void check_stuck(const LogDigest& digest, LogReview& out);
/// Gaps, clocks that go back, chips that stop.
void check_times(const LogDigest& digest, LogReview& out);
void check_calibration(const LogDigest& digest, LogReview& out);
/// What the autopilot itself says: chips that it took for failed, its comparison at rest of those that nothing else is
/// found of, vibration of those that are read too rarely. After all other checks.
void check_autopilot(const std::vector<Span>& rest, const LogDigest& digest, LogReview& out);

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
