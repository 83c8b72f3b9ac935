#include "plumb/session/gyro_commissioning.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gyro_checks.hpp"
#include "gyro_recording.hpp"
#include "plumb/session/rate_group.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

using commission::FittedGyro;
using commission::GravityTurn;
using commission::GyroFit;
using commission::GyroFitSettings;

/// Of the rows, where no other log is held out.
constexpr double kFittedPart = 2.0 / 3.0;
/// Of the steps from row to row.
constexpr double kMostIrregularSteps = 0.01;
/// One turn in so many is held out, where so many of these are left.
constexpr std::size_t kTurnHeldOut = 3, kLeastTurnsHeld = 9;
constexpr double kBoundSigmas = 3.0;
/// Of the lag: how much more than three sigma the log may need before it is none.
constexpr double kLagStep = 1.5, kMostLag_s = 0.02;
constexpr double kGravity_mps2 = 9.81;
/// Beside three sigma: floors, for what changes from one run to the next and one recording cannot show. As of the gyros
/// of `plumb calibrate --motion` (`ArrayBoundRule`).
constexpr RateErrors kFloor{0.002, 0.002, 0.001, 0.0, 0.0};

std::string text_of_time(double t_s) {
  std::array<char, 40> out{};
  std::snprintf(out.data(), out.size(), "%.3f s", t_s);
  return out.data();
}

/// 3 sigma of scale and axis from the covariance of a row.
void bound_row(io::GyroCalibration::Axis& axis) {
  const double length = norm(axis.row);
  const Vec3 unit = scaled(axis.row, 1.0 / length);
  const auto at = [&](std::size_t r, std::size_t c) { return axis.row_covariance[3 * r + c]; };
  double along = 0.0, trace = 0.0;
  for (std::size_t r = 0; r < 3; ++r) {
    trace += at(r, r);
    for (std::size_t c = 0; c < 3; ++c) along += unit[r] * at(r, c) * unit[c];
  }
  axis.bound.scale = kFloor.scale + kBoundSigmas * std::sqrt(std::fmax(along, 0.0)) / length;
  axis.bound.axis_rad = kFloor.axis_rad + kBoundSigmas * std::sqrt(std::fmax(trace - along, 0.0)) / length;
}

/// One run, step by step; each refuses or goes on.
class Gyros {
 public:
  Gyros(const io::ArrayFile& tool, const io::ArrayFile& group, const GyroCommissioningLogs& logs)
      : tool_(tool), group_(group), logs_(logs) {}

  io::FileExpected<GyroCommissioning> run() {
    io::FileExpected<GyroRecording> motion = read(logs_.motion.path, "fitted");
    if (!motion) return tl::unexpected<io::FileError>(motion.error());
    motion_ = *std::move(motion);
    std::vector<GyroRecording> others;
    for (const std::string& path : logs_.held_out) {
      io::FileExpected<GyroRecording> other = read(path, "held out");
      if (!other) return tl::unexpected<io::FileError>(other.error());
      others.push_back(*std::move(other));
    }
    GyroRecording turning;
    for (const std::string& path : logs_.turns) {
      const io::FileExpected<GyroRecording> other = read(path, "turns");
      if (!other) return tl::unexpected<io::FileError>(other.error());
      append(*other, turning);
    }
    if (!inputs_sound() || !fit() || !make_absolute(turning)) return std::move(out_);
    const io::FileExpected<bool> bounded = bound();
    if (!bounded) return tl::unexpected<io::FileError>(bounded.error());
    if (*bounded) hold_out(others);
    return std::move(out_);
  }

 private:
  bool refuse(std::string why, std::string next) {
    out_.refusal = std::move(why);
    out_.next = std::move(next);
    return false;
  }

  io::FileExpected<GyroRecording> read(const std::string& path, const char* use) {
    LogSpec log = logs_.motion;
    log.path = path;
    io::FileExpected<GyroRecording> out = read_gyros(tool_, group_, {log, logs_.accelerometers, logs_.force});
    if (out) out_.found.log.push_back({use, path, out->file.bytes, out->file.hash, out->file.rows});
    return out;
  }

  bool inputs_sound() {
    const MotionInputs& in = motion_.inputs;
    out_.rows = in.rows;
    out_.duration_s = motion_.file.last_time_s - motion_.file.first_time_s;
    for (const GyroRestStretch& one : motion_.rest) {
      ++(one.turned ? out_.rests_turned : out_.rests);
      out_.rest_s += one.turned ? 0.0 : static_cast<double>(one.end - one.begin + 1) * motion_.log.period_s;
    }
    out_.bias_scatter_radps = bias_scatter_radps(motion_);
    const auto irregular = static_cast<double>(in.steps_irregular + in.steps_back);
    if (in.period_is_another || irregular > kMostIrregularSteps * static_cast<double>(in.rows))
      return refuse("time: " + std::to_string(in.steps_irregular + in.steps_back) + " of " + std::to_string(in.rows) +
                        " steps from row to row are not the stated period (most are " + text_of_time(in.mean_step_s) +
                        ")",
                    "state the period of the log ([group.rate] sample_period_s), or cut the log at gaps");
    split_ = logs_.held_out.empty() ? static_cast<std::size_t>(kFittedPart * static_cast<double>(motion_.log.samples()))
                                    : motion_.log.samples();
    fitted_log_ = part_of(motion_.log, 0, split_);
    out_.fitted_rows = split_;
    if (std::find(fitted_log_.at_rest.begin(), fitted_log_.at_rest.end(), true) != fitted_log_.at_rest.end())
      return true;
    return refuse(
        out_.rests_turned > 0
            ? "bias: wherever the accelerometers say that the tool stands still, the gyros turn or scatter by more "
              "than five times their stated noise"
            : "bias: the part of the log that is fitted shows no stretch at rest, and biases come from rest",
        "hold the tool still for some seconds at the beginning of the log; state the noise that the gyros have");
  }

  bool fit() {
    std::vector<commission::GyroNominal> nominal;
    for (int i = 0; i < group_.array.size(); ++i)
      nominal.push_back({group_.array.axis(i), group_.array.sigma_mps2(i), 0.0, group_.array.row(i).id.data()});
    GyroFitSettings settings;
    settings.delay = logs_.delay;
    settings.force = logs_.force;
    const auto found = commission::fit_gyros(fitted_log_, nominal, settings);
    if (found) {
      out_.fit = *found;
      return true;
    }
    const auto about = [&](const char* what) { return found.error().find(what) != std::string::npos; };
    std::string next =
        "record the tool at rest for some seconds, then turning to and fro about all three axes with changing rates";
    if (about("delay")) next += "; or leave delays to lag_bound_s: --without delay";
    if (about("g-sensitivity")) next += "; or leave it to g_sensitivity_bound_s_per_m: --without g-sensitivity";
    return refuse(found.error(), next);
  }

  /// The matrix that gyros alone do not tell, where there are turns between stations.
  bool make_absolute(const GyroRecording& turning) {
    if (logs_.turns.empty()) return true;
    double sigma_rad = 0.0;
    if (logs_.accelerometers != nullptr) {
      for (int i = 0; i < tool_.array.size(); ++i)
        sigma_rad =
            std::fmax(sigma_rad, logs_.accelerometers->calibration.report.e_cal_mps2[static_cast<std::size_t>(i)] /
                                     tool_.gravity.g_mps2);
    }
    double noise_radps = 0.0, bias_radps = bias_scatter_radps(turning);
    for (int i = 0; i < group_.array.size(); ++i) noise_radps = std::fmax(noise_radps, group_.array.sigma_mps2(i));
    const std::vector<GravityTurn> all = turns_of(turning, sigma_rad, bias_radps, noise_radps);
    std::vector<GravityTurn> fitted, held;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const bool out = all.size() >= kLeastTurnsHeld && k % kTurnHeldOut == kTurnHeldOut - 1;
      (out ? held : fitted).push_back(all[k]);
    }
    out_.turns = static_cast<int>(fitted.size()), out_.turns_held_out = static_cast<int>(held.size());
    const auto common = commission::fit_common(turning.log, *out_.fit, fitted);
    if (!common)
      return refuse("common matrix: " + common.error(),
                    "turn the tool from rest to rest, 2 s each, about axes across gravity, in many attitudes; or "
                    "leave --turns out, and the axes stay relative to each other");
    out_.common = *common;
    out_.fit = commission::with_common(*out_.fit, *common);
    out_.found.turns_rad = common->residual_rad;
    if (held.empty()) return true;
    const auto residual = commission::turn_residual_rad(turning.log, *out_.fit, held);
    if (!residual) return refuse("turns held out: " + residual.error(), "record the turns again");
    out_.found.held_out_turns_rad = *residual;
    return true;
  }

  void take(const GyroFit& fit) {
    out_.found.absolute = fit.absolute, out_.found.bias_from_rest = fit.bias_from_rest;
    out_.found.delay_fitted = logs_.delay, out_.found.force_fitted = logs_.force;
    out_.found.plumb_version = PLUMB_VERSION;
    for (std::size_t i = 0; i < fit.axis.size(); ++i) {
      const FittedGyro& from = fit.axis[i];
      const RateErrors& stated = group_.rate.errors[i];
      io::GyroCalibration::Axis to;
      to.row = from.row, to.row_covariance = from.row_covariance;
      to.bias_radps = from.bias_radps, to.bias_sigma_radps = from.bias_sigma_radps;
      to.delay_s = from.delay_s, to.delay_sigma_s = from.delay_sigma_s;
      to.per_force = from.per_force, to.per_force_sigma = from.per_force_sigma;
      bound_row(to);
      const double length = norm(to.row);
      // What all axes share of g-sensitivity no parity shows: the datasheet bounds it.
      const double found = norm(from.per_force) + kBoundSigmas * norm(from.per_force_sigma);
      to.bound.g_sensitivity_s_per_m = std::fmax(found, stated.g_sensitivity_s_per_m) / length;
      to.bound.bias_radps = kFloor.bias_radps +
                            kBoundSigmas * std::hypot(from.bias_sigma_radps, out_.bias_scatter_radps) / length +
                            to.bound.g_sensitivity_s_per_m * kGravity_mps2 + kEarthRate_radps;
      to.bound.lag_s = std::fabs(from.delay_s) + kBoundSigmas * (from.delay_sigma_s + out_.limit.timing_s);
      if (!logs_.delay) to.bound.lag_s = std::fmax(to.bound.lag_s, stated.lag_s);
      out_.found.axis.push_back(to);
    }
  }

  /// Bounds, and as much more lag as the log needs for that the monitor finds nothing in it.
  io::FileExpected<bool> bound() {
    out_.limit = limit_of(fitted_log_, *out_.fit);
    take(*out_.fit);
    out_.fitted = check_of(fitted_log_, *out_.fit, group_.rate.rate_bound_radps);
    out_.fitted.name = "fitted";
    for (;; out_.lag_factor *= kLagStep) {
      const io::FileExpected<RateGroup> judged = rate_group(group_, &out_.found);
      if (!judged) return tl::unexpected<io::FileError>(judged.error());
      out_.common_part = judged->common;
      const GyroReplay seen = replayed(*judged, out_.found, fitted_log_);
      out_.fitted.alarm = seen.alarm, out_.fitted.alarm_s = motion_.start_s + seen.alarm_s;
      out_.fitted.alarm_axes = seen.axes;
      if (!seen.alarm) break;
      double latest_s = 0.0;
      for (io::GyroCalibration::Axis& one : out_.found.axis) {
        one.bound.lag_s = std::fmax(one.bound.lag_s * kLagStep, 1e-6);
        latest_s = std::fmax(latest_s, one.bound.lag_s);
      }
      if (latest_s > kMostLag_s) return contradicted(out_.fitted, "the log that is fitted");
    }
    out_.found.sample_radps = out_.fitted.all.sample_radps, out_.found.block_radps = out_.fitted.all.block_radps;
    return true;
  }

  bool contradicted(const GyroCheck& check, const std::string& where) {
    return refuse("parity: " + names(check.alarm_axes) + " contradict" + (check.alarm_axes.size() == 1 ? "s" : "") +
                      " the other gyros at t = " + text_of_time(check.alarm_s) + " of " + where +
                      " with the bounds of the fit",
                  "look at that gyro and at the columns of the log; record again where all gyros are healthy");
  }

  std::string names(SensorSet axes) const {
    std::string out;
    for (int i = 0; i < group_.array.size(); ++i) {
      if (axes.has(i)) out += (out.empty() ? "" : ", ") + std::string(group_.array.row(i).id.data());
    }
    return out.empty() ? "a gyro that is not told" : out;
  }

  bool hold_out(const std::vector<GyroRecording>& others) {
    const io::FileExpected<RateGroup> judged = rate_group(group_, &out_.found);
    if (!judged) return refuse(judged.error().what, judged.error().remedy);
    const auto hold = [&](const commission::GyroLog& log, double start_s, std::string name) {
      GyroCheck one = check_of(log, *out_.fit, group_.rate.rate_bound_radps);
      const GyroReplay seen = replayed(*judged, out_.found, log);
      one.name = std::move(name);
      one.alarm = seen.alarm, one.alarm_s = start_s + seen.alarm_s, one.alarm_axes = seen.axes;
      out_.held_out.push_back(std::move(one));
    };
    for (std::size_t k = 0; k < others.size(); ++k) hold(others[k].log, others[k].start_s, logs_.held_out[k]);
    if (others.empty())
      hold(part_of(motion_.log, split_, motion_.log.samples()),
           motion_.start_s + static_cast<double>(split_) * motion_.log.period_s, "the last third");
    for (const GyroCheck& one : out_.held_out) {
      out_.found.held_out_sample_radps = std::fmax(out_.found.held_out_sample_radps, one.all.sample_radps);
      out_.found.held_out_block_radps = std::fmax(out_.found.held_out_block_radps, one.all.block_radps);
      if (one.alarm) return contradicted(one, one.name + ", which is held out,");
    }
    return true;
  }

  const io::ArrayFile& tool_;
  const io::ArrayFile& group_;
  const GyroCommissioningLogs& logs_;
  GyroRecording motion_;
  std::size_t split_ = 0;
  commission::GyroLog fitted_log_;
  GyroCommissioning out_;
};

}  // namespace

io::FileExpected<GyroCommissioning> run_gyro_commissioning(const io::ArrayFile& tool, const io::ArrayFile& group,
                                                           const GyroCommissioningLogs& logs) {
  return Gyros(tool, group, logs).run();
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
