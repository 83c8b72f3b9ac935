/// Which false-alarm rate the limits of parity and norm keep once a calibration stands behind them (docs/theory.md,
/// section 3.6).
#pragma once

#include <cstdint>

#include "plumb/core/config.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// A calibration errs by the same amount at every block of an attitude, so a rate can be kept in two senses.
enum class AlarmForm : std::uint8_t {
  /// At most the rate in every single tool: noise limit plus the bound on what is systematic. The same floor as that of
  /// the tests that reject hypotheses, so that no alarm is raised which nothing could ever explain.
  every_tool,
  /// The rate on average over tools that are calibrated alike: noise and systematic errors are one variance. More
  /// sensitive; an unlucky tool alarms more often than the rate at the attitudes at which its calibration errs.
  average_tool
};

/// `test` (of `set`, at `block`) with parity and norm in standard deviations of noise, calibration and gravity
/// together: r' (I + N V C_cal V')^-1 r over the whitened parity rows V, and (|x| - G) over the root of
/// s_T^2/N + u'C_x u + sigma_g^2. What is left of the bounds is the motion inside the block, which has one sign, and
/// the acceleration that the host allows for, which is no draw from anything. A test that was not made is returned as
/// it is.
SetTest in_quadrature(const SensorArray& array, const GravityReference& gravity, const BlockEvidence& block,
                      SensorSet set, const SetTest& test, double acceleration_mps2 = 0.0) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
