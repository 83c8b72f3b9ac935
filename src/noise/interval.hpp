/// Intervals by the profile of the likelihood (private to src/noise).
#pragma once

#include <cstddef>

#include "likelihood.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// Of the square of a noise term; `best` is the maximum. low = 0 where the likelihood does not exclude it.
Interval square_interval(const Likelihood& likelihood, const Maximum& best, std::size_t term);
/// Of the slope, where `walk_squares` is the interval of the square of the random walk.
Interval slope_interval(const Likelihood& likelihood, const Maximum& best, const Interval& walk_squares);

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
