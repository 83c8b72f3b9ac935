/// Three gyro triads of which one may fail in any way: their median for the accelerometers, their parity for
/// themselves.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "flight_case.hpp"
#include "plumb/motion/median_rate.hpp"
#include "plumb/motion/rate_monitor.hpp"

namespace plumb_bench {

enum class GyroPlay : std::uint8_t { healthy, dead, stuck, scale, bias, drift, oscillation, noise, late, saturated };
inline constexpr int kGyroPlays = 10;
const char* to_string(GyroPlay play) noexcept;

struct ThreeGyroCase {
  FlightCase flight;  ///< its own gyros are not used
  GyroPlay play = GyroPlay::healthy;
  double arm_m = 0.03;  ///< of every accelerometer
  double onset_s = 1.5;
};

struct ThreeGyroOutcome {
  FlightOutcome accelerometers;
  double gyro_isolated_s = -1.0;  ///< after its onset; below 0: not
  bool gyro_wrongly_isolated = false;
  std::uint64_t rate_checks = 0, rate_violations = 0;  ///< of the bound of the rate that the gyros' monitor gives
  double worst_median_share = 0.0;                     ///< of the median's error in what T15 allows
};

ThreeGyroOutcome fly_three_gyros(const ThreeGyroCase& one);

}  // namespace plumb_bench
