/// What a log is judged by. Each figure with where it comes from; docs/review.md lists them (private to src/review).
#pragma once

#include <cstddef>

#include "plumb/core/config.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace review {

/// PX4 does not arm where two accelerometers differ by more (COM_ARM_IMU_ACC); ArduPilot by more than 0.75 m/s^2.
constexpr double kArmingLimit_mps2 = 0.7;
/// Half of that: before it comes to a refusal in the field.
constexpr double kCaution_mps2 = 0.35;
/// Gravity from the equator at 5 km height to the poles at sea level (WGS 84): 9.765 to 9.832 m/s^2.
constexpr double kEarthMiddle_mps2 = 9.7985;
constexpr double kEarthHalf_mps2 = 0.0335;
/// One chip is named where it differs from each other one at least this many times as much as they do among themselves.
constexpr double kNamingRatio = 2.0;
/// Two chips of a flight controller are not further apart than this: turning adds w^2 r and its change.
constexpr double kLeverArm_m = 0.1;
/// Cells on either side from which the scatter of differences is taken, and the fewest steps that tell it.
constexpr std::size_t kNearbyCells = 10;
constexpr std::size_t kFewestSteps = 4;
/// Cells are no longer: a chip that is slower than ten readings in one is not compared in motion.
constexpr double kLongestCell_s = 60.0;
/// More than this many chips are not judged: the work grows with their square.
constexpr std::size_t kMostChips = 24;
/// A block of one record that is further from all others has a wrong time.
constexpr double kStray_s = 60.0;
/// Times the median step that scatter is taken for.
constexpr double kScatterSteps = 2.5;
/// Cells on either side over which readings are averaged.
constexpr std::size_t kAveragedCells = 4;
/// Cells in a row that must tell the same in motion.
constexpr int kMotionRun = 5;
/// Readings that a window of time must have to be judged.
constexpr double kWindowReadings = 10.0;
/// A source is at rest where its scatter is at most this many times the least that it shows in the log, and no more
/// than the upper figure; below the lower one it always is.
constexpr double kStillRatio = 4.0;
constexpr double kStillAlways_mps2 = 0.05;
constexpr double kStillNever_mps2 = 0.3;
constexpr double kStillRate_radps = 0.2;
/// A step of the mean by more begins another stretch.
constexpr double kStretchStep_mps2 = 0.1;
constexpr double kShortestStretch_s = 3.0;
/// ArduPilot, "Measuring vibration": above 30 m/s^2 there may be problems, above 60 nearly always.
constexpr double kVibration_mps2 = 30.0;
constexpr double kStrongVibration_mps2 = 60.0;
/// There too: up to 100 clipped readings, of a landing for example, are no cause for concern.
constexpr double kClippedReadings = 100.0;
constexpr double kClippedShare = 0.01;
/// Scatter at rest of consumer sensors: 400 ug0/sqrt(Hz) (MPU-6000) over 1 kHz is 0.12 m/s^2; twice that.
constexpr double kScatter_mps2 = 0.25;
constexpr double kScatterRatio = 4.0;
constexpr double kScatterLeast_mps2 = 0.05;
/// A reading that wanders by more while nothing moves: 1 mg0/degC over 10 degC.
constexpr double kDrift_mps2 = 0.1;
/// Readings below this rate say nothing of vibration and noise.
constexpr double kFastHz = 20.0;
/// Readings in a row that do not change: PX4 takes 100 for a sensor that stands still.
constexpr double kUnchangedReadings = 100.0;
constexpr double kUnchangedInMotion = 20.0;
constexpr double kMotionSeen_mps2 = 0.5;
/// Attitudes further apart than this are different ones; chips that read gravity further apart are mounted differently.
constexpr double kAttitude_deg = 20.0;
/// Closer than this they are the same: an error of scale of 1 % then changes a reading by 0.02 m/s^2.
constexpr double kSameAttitude_deg = 10.0;
/// Two chips further apart in time than this see another motion in a filter that takes them as simultaneous: at 1 rad/s
/// 10 ms are half a degree, or 0.1 m/s^2 across gravity. Judged over the seconds with most motion.
constexpr double kSkew_s = 0.01;
constexpr double kSkewWindow_s = 10.0;
constexpr double kSkewMotion_mps2 = 0.3;
/// Records missing: a share of the log's time, and one gap.
constexpr double kLostShare = 0.01;
constexpr double kLongGap_s = 1.0;
/// A chip that says nothing for so long before the log ends has stopped.
constexpr double kStopped_s = 2.0;
/// Reports of an autopilot in a row: one alone may be of a start.
constexpr double kFailedReports = 3.0;
/// Calibrations that no sensor in order needs: PX4 accepts scales of 0.9 to 1.1; 2 m/s^2 is 200 mg0.
constexpr double kFarOffset_mps2 = 2.0;
constexpr double kFarScale = 0.1;

}  // namespace review
}  // namespace PLUMB_ABI
}  // namespace plumb
