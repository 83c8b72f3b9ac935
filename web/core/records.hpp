/// What is kept of every sample: numbers in a row, each with a name that the page finds it by.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "plumb/core/sensor_set.hpp"
#include "plumb/core/vec3.hpp"

namespace plumb_web {

/// Places in a record, in the order of `record_names`; behind them `minimum_faults_1` and so on, of every sensor.
enum class At : std::uint8_t {
  time_s,
  station,
  moving,
  state,
  validity,
  cause,
  qualifiers,
  decided_by,
  statistic,
  limit,
  in_service,
  provisionally_excluded,
  excluded,
  absent,
  suspects,
  faulty,
  event,
  from,
  to,
  event_cause,
  event_sensors,
  error_rad,
  plain_rad,
  protection_rad,
  told_x,
  told_y,
  told_z,
  true_x,
  true_y,
  true_z,
  hypotheses,
  on_record,
  parity,
  parity_limit,
  mae_mps2,
  mae_limit_mps2,
  norm_error,
  wants_turn,
  confirmed_grade,
  provisional_grade,
  tick,
  alert,
  // Other rules on the same samples (rivals.hpp).
  paper_state,
  paper_validity,
  paper_out,
  paper_suspects,
  paper_error_rad,
  paper_statistic,
  px4_selector,
  px4_voter,
  px4_in_use,
  px4_error_rad,
  // In flight the error of the specific force, in place of that of down.
  force_error_mps2,
  force_bound_mps2,
  plain_force_mps2,
  px4_force_mps2,
  isolated,  ///< in every explanation; excluded after a dwell
};
inline constexpr std::size_t kCommonFigures = static_cast<std::size_t>(At::isolated) + 1;
inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

/// What stands where in a record.
const std::vector<std::string>& record_names();

/// FNV-1a over what was decided in these records and leaves no room for a last digit: states, causes, sets, events,
/// plumb's and the other rules'.
std::uint64_t decisions_of(const std::vector<double>& records);

/// One record; what nobody sets is no figure.
class Record {
 public:
  Record() { figure_.fill(kNothing); }
  template <class T>
  void set(At at, T value) {
    figure_[static_cast<std::size_t>(at)] = static_cast<double>(value);
  }
  void set(At at, plumb::SensorSet sensors) { set(at, sensors.bits); }
  /// Three places from this one on.
  void set(At at, const plumb::Vec3& v) {
    for (std::size_t k = 0; k < 3; ++k) figure_[static_cast<std::size_t>(at) + k] = v[k];
  }
  void minimum_faults(std::size_t sensor, int faults) { figure_[kCommonFigures + sensor] = faults; }
  void append_to(std::vector<double>& records) const { records.insert(records.end(), figure_.begin(), figure_.end()); }

 private:
  std::array<double, kCommonFigures + static_cast<std::size_t>(plumb::kCapacity)> figure_{};
};

}  // namespace plumb_web
