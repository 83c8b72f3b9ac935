// Why a log in motion was not accepted, in words.
#include <fmt/format.h>

#include <algorithm>

#include "plumb/core/units.hpp"
#include "plumb/render/motion_fit_report.hpp"
#include "plumb/render/words.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {
namespace {

using session::MotionCommissioning;
using session::MotionRefusal;

bool any_open(const std::vector<commission::Estimate>& all) {
  return std::any_of(all.begin(), all.end(), [](const commission::Estimate& one) { return one.open; });
}

/// Which motion would show what is open.
std::string missing_motion(const MotionCommissioning& run) {
  std::vector<std::string> axes, out;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& arms = run.fit.arm_m;
    if (std::any_of(arms.begin(), arms.end(), [c](const auto& arm) { return arm[c].open; }))
      axes.emplace_back(1, "xyz"[c]);
  }
  if (!axes.empty())
    out.push_back("turn the tool to and fro about axes across " + listed(axes) + ", faster or for longer");
  if (any_open(run.fit.lag_s)) out.emplace_back("accelerate it to and fro along the axes of these sensors");
  if (any_open(run.fit.rectification))
    out.emplace_back(
        "state vibration_rectification_per_mps2 of the datasheet, for no motion shows what parallel sensors rectify "
        "alike");
  return listed(out) + "; or state the bounds in the array file (docs/array-file.md, Motion)";
}

Refusal of_inputs(const MotionCommissioning& run, const io::ArrayFile& array) {
  switch (run.refusal) {
    case MotionRefusal::irregular_time:
      return {
          fmt::format("{} of {:.0f} steps from row to row are not the stated period of {:.4g} s (most are {:.4g} s)",
                      run.value, run.limit, array.motion.sample_period_s.value_or(1.0 / array.input.rate_hz),
                      run.inputs.mean_step_s),
          "state the period of the log (sample_period_s), or cut the log at gaps"};
    case MotionRefusal::no_rates:
      return {fmt::format("the rate of a gyro is missing in {:.0f} of {:.0f} rows", run.value, run.limit),
              "log the rates of every sample"};
    case MotionRefusal::rates_in_deg:
      return {run.fitted ? fmt::format("the readings fit {:.1f} times better with the rates taken as deg/s", run.value)
                         : fmt::format("the rates reach {:.4g} rad/s, beyond {:.4g} rad/s", run.value, run.limit),
              "write rad/s into the columns of the rates; raise rate_bound_radps if the tool turns so fast"};
    case MotionRefusal::gyro_still:
      return {
          fmt::format("the {} gyro ({}) stands still for {:.1f} s from t = {:.3f} s on, while a gyro has noise",
                      run.gyro == 0 ? "first" : "second",
                      listed(run.gyro == 0 ? array.input.rotation_columns : array.input.second_rotation_columns),
                      run.value, run.limit),
          "see whether the gyro was on and its columns are filled; record again, or leave its columns out of [input]"};
    case MotionRefusal::rate_noise:
      return {fmt::format("the two gyros scatter by {:.2g} rad/s against each other, beyond {:.2g} rad/s", run.value,
                          run.limit),
              "write rad/s into the columns of the rates; correct noise_radps if they are"};
    case MotionRefusal::clipped:
      return {
          fmt::format("{:.0f} % of the blocks have a sensor without a reading or at full scale, or no rate{}",
                      100.0 * run.value,
                      run.sensors.empty() ? "" : " (at full scale: " + sensor_names(run.sensors, array.array) + ")"),
          run.sensors.empty() ? "look for empty or nan cells of sensors and gyros in the log"
                              : "record a gentler motion, or use sensors of a larger full scale"};
    case MotionRefusal::filtered:
      return {fmt::format("readings scatter by {:.2f} of the stated noise from sample to sample", run.value),
              "log samples that were not filtered or averaged; check the unit of the log, and noise in the array file"};
    default:
      return {fmt::format("the log has {:.1f} s, and the fit with its check needs {:.1f} s", run.value, run.limit),
              "record a longer motion"};
  }
}

}  // namespace

const char* word_of(MotionRefusal refusal) noexcept {
  switch (refusal) {
    case MotionRefusal::none: return "none";
    case MotionRefusal::irregular_time: return "irregular_time";
    case MotionRefusal::no_rates: return "no_rates";
    case MotionRefusal::rates_in_deg: return "rates_in_deg";
    case MotionRefusal::gyro_still: return "gyro_still";
    case MotionRefusal::rate_noise: return "rate_noise";
    case MotionRefusal::clipped: return "clipped";
    case MotionRefusal::filtered: return "filtered";
    case MotionRefusal::too_short: return "too_short";
    case MotionRefusal::fault: return "fault";
    case MotionRefusal::open: return "open";
    case MotionRefusal::calibration: return "calibration";
    case MotionRefusal::gyro: return "gyro";
    case MotionRefusal::gyros_disagree: return "gyros_disagree";
    case MotionRefusal::gyro_unbounded: return "gyro_unbounded";
    case MotionRefusal::beyond_stated: return "beyond_stated";
    case MotionRefusal::held_out_alarm: return "held_out_alarm";
    case MotionRefusal::held_out: return "held_out";
  }
  return "none";
}

Refusal refusal_of(const MotionCommissioning& run, const io::ArrayFile& array) {
  const std::string names = run.sensors.empty() ? "some sensors" : sensor_names(run.sensors, array.array);
  switch (run.refusal) {
    case MotionRefusal::fault:
      return {
          fmt::format("{} contradict the others from t = {:.3f} s on, whatever lag is allowed for", names, run.value),
          "look for a faulty sensor, another unit, exchanged columns or a loose mounting; record again"};
    case MotionRefusal::open:
      return {"the motion leaves open: " + listed(left_open(run, array)) + ", and the array file states no bound of it",
              missing_motion(run)};
    case MotionRefusal::calibration:
      return {fmt::format("scale, axis or bias of {} is {:.1f} times what calibration and array file leave of it",
                          names, run.value),
              "calibrate at rest anew, or state scale_bound, axis_bound_rad and bias_bound_mps2 of the sensor"};
    case MotionRefusal::gyro:
      return {fmt::format("the gyro is off by {:.4g}, and {} states {:.4g}", run.value, run.key, run.limit),
              "check the columns and the axes of the gyro, or correct the bound"};
    case MotionRefusal::gyros_disagree:
      return {
          fmt::format("the two gyros read more apart than their bounds allow at t = {:.3f} s: one of them is faulty",
                      run.value),
          "check the columns, the unit and the axes of both gyros; correct [gyro] if its bounds are too small"};
    case MotionRefusal::gyro_unbounded:
      return {
          fmt::format("the gyro would need a {} of {:.3g}, and the most is {:.3g}: one of the gyros is faulty, or "
                      "the motion does not show it",
                      run.key, run.value, run.limit),
          "check the columns, the unit and the axes of the gyros; record a longer motion that turns about all axes"};
    case MotionRefusal::beyond_stated:
      return {fmt::format("{} of {} is {:.4g} in the array file, and the log needs {:.4g}", run.key, names, run.limit,
                          run.value),
              "look for a faulty sensor; else correct the bound, or leave it out: what is found here counts then"};
    case MotionRefusal::held_out_alarm:
      return {fmt::format("with the bounds of the fit {} contradict the others at t = {:.3f} s of the held-out part",
                          names, run.value),
              "look for a fault there; else record a longer motion that is alike in both parts"};
    case MotionRefusal::held_out:
      return {
          fmt::format("the fit leaves {:.1f} times the residual of the held-out part that its own fit leaves; the most "
                      "is {:.1f} times",
                      run.value, run.limit),
          "record a longer motion that turns and accelerates about all axes in every part"};
    default: return of_inputs(run, array);
  }
}

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
