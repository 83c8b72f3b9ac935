/// One simulated flight with a motion monitor on board: what it found, how fast, and whether its bound held.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "plumb/motion/motion_monitor.hpp"
#include "plumb/scenario/flight.hpp"

namespace plumb_bench {

/// How the sensors lie on the body.
enum class FlightArray : std::uint8_t { cone, triads };

struct FlightCase {
  plumb::scenario::FlightKind kind = plumb::scenario::FlightKind::drone;
  FlightArray array = FlightArray::cone;
  int sensors = 6;
  int gyros = 2;
  bool gyro_corroborated = false;
  int max_faults = plumb::kMotionDepth;
  int shortest_block = 1;
  double duration_s = 6.0;
  double arm_m = 0.0;         ///< of every sensor from the reference point; 0: 10 to 30 mm
  double error_factor = 1.0;  ///< on every width from which true errors are drawn, the limits stay
  std::uint64_t seed = 0;
  std::vector<plumb::scenario::FlightFault> faults;
  std::vector<plumb::scenario::GyroFault> gyro_faults;
};

/// Error of a force against its bound.
struct BoundTally {
  std::uint64_t checks = 0, violations = 0;
  double bound_sum_mps2 = 0.0, square_sum = 0.0;
};

struct FlightOutcome {
  double detected_s = -1.0;  ///< after the first onset; below 0: not
  double isolated_s = -1.0;  ///< after it, somebody who is faulty
  double excluded_s = -1.0;
  bool early_alarm = false;  ///< before any onset
  bool wrongly_isolated = false, wrongly_excluded = false;
  bool all_excluded = false;  ///< every faulty sensor
  plumb::MotionCause last_cause = plumb::MotionCause::none;
  BoundTally sample, block;
  BoundTally averaged;  ///< force of all sensors alike, blocks, no monitor: its error alone
};

/// What whoever judges a flight is told, and whom he may blame in it.
struct FlightBrief {
  plumb::SensorArray array;
  plumb::MotionSetup setup;
  plumb::SensorSet faulty;
  plumb::SensorSet may_blame;  ///< a chip goes as a whole
  double onset_s = 1e9;        ///< of the first fault
};
FlightBrief brief_of(const FlightCase& one);

/// What somebody says after a sample.
struct FlightFinding {
  bool alarm = false;
  plumb::SensorSet isolated, excluded;
};

/// Hands every sample of the flight over, with the truth behind it: the same flight for whoever judges.
using FlightJudge = std::function<void(const plumb::scenario::FlightSample& truth, const plumb::MotionSample& sample)>;
void feed(const FlightCase& one, const FlightJudge& judge);

/// Enters what was found at `time_s`.
void score(const FlightBrief& brief, double time_s, const FlightFinding& found, FlightOutcome* out);

/// Flies with a motion monitor on board.
FlightOutcome fly(const FlightCase& one);

/// What the monitor of these flights is told. Stated here, from data sheets; the simulator draws from a table of its
/// own.
plumb::MotionSetup stated_setup(const FlightCase& one, const std::vector<plumb::Vec3>& arms);

}  // namespace plumb_bench
