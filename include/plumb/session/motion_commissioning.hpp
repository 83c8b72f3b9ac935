/// From an array file, its calibration and a log in motion to the section `motion` of a calibration file, or to why
/// there is none: what `plumb calibrate --motion` does.
#pragma once

#include <cstdint>
#include <string>

#include "plumb/commission/array_commission.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/session/log_spec.hpp"
#include "plumb/session/motion_inputs.hpp"
#include "plumb/session/motion_plan.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

/// Parity needs four axes, whatever their directions.
inline constexpr int kLeastCommissioned = 4;
/// Rows that are kept in memory, five minutes at 1 kHz.
inline constexpr std::uint64_t kMostCommissionRows = 300000;

/// Why a log in motion was not accepted.
enum class MotionRefusal : std::uint8_t {
  none,
  irregular_time,  ///< value: steps that are not a period, limit: rows
  no_rates,        ///< a row without a rate; value: such rows
  rates_in_deg,    ///< value: the largest rate, or how much better the rates fit as deg/s
  gyro_still,      ///< the rate of a gyro stands still; value: seconds, limit: from when on, `gyro`: which
  rate_noise,      ///< value: how two gyros scatter against each other, limit: the most
  clipped,         ///< sensors; value: share of the block pairs that it costs
  filtered,        ///< value: scatter from sample to sample in stated sigmas
  too_short,       ///< value: seconds, limit: those needed
  fault,           ///< sensors contradict the others whatever lag; value: when
  open,            ///< the motion leaves something open that the file does not state
  calibration,     ///< sensors: scale, axis or bias beyond what calibration and file leave
  gyro,            ///< beyond what the file states of it
  gyros_disagree,  ///< beyond their bounds; value: when
  gyro_unbounded,  ///< its bound would be beyond all that may be stated; value, limit
  beyond_stated,   ///< sensors: lag or rectification beyond the stated bound; value, limit
  held_out_alarm,  ///< the monitor contradicts the held-out part; sensors, value: when
  held_out,        ///< the fit predicts the held-out part badly; value: times its own residual
};

struct MotionCommissioning {
  MotionRefusal refusal = MotionRefusal::none;
  SensorSet sensors;  ///< of the refusal
  double value = 0.0, limit = 0.0;
  int gyro = 0;          ///< of the refusal
  const char* key = "";  ///< of the array file: whose bound is passed

  std::uint64_t rows = 0, fitted_rows = 0;  ///< the others were held out
  double duration_s = 0.0;
  MotionInputs inputs;
  bool fitted = false;  ///< what follows is known
  commission::ArrayFit fit;
  std::array<bool, kCapacity> lever_stated{}, lag_stated{}, rectification_stated{};
  double lag_needed_s = 0.0;  ///< beyond what was fitted; 0: none
  std::size_t held_out_judged = 0;
  double held_out_mps2 = 0.0;      ///< residual of the held-out part by the fit
  double held_out_own_mps2 = 0.0;  ///< and by a fit of its own
  MotionSetup setup;               ///< with which `plumb monitor` will judge
  io::MotionCalibration found;     ///< to be written
};

/// Errors: files that cannot be read, keys that are missing, arrays that cannot be judged in motion. `days` since the
/// calibration.
io::FileExpected<MotionCommissioning> run_motion_commissioning(const io::ArrayFile& array,
                                                               const io::CalibrationFile& calibration, double days,
                                                               const LogSpec& log);

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
