/// Intervals by the profile of the likelihood (private to src/noise).
#pragma once

#include <array>

#include "likelihood.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Of the squares of the noise terms; `best` is the maximum. low = 0 where the likelihood does not exclude it.
using SquareIntervals = std::array<Interval, kNoiseTerms>;
SquareIntervals square_intervals(const Likelihood& likelihood, const Maximum& best);
/// Of the slope, where `walk_squares` is the interval of the square of the random walk. It allows for any walk that the
/// log does not exclude, and so holds more than 95 % where there is none.
Interval slope_interval(const Likelihood& likelihood, const Maximum& best, const Interval& walk_squares);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
