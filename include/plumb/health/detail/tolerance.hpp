/// How far the mean of a block may be off for what does not average out over its samples: drift since the calibration,
/// and rounding to steps.
#pragma once

#include "plumb/detection/stationarity.hpp"
#include "plumb/health/detail/in_force.hpp"
#include "plumb/health/detail/settings.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Stability at the temperature of now, `lag` behind it [degC/min], and on top what the first attitudes asked for.
void allow_for_drift(const Settings& settings, const InForce& in_force, double temperature_degc,
                     double lag_degc_per_min, float learned_mps2, BlockEvidence& evidence) noexcept;

/// Where noise reaches from one step to the next rounding averages out and is noise itself, a twelfth of the square of
/// a step; where it does not, the mean may be off by half a step for as long as the tool stays.
void allow_for_steps(const Settings& settings, const SensorArray& array, const BlockAccumulator& block,
                     SensorSet in_service, BlockEvidence& evidence) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
