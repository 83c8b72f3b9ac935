#include "plumb/session/motion_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "clock_plan.hpp"
#include "plumb/core/units.hpp"
#include "plumb/motion/motion_sets.hpp"
#include "plumb/session/monitor_pipeline.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// A channel counts as clipped from this share of full scale on, as at rest (docs/array-file.md).
constexpr double kClipShare = 0.995;
/// Until half a minute has been measured at rest; in motion for good (docs/array-file.md).
constexpr double kMostRate_degc_per_min = 5.0;

/// Keys that the file would have to state besides, in its own words.
class Missing {
 public:
  void need(bool stated, const std::string& field) {
    if (!stated && std::find(fields_.begin(), fields_.end(), field) == fields_.end()) fields_.push_back(field);
  }
  bool none() const noexcept { return fields_.empty(); }
  io::FileError told(const io::ArrayFile& array) const {
    std::string others;
    for (std::size_t k = 1; k < fields_.size(); ++k) others += (k > 1 ? ", " : "") + fields_[k];
    std::string what = "is missing";
    if (!others.empty()) what += ", and so " + std::string(fields_.size() > 2 ? "are " : "is ") + others;
    return {array.path,
            0,
            fields_.front(),
            what + ": motion is not judged",
            "state it (a bound of a sensor in its [[sensor]], or in [motion] for all; docs/array-file.md, Motion)",
            io::ExitCode::invalid_input};
  }

 private:
  std::vector<std::string> fields_;
};

io::FileError not_judged(const io::ArrayFile& array, const char* field, const std::string& what,
                         const std::string& remedy) {
  return {array.path, 0, field, what + ": motion is not judged", remedy, io::ExitCode::invalid_input};
}

void need_bounds(const io::ArrayFile& array, bool calibrated, bool commissioned, Missing& missing) {
  for (int i = 0; i < array.array.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const io::MotionBounds& b = array.motion.sensor[k];
    missing.need(b.lever_arm_m.has_value() || commissioned, "motion.lever_arm_bound_m");
    missing.need(b.lag_s.has_value() || commissioned, "motion.lag_bound_s");
    missing.need(b.rectification_per_mps2.has_value() || commissioned, "motion.vibration_rectification_per_mps2");
    const bool stable = calibrated && array.stability[k].stated();
    missing.need(b.scale.has_value() || stable, "motion.scale_bound");
    missing.need(b.bias_mps2.has_value() || stable, "motion.bias_bound_mps2");
    missing.need(b.axis_rad.has_value() || calibrated, "motion.axis_bound_rad");
  }
}

/// All that cannot be left to defaults.
Missing missing_in(const io::ArrayFile& array, bool calibrated, bool commissioned) {
  const io::MotionSpec& spec = array.motion;
  Missing missing;
  missing.need(spec.sample_period_s.has_value() || array.input.rate_hz > 0.0, "motion.sample_period_s");
  missing.need(!array.lever_arm_m.empty() || commissioned, "sensor[1].lever_arm_m");
  need_bounds(array, calibrated, commissioned, missing);
  if (array.input.rotation_columns.empty() && spec.gyro.group.empty()) {
    missing.need(spec.rate_bound_radps.value_or(0.0) > 0.0, "motion.rate_bound_radps");
    return missing;
  }
  const io::GyroSpec& g = spec.gyro;
  if (!g.group.empty()) {  // of their lag a calibration in motion, made with another gyro, says nothing
    missing.need(g.lag_s.has_value(), "gyro.lag_bound_s");
    return missing;
  }
  if (commissioned) return missing;
  missing.need(g.lag_s.has_value(), "gyro.lag_bound_s");
  missing.need(g.scale.has_value(), "gyro.scale_bound");
  missing.need(g.axis_rad.has_value(), "gyro.axis_bound_rad");
  missing.need(g.bias_radps.has_value(), "gyro.bias_bound_radps");
  missing.need(g.noise_radps.has_value(), "gyro.noise_radps");
  return missing;
}

MotionErrors errors_of(const io::ArrayFile& array, const Calibration* calibration, int i, double days,
                       const io::MotionCalibration* commissioned) {
  const auto k = static_cast<std::size_t>(i);
  const io::MotionBounds& b = array.motion.sensor[k];
  const io::MotionCalibration::Sensor found =
      commissioned != nullptr ? commissioned->sensor[k] : io::MotionCalibration::Sensor{};
  const DerivedBounds left = calibration != nullptr ? derived_bounds(array, *calibration, i, days) : DerivedBounds{};
  return {commissioned != nullptr ? found.lever_arm_bound_m : *b.lever_arm_m,  // the stated one is of the stated arm
          b.lag_s.value_or(found.lag_bound_s),
          b.rectification_per_mps2.value_or(found.rectification_bound_per_mps2),
          b.scale.value_or(left.scale),
          b.axis_rad.value_or(left.axis_rad),
          b.bias_mps2.value_or(left.bias_mps2)};
}

/// What the array file states of the gyros counts before what a log in motion showed of them.
GyroErrors gyro_of(const io::GyroSpec& stated, const io::MotionCalibration* commissioned) {
  const GyroErrors found = commissioned != nullptr ? commissioned->gyro : GyroErrors{};
  return {stated.scale.value_or(found.scale), stated.axis_rad.value_or(found.axis_rad),
          stated.bias_radps.value_or(found.bias_radps), stated.noise_radps.value_or(found.noise_radps),
          stated.lag_s.value_or(found.lag_s)};
}

MotionSetup motion_setup_of(const io::ArrayFile& array, const Calibration* calibration, double days,
                            const io::MotionCalibration* commissioned, const GroupRates* rates) {
  const io::MotionSpec& spec = array.motion;
  MotionSetup out = spec.limits;
  out.sample_period_s = spec.sample_period_s ? *spec.sample_period_s : 1.0 / array.input.rate_hz;
  out.rate_bound_radps = spec.rate_bound_radps.value_or(0.0);
  for (int i = 0; i < array.array.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    out.lever_arm_m[k] = commissioned != nullptr ? commissioned->sensor[k].lever_arm_m : array.lever_arm_m[k];
    out.errors[k] = errors_of(array, calibration, i, days, commissioned);
  }
  if (rates != nullptr) {
    // All that the median is off by is stated with each sample, but for what the gyros lag the accelerometers by.
    out.gyros = 1;
    out.gyro_corroborated = true;
    out.gyro.lag_s = *spec.gyro.lag_s;
  }
  if (array.input.rotation_columns.empty()) return out;
  out.gyros = array.input.second_rotation_columns.empty() ? 1 : 2;
  out.gyro = gyro_of(spec.gyro, commissioned);
  out.gyro_corroborated = spec.gyro.corroborated;
  return out;
}

/// Of the group that [gyro] names.
io::FileExpected<GroupRates> rates_of(const io::ArrayFile& array, const RateGroup* gyros) {
  const std::string group = "is \"" + array.motion.gyro.group + "\"";
  if (gyros == nullptr)
    return tl::unexpected<io::FileError>(not_judged(
        array, "gyro.group", group + ", and these gyros are not watched here",
        "run plumb monitor with --group " + array.motion.gyro.group + ", or name the columns of a gyro in [input]"));
  for (int i = 0; i < gyros->array.size() && !gyros->calibrated; ++i) {
    const RateErrors& e = gyros->setup.errors[static_cast<std::size_t>(i)];
    if (e.scale > 0.0 && e.axis_rad > 0.0 && e.bias_radps > 0.0) continue;
    return tl::unexpected<io::FileError>(
        not_judged(array, "gyro.group", group + ", of whose " + gyros->array.row(i).id.data() + " a bound is missing",
                   "state scale_bound, axis_bound_rad and bias_bound_radps in [group.rate], or calibrate the gyros"));
  }
  if (!std::isfinite(gyros->common))
    return tl::unexpected<io::FileError>(not_judged(
        array, "gyro.group", group + ", and nothing bounds what its calibration leaves open for all gyros alike",
        "calibrate the gyros with --turns, or state scale_bound and axis_bound_rad in [group.rate]"));
  io::FileExpected<GroupRates> out = GroupRates::make(*gyros);
  if (out) return out;
  return tl::unexpected<io::FileError>(
      not_judged(array, "gyro.group", group + ", which " + out.error().what, out.error().remedy));
}

/// What a log in motion showed is of the array that the file described then.
std::optional<io::FileError> of_another_array(const io::ArrayFile& array, const io::MotionCalibration& commissioned) {
  const std::string again = "run plumb calibrate --motion again with this array file, or undo the change";
  const int gyros =
      (array.input.rotation_columns.empty() ? 0 : 1) + (array.input.second_rotation_columns.empty() ? 0 : 1);
  if (array.motion.gyro.group.empty() && gyros != commissioned.gyros)  // of the gyros of a group it says nothing
    return not_judged(array, "input.rotation_radps",
                      "names " + std::to_string(gyros) + " gyros, and the calibration in motion was made with " +
                          std::to_string(commissioned.gyros),
                      again);
  for (std::size_t k = 0; k < commissioned.sensor.size(); ++k) {
    const std::string field = "sensor[" + std::to_string(k + 1) + "].lever_arm_m";
    if (array.lever_arm_m.empty() != !commissioned.lever_arms_stated)
      return not_judged(array, field.c_str(),
                        std::string("is ") + (array.lever_arm_m.empty() ? "missing" : "stated") +
                            ", and was not when the calibration in motion was made",
                        again);
    if (!array.lever_arm_m.empty() && array.lever_arm_m[k] != commissioned.sensor[k].stated_lever_arm_m)
      return not_judged(array, field.c_str(), "has changed since the calibration in motion was made", again);
  }
  return std::nullopt;
}

/// Of the z axis of the output frame, which is along the hole, in the frame in which the monitor at rest alerts.
InclinationSetup inclination_setup_of(const io::ArrayFile& array) {
  InclinationSetup out;
  const Mat3& frame = array.output_frame;
  out.axis = {frame[6], frame[7], frame[8]};
  const bool housing = array.monitor.alert_frame == AlertFrame::housing;
  out.axis_bound_rad = housing ? static_cast<double>(array.monitor.alignment_bound_rad) : 0.0;
  out.velocity_bound_mps = *array.motion.velocity_bound_mps;
  out.window_s = array.motion.inclination_window_s;
  out.gravity_mps2 = array.gravity.g_mps2;
  out.gravity_bound_mps2 = kMotionSigmas * array.gravity.sigma_mps2;
  return out;
}

/// What follows from calibration and stability may be beyond what the monitor takes.
io::FileError beyond_use(const io::ArrayFile& array, const Error& error) {
  const bool of_sensor = error.index >= 0 && error.index < array.array.size();
  const std::string id = of_sensor ? array.array.row(error.index).id.data() : "";
  const std::string what =
      of_sensor ? "what calibration and stability leave of " + id + " is beyond what motion can be judged with"
                : std::string(describe(error.code));
  return not_judged(array, "motion", what,
                    "state scale_bound, axis_bound_rad and bias_bound_mps2 of the sensor, or calibrate it better");
}

}  // namespace

DerivedBounds derived_bounds(const io::ArrayFile& array, const Calibration& calibration, int sensor, double days) {
  const auto k = static_cast<std::size_t>(sensor);
  const RowUncertainty& left = calibration.array.uncertainty();
  const Vec3& axis = calibration.array.axis(sensor);
  double along = 0.0, trace = 0.0;
  const auto entry = [&left, sensor](int a, int b) {
    const int high = 4 * sensor + std::max(a, b), low = 4 * sensor + std::min(a, b);
    return left.covariance[static_cast<std::size_t>(high * (high + 1) / 2 + low)];
  };
  for (int a = 0; a < 3; ++a) {
    trace += entry(a, a);
    for (int b = 0; b < 3; ++b)
      along += axis[static_cast<std::size_t>(a)] * entry(a, b) * axis[static_cast<std::size_t>(b)];
  }
  const double reference_degc = array.datasheet.sensor[k].coefficients.reference_degc;
  const FitReport& fit = calibration.report;
  const double away_degc = std::fmax(std::fabs(fit.temperature_min_degc - reference_degc),
                                     std::fabs(fit.temperature_max_degc - reference_degc));
  const double tolerance_mps2 =
      static_cast<double>(StabilityNow::of(array.stability[k], days).tolerance_mps2(away_degc, kMostRate_degc_per_min));
  DerivedBounds out;
  out.scale = kMotionSigmas * (std::sqrt(std::fmax(along, 0.0)) + left.common_scale) + tolerance_mps2 / kG0_mps2;
  out.axis_rad = kMotionSigmas * std::sqrt(std::fmax(trace - along, 0.0));
  out.bias_mps2 = kMotionSigmas * (std::sqrt(std::fmax(entry(3, 3), 0.0)) + left.misfit_mps2[k]) + tolerance_mps2;
  return out;
}

io::FileExpected<MotionPlan> plan_motion(const io::ArrayFile& array, const Calibration* calibration, double days,
                                         const io::MotionCalibration* commissioned, const RateGroup* gyros) {
  const auto refuse = [](io::FileError error) { return tl::unexpected<io::FileError>(std::move(error)); };
  if (!array.motion.stated)
    return refuse(not_judged(array, "motion", "is missing, while other keys of motion are given",
                             "add [motion] with sample_period_s, or remove these keys"));
  const int sensors = array.array.size();
  if (sensors > kMotionCapacity)
    return refuse(not_judged(array, "motion",
                             "is judged for at most " + std::to_string(kMotionCapacity) + " sensors, and these are " +
                                 std::to_string(sensors),
                             "describe the sensors that belong together in a file of their own, or remove [motion]"));
  if (array.input.rows != io::RowKind::samples)
    return refuse(not_judged(array, "input.rows", "is \"stations\", and motion lies between them",
                             "log samples, or remove [motion]"));
  if (array.monitor.mode == MonitorMode::paper)
    return refuse(not_judged(array, "monitor.mode", "is \"paper\", and the paper's algorithm knows no motion",
                             "set mode = \"plumb\", or remove [motion]"));
  if (commissioned != nullptr) {
    if (std::optional<io::FileError> other = of_another_array(array, *commissioned)) return refuse(*std::move(other));
  }
  const Missing missing = missing_in(array, calibration != nullptr, commissioned != nullptr);
  if (!missing.none()) return refuse(missing.told(array));
  MotionPlan out;
  if (const std::string& group = array.motion.gyro.group; !group.empty()) {
    io::FileExpected<GroupRates> rates = rates_of(array, gyros);
    if (!rates) return refuse(rates.error());
    out.rates = *std::move(rates);
  }
  out.array = calibration != nullptr ? calibrated_array(array, *calibration) : array.array;
  out.model = calibration != nullptr ? calibration->model : array.datasheet.model();
  out.setup = motion_setup_of(array, calibration, days, commissioned, out.rates ? &*out.rates : nullptr);
  out.clip_raw.fill(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < static_cast<std::size_t>(sensors); ++k) {
    const double full_scale_raw = array.datasheet.sensor[k].full_scale_raw;
    if (full_scale_raw > 0.0) out.clip_raw[k] = kClipShare * full_scale_raw;
  }
  if (const Expected<void> sound = check(out.array, out.setup); !sound) return refuse(beyond_use(array, sound.error()));
  if (!array.motion.clocks.empty()) {
    out.clocks = clock_plan_of(array, out.setup);
    if (std::optional<io::FileError> refused = apply_clocks(array, out)) return refuse(*std::move(refused));
  }
  if (array.motion.velocity_bound_mps) {
    out.inclination = inclination_setup_of(array);
    ContinuousInclination trial;
    if (const Expected<void> sound = trial.configure(out.array, out.setup, *out.inclination); !sound)
      return refuse(sound.error().index == 203
                        ? not_judged(array, "motion.inclination_window_s",
                                     "is shorter than four blocks, " + std::to_string(4 * out.setup.block_samples[2]) +
                                         " samples",
                                     "state a longer window, or leave velocity_bound_mps out")
                        : not_judged(array, "gravity", "is too uncertain for an inclination in motion",
                                     "state a smaller sigma, or leave motion.velocity_bound_mps out"));
  }
  if (MotionSets(out.array).size() == 0)
    return refuse(not_judged(array, "sensor", "has no axes that check each other whatever the force is",
                             "motion needs four axes, three in a plane or two parallel ones"));
  return out;
}

MotionSample MotionSampler::sample(const Sample& row) noexcept {
  MotionSample out;
  out.time_s = row.time_s;
  if (std::isfinite(row.temperature_degc)) temperature_degc_ = row.temperature_degc;
  const Readings gravity_sense = plan_.model.without_misalignment(row.raw, temperature_degc_, row.delivered);
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan_.array.size()); ++i) {
    if (!row.delivered.has(static_cast<int>(i)) || !std::isfinite(gravity_sense[i])) continue;
    out.reading_mps2[i] = -gravity_sense[i];
    out.delivered = out.delivered.with(static_cast<int>(i));
    if (std::fabs(row.raw[i]) >= plan_.clip_raw[i]) out.clipped = out.clipped.with(static_cast<int>(i));
  }
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
