/// A campaign as plain data: which tools, what may happen to them, how often, and what one scenario of it is. Nothing
/// here depends on the capacity, because the monitors that play the scenarios are built for the smallest one that fits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace plumb {
namespace campaign {

inline constexpr int kMostSensors = 24;
inline constexpr int kMostFaults = 8;      ///< of one scenario
inline constexpr int kMostStations = 64;   ///< of one scenario
inline constexpr int kMostSamples = 4096;  ///< at one station
inline constexpr int kMostBlocks = 256;    ///< of one scenario

/// A tool: where its sensors point and how they scatter. Its log is in volts.
struct ToolPlan {
  std::string name;
  int sensors = 0;
  std::array<std::array<double, 3>, kMostSensors> axis{};
  std::array<std::uint8_t, kMostSensors> chip{};       ///< alike for sensors that fail together; 0 = a unit of its own
  std::array<double, kMostSensors> sigma_mps2{};       ///< of one row
  std::array<double, kMostSensors> detectable_mps2{};  ///< MDB: missed by parity in one block in a thousand; 0 = none
  double volt_per_mps2 = 0.0;                          ///< scale factor, raw unit
  double resolution_raw = 0.0;                         ///< one code [V]; 0 = not known, nothing is rounded
  /// Of each sensor, the four figures of a `Stability` in their order; all zero: not stated.
  std::array<std::array<double, 4>, kMostSensors> stability{};
  int grade = 0;  ///< confirmed grade: faulty units that the monitor promises to bear

  /// The sensors of the chip that this one is on, itself among them, as bits.
  std::uint32_t unit_with(int sensor) const noexcept;
  int units() const noexcept;
};

enum class AttitudeKind : std::uint8_t { random, roll_test, drilling_path, fixed };

struct AttitudePlan {
  AttitudeKind kind = AttitudeKind::random;
  std::string name;
  double inclination_rad = 0.0;  ///< of a roll test; of the first station of a path
  double build_rad = 0.0, turn_rad = 0.0, toolface_step_rad = 0.0, toolface_jitter_rad = 0.0;  ///< of a path, per stand
  std::array<double, 3> direction{{0.0, 0.0, 1.0}};                                            ///< fixed
};

/// One kind of fault and how large it is. `kind` is a `scenario::FaultKind`.
struct FaultPlan {
  std::string name;
  bool healthy = false;    ///< nothing happens: what the false alarms are counted over
  bool whole_log = false;  ///< strikes no sensor of its own
  int kind = 0;
  double magnitude = 0.0, upper = 0.0;
  double duration_stations = 0.0;  ///< 0 = lasts
  /// Where not 0: a constant shift of so many MDB, of either sign; log-uniform between the two.
  double least_mdb = 0.0, most_mdb = 0.0;
};

/// What is the same for all scenarios of a cell.
struct Cell {
  int tool = 0, attitude = 0, fault = 0;
  int faulty = 0;               ///< units at fault: chips where the tool states them, else sensors
  double gravity_sigmas = 0.0;  ///< true gravity minus the configured one
};

enum class Start : std::uint8_t {
  validated,  ///< every scenario begins with a validated monitor
  power_on    ///< ... with one that has just been switched on
};

struct Plan {
  std::string name;
  /// The sensors are magnetometers: what is in m/s^2 here, gravity among it, is their field in units of 4 uT.
  bool magnetic = false;
  std::uint64_t seed = 1;
  std::uint64_t scenarios = 0;
  bool sweep = true;  ///< cell = number modulo cells; else drawn
  int stations = 8, samples = 32;
  double rate_hz = 100.0, move_s = 1.0;
  int first_onset = 1, last_onset = 1;  ///< station at which faults begin, counted from 1
  Start start = Start::validated;
  int validation_stations = 8;
  double gravity_mps2 = 9.80665, gravity_sigma_mps2 = 1e-3;
  double calibration_mps2 = 0.0;  ///< 1 sigma of what calibration left, known to the monitor; drawn within two
  double days_since_calibration = 0.0;
  int window = 32;                    ///< of the monitor, samples
  double alert_limit_rad = 0.0;       ///< of the monitor
  std::vector<std::uint8_t> monitor;  ///< the `MonitorConfig`, as `ArchiveWriter` writes it
  std::vector<ToolPlan> tools;
  std::vector<AttitudePlan> attitudes;
  std::vector<FaultPlan> faults;
  std::vector<Cell> cells;
};

/// A fault of one scenario; the fields of `scenario::Fault` with stations as its clock.
struct SpecFault {
  int kind = 0, sensor = 0;
  double onset_station = 1.0, duration_stations = 0.0;  ///< duration 0 = lasts
  double magnitude = 0.0, upper = 0.0;
};

/// One scenario, complete: what is played depends on nothing else but the plan.
struct Spec {
  std::uint64_t number = 0;
  std::uint64_t seed = 0;  ///< of attitudes, noise, errors and random faults
  int cell = 0, tool = 0, attitude = 0;
  int stations = 0;
  double gravity_sigmas = 0.0, calibration_mps2 = 0.0;
  double largest_mdb = 0.0;  ///< of a single constant shift; 0 = something else
  int faults = 0;
  std::array<SpecFault, kMostFaults> fault{};
};

/// Scenario `number` of the plan: counter-based, so any number may be asked for in any order.
Spec spec_of(const Plan& plan, std::uint64_t number);

/// Sensors of the spec that are faulty at any time, as bits: those of a chip together.
std::uint32_t faulty_of(const ToolPlan& tool, const Spec& spec) noexcept;

}  // namespace campaign
}  // namespace plumb
