#include "plumb/session/motion_commissioning.hpp"

#include <algorithm>
#include <cmath>

#include "motion_flight.hpp"
#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using commission::ArrayFit;
using commission::ArrayOnBoard;
using commission::ArrayPairs;
using commission::Estimate;

static_assert(commission::kBoundSigmas == kMotionSigmas);

/// Of the rows; the others check the fit.
constexpr double kFittedShare = 2.0 / 3.0;
/// What counts of a gyro of which the file states nothing.
constexpr GyroErrors kUnknownGyro{0.03, 0.03, 0.05, 0.0, 1e-3};
/// Shares of the rows, or of the block pairs, that a log may lose.
constexpr double kMostIrregular = 0.01, kMostLost = 0.1;
/// As in the notes of `plumb monitor`: beyond what gyros measure.
constexpr double kMostRate_radps = 4000.0 * kPi / 180.0;
/// Noise of two gyros against each other: times the stated one, and where none is stated.
constexpr double kMostNoise = 5.0, kMostNoise_radps = 0.05;
/// A gyro has noise: as in the notes of `plumb monitor`.
constexpr double kStill_s = 1.0;
/// As far as `plumb::check` takes bounds of a gyro.
constexpr double kMostGyroBound = 0.4;
/// White noise of the stated size has a scatter of 1; vibration adds to it.
constexpr double kLeastScatter = 0.5;
/// rms of the held-out part by the fit, over that by a fit of its own.
constexpr double kMostHeldOut = 1.5;
/// Another unit of the rates fits better by more than this.
constexpr double kBetterUnit = 2.0;

io::FileError refused(const io::ArrayFile& array, const char* field, const std::string& what,
                      const std::string& remedy) {
  return {array.path, 0, field, what, remedy, io::ExitCode::invalid_input};
}

std::optional<io::FileError> unfit(const io::ArrayFile& array) {
  const int n = array.array.size();
  if (!array.motion.clocks.empty())
    return refused(array, "clock[1]", "states a clock of its own, and a fit in motion takes sensors on one clock",
                   "fit a log in which all chips sample together, with an array file without [[clock]], or state "
                   "lever arms, lags and rectification with their bounds");
  if (!array.motion.gyro.group.empty())
    return refused(
        array, "gyro.group", "gives the rate of a group, and a fit in motion reads that of one gyro",
        "fit with an array file that names the columns of one gyro in [input] rotation_radps; what it finds of "
        "the accelerometers counts beside the group too");
  if (array.input.rotation_columns.empty())
    return refused(array, "input.rotation_radps", "is missing, and lever arms show only by the rates of a gyro",
                   "log the rates of a gyro and name their columns: rotation_radps = [\"wx\", \"wy\", \"wz\"]");
  if (n < kLeastCommissioned || n > kMotionCapacity)
    return refused(array, "sensor",
                   "has " + std::to_string(n) + " sensors, and a fit in motion takes " +
                       std::to_string(kLeastCommissioned) + " to " + std::to_string(kMotionCapacity),
                   "describe the sensors that belong together in a file of their own");
  return std::nullopt;
}

/// What stands for the figures until they are found.
io::MotionCalibration unknown(const io::ArrayFile& array) {
  io::MotionCalibration out;
  out.gyros = array.input.second_rotation_columns.empty() ? 1 : 2;
  out.gyro = kUnknownGyro;
  out.lever_arms_stated = !array.lever_arm_m.empty();
  for (int i = 0; i < array.array.size(); ++i) {
    io::MotionCalibration::Sensor& one = out.sensor.emplace_back();
    if (!array.lever_arm_m.empty()) one.stated_lever_arm_m = array.lever_arm_m[static_cast<std::size_t>(i)];
    one.lever_arm_m = one.stated_lever_arm_m;
  }
  return out;
}

ArrayOnBoard on_board_of(const io::ArrayFile& array, const MotionPlan& plan) {
  ArrayOnBoard out;
  out.array = plan.array;
  out.setup = plan.setup;
  for (std::size_t k = 0; k < static_cast<std::size_t>(array.array.size()); ++k) {
    const io::MotionBounds& b = array.motion.sensor[k];
    out.lever_bound_m[k] = array.lever_arm_m.empty() ? -1.0 : b.lever_arm_m.value_or(-1.0);
    out.lag_bound_s[k] = b.lag_s.value_or(-1.0);
    out.rectification_bound[k] = b.rectification_per_mps2.value_or(-1.0);
  }
  return out;
}

/// One run, step by step; each refuses or goes on.
class Commissioner {
 public:
  Commissioner(const io::ArrayFile& array, const io::CalibrationFile& calibration, double days, const MotionPlan& plan,
               const MotionFlight& flight)
      : array_(array),
        calibration_(calibration),
        days_(days),
        flight_(flight),
        on_board_(on_board_of(array, plan)),
        split_(static_cast<std::size_t>(kFittedShare * static_cast<double>(flight.samples.size()))) {
    out_.rows = flight.samples.size();
    out_.fitted_rows = split_;
    out_.inputs = flight.inputs;
    if (!flight.samples.empty()) out_.duration_s = flight.samples.back().time_s - flight.samples.front().time_s;
    for (std::size_t k = 0; k < static_cast<std::size_t>(array.array.size()); ++k) {
      out_.lever_stated[k] = on_board_.lever_bound_m[k] >= 0.0;
      out_.lag_stated[k] = on_board_.lag_bound_s[k] >= 0.0;
      out_.rectification_stated[k] = on_board_.rectification_bound[k] >= 0.0;
    }
  }

  io::FileExpected<MotionCommissioning> run() {
    if (!inputs_sound() || !fit_first_part()) return out_;
    const io::FileExpected<void> bounded = bound();
    if (!bounded) return tl::unexpected<io::FileError>(bounded.error());
    if (out_.refusal == MotionRefusal::none && judge_fit()) judge_held_out();
    return out_;
  }

 private:
  bool refuse(MotionRefusal why, double value = 0.0, double limit = 0.0, SensorSet sensors = {}) {
    out_.refusal = why;
    out_.value = value, out_.limit = limit;
    out_.sensors = sensors;
    return false;
  }

  bool refuse_stated(MotionRefusal why, const char* key, double value, double limit, SensorSet sensors = {}) {
    out_.key = key;
    return refuse(why, std::fabs(value), limit, sensors);
  }

  bool inputs_sound() {
    const MotionInputs& in = flight_.inputs;
    const double rows = static_cast<double>(in.rows),
                 irregular = static_cast<double>(in.steps_irregular + in.steps_back);
    if (in.period_is_another || irregular > kMostIrregular * rows)
      return refuse(MotionRefusal::irregular_time, irregular, rows);
    const double stated = on_board_.setup.rate_bound_radps, most = stated > 0.0 ? stated : kMostRate_radps;
    for (std::size_t g = 0; g < static_cast<std::size_t>(on_board_.setup.gyros); ++g) {
      if (static_cast<double>(in.gyro[g].missing) > kMostLost * rows)
        return refuse(MotionRefusal::no_rates, static_cast<double>(in.gyro[g].missing), rows);
      if (in.gyro[g].still_s >= kStill_s) {
        out_.gyro = static_cast<int>(g);
        return refuse(MotionRefusal::gyro_still, in.gyro[g].still_s, in.gyro[g].still_from_s);
      }
      if (in.gyro[g].largest_radps > most) return refuse(MotionRefusal::rates_in_deg, in.gyro[g].largest_radps, most);
    }
    const std::optional<double>& noise_radps = array_.motion.gyro.noise_radps;
    const double most_noise = noise_radps ? kMostNoise * *noise_radps : kMostNoise_radps;
    const double noise = on_board_.setup.gyros == 2 ? commission::gyro_noise_radps(flight_.samples, 2) : 0.0;
    if (noise > most_noise) return refuse(MotionRefusal::rate_noise, noise, most_noise);
    const double scatter = commission::scatter_in_sigmas(on_board_.array, flight_.samples);
    return scatter >= kLeastScatter || refuse(MotionRefusal::filtered, scatter, kLeastScatter);
  }

  bool fit_first_part() {
    const ArrayPairs pairs(on_board_, flight_.samples, 0, split_, settings_.scale);
    const double given = pairs.size();
    if (pairs.incomplete() > kMostLost * (given + pairs.incomplete()))
      return refuse(MotionRefusal::clipped, pairs.incomplete() / (given + pairs.incomplete()), kMostLost,
                    flight_.clipped);
    const int needed = commission::pairs_needed(on_board_);
    const double block_s = on_board_.setup.sample_period_s * kMotionSamples[static_cast<std::size_t>(settings_.scale)];
    // The held-out part, half as long, is fitted once more for comparison.
    if (given < 2.0 * needed)
      return refuse(MotionRefusal::too_short, out_.duration_s, block_s * (2.0 * needed + 2.0) / kFittedShare);
    const auto fit = commission::fit_array(on_board_, pairs, settings_);
    if (!fit) return refuse(MotionRefusal::too_short, out_.duration_s, block_s * (2.0 * needed + 2.0) / kFittedShare);
    out_.fit = *fit;
    out_.fitted = true;
    const double as_deg = residual_as_deg();
    return as_deg * kBetterUnit >= fit->residual_mps2 ||
           refuse(MotionRefusal::rates_in_deg, fit->residual_mps2 / as_deg, kBetterUnit);
  }

  /// Of a fit with the rates taken as deg/s.
  double residual_as_deg() const {
    std::vector<MotionSample> samples(flight_.samples.begin(),
                                      flight_.samples.begin() + static_cast<std::ptrdiff_t>(split_));
    for (MotionSample& sample : samples) {
      for (Vec3& rate : sample.rate_radps) rate = scaled(rate, kPi / 180.0);
    }
    const auto fit =
        commission::fit_array(on_board_, ArrayPairs(on_board_, samples, 0, samples.size(), settings_.scale), settings_);
    return fit ? fit->residual_mps2 : HUGE_VAL;
  }

  io::FileExpected<MotionPlan> plan() const {
    return plan_motion(array_, &calibration_.calibration, days_, &out_.found);
  }

  /// Bounds of what was fitted, and of the lag that the monitor needs beside.
  io::FileExpected<void> bound() {
    // The rows that check the fit have no say in its bounds.
    const std::vector<MotionSample> fitted(flight_.samples.begin(),
                                           flight_.samples.begin() + static_cast<std::ptrdiff_t>(split_));
    const commission::ArrayBounds bounds = commission::bounds_of(on_board_, out_.fit, fitted, rule_);
    out_.found = unknown(array_);
    out_.found.gyro = bounds.gyro;
    for (std::size_t k = 0; k < out_.found.sensor.size(); ++k) {
      io::MotionCalibration::Sensor& one = out_.found.sensor[k];
      const auto& arm = out_.fit.arm_m[k];
      one.lever_arm_m = bounds.lever_arm_m[k];
      one.lever_arm_sigma_m = {arm[0].sigma, arm[1].sigma, arm[2].sigma};
      one.lever_arm_bound_m = bounds.lever_m[k];
      one.lag_s = out_.fit.lag_s[k].value, one.lag_sigma_s = out_.fit.lag_s[k].sigma;
      one.lag_bound_s = bounds.lag_s[k];
      one.rectification_per_mps2 = out_.fit.rectification[k].value;
      one.rectification_sigma_per_mps2 = out_.fit.rectification[k].sigma;
      one.rectification_bound_per_mps2 = bounds.rectification[k];
    }
    for (const auto& [key, value] :
         {std::pair("gyro.scale_bound", bounds.gyro.scale), std::pair("gyro.axis_bound_rad", bounds.gyro.axis_rad)}) {
      if (value <= kMostGyroBound) continue;
      refuse_stated(MotionRefusal::gyro_unbounded, key, value, kMostGyroBound);
      return {};
    }
    io::FileExpected<MotionPlan> now = plan();
    if (!now) return tl::unexpected<io::FileError>(now.error());
    out_.lag_needed_s = commission::lag_needed_s(now->array, now->setup, flight_.samples, 0, split_);
    if (out_.lag_needed_s < 0.0) {
      name_fault(*now);
      return {};
    }
    for (io::MotionCalibration::Sensor& one : out_.found.sensor)
      one.lag_bound_s = std::fmax(one.lag_bound_s, rule_.lag_factor * out_.lag_needed_s);
    now = plan();
    if (!now) return tl::unexpected<io::FileError>(now.error());
    array_in_motion_ = now->array;
    out_.setup = now->setup;
    return {};
  }

  void name_fault(const MotionPlan& plan) {
    const commission::Replay seen = commission::replayed(plan.array, plan.setup, flight_.samples, 0, split_);
    refuse(MotionRefusal::fault, seen.alarm_s, 0.0, seen.isolated.empty() ? seen.suspects : seen.isolated);
  }

  bool judge_fit() {
    const ArrayFit& fit = out_.fit;
    SensorSet beyond;
    double most = 1.0;
    for (std::size_t k = 0; k < out_.found.sensor.size(); ++k) {
      const MotionErrors& e = out_.setup.errors[k];
      for (const double ratio :
           {over(fit.scale[k], e.scale), over(fit.axis_rad[k], e.axis_rad), over(fit.bias_mps2[k], e.bias_mps2)}) {
        if (ratio <= most) continue;
        most = ratio;
        beyond = SensorSet::of(static_cast<int>(k));
      }
    }
    if (!beyond.empty()) return refuse(MotionRefusal::calibration, most, 1.0, beyond);
    return judge_gyros(0, split_) && judge_stated() && judge_open();
  }

  bool judge_gyros(std::size_t first, std::size_t end) {
    const commission::Replay seen = commission::replayed(array_in_motion_, out_.setup, flight_.samples, first, end);
    return !seen.gyros_disagree || refuse(MotionRefusal::gyros_disagree, seen.gyros_disagree_s);
  }

  /// How far an estimate is beyond a bound, over that bound, at three sigma; 1 where it is not.
  static double over(const Estimate& found, double bound) {
    const double least = std::fabs(found.value) - kMotionSigmas * found.sigma;
    return least > bound ? least / std::fmax(bound, 1e-12) : 1.0;
  }

  bool judge_stated() {
    const io::GyroSpec& gyro = array_.motion.gyro;
    for (std::size_t k = 0; k < 9; ++k) {
      const std::optional<double>& stated = k % 4 == 0 ? gyro.scale : gyro.axis_rad;
      if (stated && over(out_.fit.gyro[k], *stated) > 1.0)
        return refuse_stated(MotionRefusal::gyro, k % 4 == 0 ? "gyro.scale_bound" : "gyro.axis_bound_rad",
                             out_.fit.gyro[k].value, *stated);
    }
    for (std::size_t k = 0; k < out_.found.sensor.size(); ++k) {
      const SensorSet one = SensorSet::of(static_cast<int>(k));
      const double lag_s = on_board_.lag_bound_s[k], rectified = on_board_.rectification_bound[k];
      if (lag_s >= 0.0 && out_.lag_needed_s > lag_s)
        return refuse_stated(MotionRefusal::beyond_stated, "lag_bound_s", out_.lag_needed_s, lag_s, one);
      if (lag_s >= 0.0 && over(out_.fit.lag_s[k], lag_s) > 1.0)
        return refuse_stated(MotionRefusal::beyond_stated, "lag_bound_s", out_.fit.lag_s[k].value, lag_s, one);
      if (rectified >= 0.0 && over(out_.fit.rectification[k], rectified) > 1.0)
        return refuse_stated(MotionRefusal::beyond_stated, "vibration_rectification_per_mps2",
                             out_.fit.rectification[k].value, rectified, one);
    }
    return true;
  }

  /// What is open keeps the bound that the file states; where it states none nothing bounds it.
  bool judge_open() {
    SensorSet open;
    for (std::size_t k = 0; k < out_.found.sensor.size(); ++k) {
      const auto& arm = out_.fit.arm_m[k];
      const bool lever =
          !(out_.lever_stated[k] && out_.fit.stated_arms_hold) && (arm[0].open || arm[1].open || arm[2].open);
      const bool lag = !out_.lag_stated[k] && out_.fit.lag_s[k].open;
      const bool rectified = !out_.rectification_stated[k] && out_.fit.rectification[k].open;
      if (lever || lag || rectified) open = open.with(static_cast<int>(k));
    }
    return open.empty() || refuse(MotionRefusal::open, 0.0, 0.0, open);
  }

  void judge_held_out() {
    const std::size_t end = flight_.samples.size();
    const commission::Replay seen = commission::replayed(array_in_motion_, out_.setup, flight_.samples, split_, end);
    out_.held_out_judged = seen.judged;
    const ArrayPairs pairs(on_board_, flight_.samples, split_, end, settings_.scale);
    const auto own = commission::fit_array(on_board_, pairs, settings_);
    if (!own) {
      refuse(MotionRefusal::too_short, out_.duration_s, 2.0 * out_.duration_s);
      return;
    }
    out_.held_out_mps2 = commission::residual_of(on_board_, pairs, out_.fit);
    out_.held_out_own_mps2 = own->residual_mps2;
    const double ratio = out_.held_out_mps2 / out_.held_out_own_mps2;
    if (seen.gyros_disagree) {
      refuse(MotionRefusal::gyros_disagree, seen.gyros_disagree_s);
    } else if (seen.alarm) {
      refuse(MotionRefusal::held_out_alarm, seen.alarm_s, 0.0, seen.isolated.empty() ? seen.suspects : seen.isolated);
    } else if (ratio > kMostHeldOut) {
      refuse(MotionRefusal::held_out, ratio, kMostHeldOut);
    }
  }

  const io::ArrayFile& array_;
  const io::CalibrationFile& calibration_;
  double days_;
  const MotionFlight& flight_;
  ArrayOnBoard on_board_;
  std::size_t split_;
  commission::ArrayFitSettings settings_;
  commission::ArrayBoundRule rule_;
  SensorArray array_in_motion_;
  MotionCommissioning out_;
};

}  // namespace

io::FileExpected<MotionCommissioning> run_motion_commissioning(const io::ArrayFile& array,
                                                               const io::CalibrationFile& calibration, double days,
                                                               const LogSpec& log) {
  const auto refuse = [](const io::FileError& error) { return tl::unexpected<io::FileError>(error); };
  if (const std::optional<io::FileError> not_fit = unfit(array)) return refuse(*not_fit);
  const io::MotionCalibration before = unknown(array);
  const io::FileExpected<MotionPlan> plan = plan_motion(array, &calibration.calibration, days, &before);
  if (!plan) return refuse(plan.error());
  const io::FileExpected<MotionFlight> flight = read_flight(array, *plan, log);
  if (!flight) return refuse(flight.error());
  io::FileExpected<MotionCommissioning> out = Commissioner(array, calibration, days, *plan, *flight).run();
  if (!out) return out;
  out->found.log_file = log.path;
  out->found.log_bytes = flight->log.bytes;
  out->found.log_hash = flight->log.hash;
  out->found.rows = out->rows;
  out->found.plumb_version = PLUMB_VERSION;
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
