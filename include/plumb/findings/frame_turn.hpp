/// A turn of all calibrated axes together. Gravity does not show it (docs/theory.md, section 1.6): a fit leaves the
/// axes where the datasheet's are on average, and stations of known attitude say how the housing lies to them.
#pragma once

#include <vector>

#include "plumb/calibration/calibration.hpp"
#include "plumb/findings/unseen_wiring.hpp"
#include "plumb/io/array_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {

/// Turns are rotation vectors: the axis times the angle [rad], tool frame. The inverse of a covariance.
using TurnInformation = Mat3;

/// What the datasheet knows of a turn of all its axes, each by its prior: the part across itself.
TurnInformation information_of_axes(const Datasheet& datasheet) noexcept;

/// Of the fit: with roll groups their part across the roll axis, and the datasheet's about it; else the datasheet's.
/// Null: no fit.
TurnInformation information_of(const Datasheet& datasheet, const FitReport* fit) noexcept;

/// x with m x = v; zero where m is not positive definite.
Vec3 solved(const TurnInformation& m, const Vec3& v) noexcept;

/// The turn by which the axes of `fitted` lie from those of the datasheet on average, by the priors.
Vec3 turn_from_datasheet(const Datasheet& datasheet, const SensorArray& fitted) noexcept;

/// The turn that takes the axes of the fit to where stations of known attitude, and what else is known, put those of
/// the housing. Identity where there is none, and where the fit's own information excludes the turn, to all but the
/// integrity risk: the stations contradict the fit then.
Mat3 turn_into_housing(const io::ArrayFile& array, const FitReport& fit,
                       const std::vector<MeasuredAttitude>& measured) noexcept;

/// Axes, and their covariance. Readings, residuals and angles between axes stay as they are.
void apply_turn(const Mat3& turn, Calibration& calibration) noexcept;

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
