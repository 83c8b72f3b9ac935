/// When a fit settles, damps, gives up and looks for outliers: the same at one temperature and over many. Private to
/// the calibration room.
#pragma once

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace limits {

inline constexpr int kMaxMisfitRounds = 4;
/// Chi^2 this near to its degrees of freedom is left alone: its own scatter is far larger.
inline constexpr double kMisfitTolerance = 0.01;
/// A rise of the cost within its own rounding is not a rise.
inline constexpr double kCostTolerance = 1e-9;
/// Rises in a row that are let pass. Where stations are few the optimum lies in a narrow curved valley: a
/// step along it first rises, the next falls back into the valley further on. Damping would crawl.
inline constexpr int kMostRises = 4;
inline constexpr int kPriorTurns = 3;  ///< an iteration
inline constexpr double kFirstDamping = 1e-3;
inline constexpr double kMaxDamping = 1e9;
/// While outliers are looked for a step of this size, in prior sigmas, is the end: the set counts, not the digits.
inline constexpr double kLooselySettled = 1e-4;
inline constexpr double kMisfitSettled = 0.05;
inline constexpr int kHuberSteps = 30;
inline constexpr int kTukeySteps = 20;
/// While Huber still carries what the outliers did to the fit, the median of the residuals is too high.
inline constexpr double kFirstShare = 0.49;
/// Fewer degrees of freedom have no median to speak of.
inline constexpr int kScreenFreedom = 6;

}  // namespace limits
}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
