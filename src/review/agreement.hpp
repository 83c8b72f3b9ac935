/// Do the chips agree, and which one does not (private to src/review).
#pragma once

#include <vector>

#include "plumb/review/log_review.hpp"
#include "timeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// Gravity as far as it is known.
struct GravityKnown {
  double middle_mps2 = 0.0, half_mps2 = 0.0;
};

/// What one chip read at rest, and the 95 % uncertainty of its length.
struct Reading {
  bool there = false;
  Axes mean_mps2{};
  double allowed_mps2 = 0.0;
};

/// Chips side by side: what each read, and what two of them may differ by for reasons that are no fault.
struct Comparison {
  std::vector<Reading> readings;
  std::vector<double> allowed_mps2;  ///< of chips i and j at i * size + j

  double allowed(std::size_t i, std::size_t j) const { return allowed_mps2[i * readings.size() + j]; }
};

/// What a cell says.
struct Opinion {
  bool compared = false;  ///< two chips or more
  bool disagree = false;
  double figure_mps2 = 0.0;    ///< the largest difference of two, or of the named one from the nearest other
  double allowed_mps2 = 0.0;   ///< of that pair
  std::size_t chip = kNoChip;  ///< the one that is named; kNoChip where two or more may be wrong
  std::size_t first = kNoChip, second = kNoChip;  ///< the pair of the largest difference
  bool told_by_length = false;
};

/// Pure: one cell, without what came before. A chip is named where it differs from all others, kNamingRatio times as
/// much as they do among themselves; of two, where one has the length of gravity and the other's length explains the
/// difference.
Opinion opinion_of(const Comparison& chips, const GravityKnown& gravity, bool at_rest);

/// Of a cell at rest.
std::vector<Reading> readings_of(const Cell& cell);

void judge_rest(const std::vector<Cell>& cells, const LogDigest& digest, const GravityKnown& gravity, LogReview& out);
void judge_motion(const std::vector<Cell>& cells, const LogDigest& digest, const GravityKnown& gravity, LogReview& out);

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
