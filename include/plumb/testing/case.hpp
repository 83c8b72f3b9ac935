/// One test case for a monitor: an array, how it is watched, and what happens to it. Made by generators.hpp, judged by
/// laws.hpp, printed as a sentence with the scenario file that replays it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/core/config.hpp"
#include "plumb/core/units.hpp"
#include "plumb/health/health_monitor.hpp"
#include "plumb/scenario/scenario.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {

/// Stations at which a monitor is validated before anything happens; a fault's onset is counted behind them.
inline constexpr int kTrustStations = 8;
/// Blocks of samples at every station.
inline constexpr int kStationBlocks = 2;

/// Where the tool points from station to station.
enum class Walk : std::uint8_t {
  random,   ///< uniform on the sphere
  rolling,  ///< at one inclination, equal steps of toolface once round
  drilling  ///< one station a stand: inclination builds by 1 deg, toolface steps by the golden angle
};

struct Case {
  SensorArray array;
  MonitorConfig config;
  int stations = 12;                    ///< behind those of validation
  std::vector<scenario::Fault> faults;  ///< Clock::station; onset 1 = the first station behind those of validation
  double noise = 1.0;                   ///< times the array's
  double gravity_error = 0.0;           ///< true minus stated gravity, in sigmas of the reference (0.1 mg0)
  double calibration_mps2 = 0.0;        ///< 1 sigma of what calibration has left in every sensor, known to the monitor
  std::uint64_t seed = 1;               ///< of attitudes, noise and errors
  Walk walk = Walk::random;
  double inclination_rad = rad_from_deg(90.0);  ///< of a rolling tool, and of the first stand of a drilling one
};

/// Sensors that the case makes faulty at any time.
SensorSet faulty_of(const Case& c) noexcept;

/// What the simulator plays; raw values are m/s^2.
scenario::Scenario scenario_of(const Case& c);
/// What is stated to the monitor.
MonitorSetup setup_of(const Case& c);

/// "7 sensors, 12 stations: a2 reads 50 mg0 too much from station 3 on".
std::string sentence_of(const Case& c);
/// The scenario file, array included: `plumb simulate` replays it.
std::string toml_of(const Case& c);

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb
