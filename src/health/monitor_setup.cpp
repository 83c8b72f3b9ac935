#include "plumb/health/monitor_setup.hpp"

#include <cmath>
#include <limits>

#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

namespace {

/// Of a product of two rows of the output frame: a published vector is wrong by no more than as large a part.
constexpr double kFrameTolerance = 1e-6;

bool finite(double value) noexcept { return std::fabs(value) <= std::numeric_limits<double>::max(); }

Expected<void> sound_frame(const Mat3& frame) noexcept {
  for (size_t a = 0; a < 3; ++a) {
    for (size_t b = 0; b < 3; ++b) {
      double product = a == b ? -1.0 : 0.0;
      for (size_t k = 0; k < 3; ++k) product += frame[3 * a + k] * frame[3 * b + k];
      if (!(std::fabs(product) <= kFrameTolerance))
        return fail(Errc::frame_not_orthogonal, static_cast<int>(a), product, kFrameTolerance);
    }
  }
  return {};
}

/// What is said of one sensor.
Expected<void> sound_sensor(const MonitorSetup& setup, int i) noexcept {
  const auto a = static_cast<size_t>(i);
  const SensorCoefficients& c = setup.model.sensor[a];
  const double full = setup.full_scale_raw[a], code = setup.resolution_raw[a];
  double sum = full + code + c.reference_degc;
  for (size_t k = 0; k < 4; ++k) sum += c.scale[k] + c.bias[k];
  for (const double arm_m : setup.lever_arm_m[a]) sum += arm_m;
  if (!finite(sum)) return fail(Errc::not_finite, i, sum, 0.0);
  if (full < 0.0 || code < 0.0) return fail(Errc::out_of_range, i, full < 0.0 ? full : code, 0.0);
  const double scale = std::fabs(setup.model.scale_at(i, c.reference_degc));
  if (!(scale > 0.0)) return fail(Errc::out_of_range, i, scale, 0.0);
  const double reach_mps2 = full / scale - std::fabs(setup.model.bias_at(i, c.reference_degc));
  const double needed_mps2 = (1.0 + kFullScaleMargin) * setup.gravity.g_mps2;
  if (full > 0.0 && !(reach_mps2 >= needed_mps2)) return fail(Errc::range_too_small, i, reach_mps2, needed_mps2);
  return {};
}

Expected<void> sound_age(const MonitorSetup& setup) noexcept {
  const double days = setup.days_since_calibration;
  const double most = setup.calibrated ? kMostDaysSinceCalibration : 0.0;
  if (!finite(days)) return fail(Errc::not_finite, -1, days, 0.0);
  if (days < 0.0) return fail(Errc::out_of_range, -1, days, 0.0);
  if (days > most) return fail(Errc::out_of_range, -1, days, most);
  return {};
}

/// How far a sensor may be from its datasheet, which the first calibration starts from.
Expected<void> sound_prior(const SensorArray& array, int i) noexcept {
  const Prior open = prior_in(array, i), most = Recalibration::kMostOpen;
  const std::array<std::array<double, 2>, 3> figures = {
      {{open.bias_mps2, most.bias_mps2}, {open.scale, most.scale}, {open.axis_rad, most.axis_rad}}};
  for (const std::array<double, 2>& f : figures) {
    if (!(f[0] >= Recalibration::kLeastOpen && f[0] <= f[1])) return fail(Errc::implausible, i, f[0], f[1]);
  }
  return {};
}

}  // namespace

Expected<void> plausible(const GravityReference& gravity) noexcept {
  const auto given = gravity.model == GravityModel::magnetic ? given_field(gravity.g_mps2, gravity.sigma_mps2)
                                                             : given_gravity(gravity.g_mps2, gravity.sigma_mps2);
  if (given) return {};
  const Error& e = given.error();
  return fail(Errc::implausible_gravity, e.index == 0 ? 0 : 1, e.value, e.limit);
}

Expected<void> checked(const MonitorSetup& setup) noexcept {
  const int n = setup.array.size();
  if (n < 3) return fail(Errc::too_few_sensors, -1, n, 3);
  if (setup.model.size != n) return fail(Errc::not_calibrated, -1, setup.model.size, n);
  for (double m : setup.model.misalignment) {
    if (m != 0.0) return fail(Errc::not_calibrated, -1, m, 0.0);
  }
  double least_sigma = setup.array.sigma_mps2(0);
  for (int i = 1; i < n; ++i) least_sigma = std::fmin(least_sigma, setup.array.sigma_mps2(i));
  for (int i = 0; i < n; ++i) {
    const double sigma = setup.array.sigma_mps2(i);
    if (!(sigma <= kMaxSigmaRatio * least_sigma))
      return fail(Errc::out_of_range, i, sigma, kMaxSigmaRatio * least_sigma);
  }
  Expected<void> sound = plausible(setup.gravity);
  for (int i = 0; i < n && sound; ++i) sound = sound_sensor(setup, i);
  for (int i = 0; i < n && sound; ++i) sound = checked(setup.stability[static_cast<size_t>(i)], i);
  if (sound) sound = sound_age(setup);
  if (sound) sound = sound_frame(setup.output_frame);
  if (!sound) return sound;
  if (!kCalibratesItself && !setup.calibrated) return fail(Errc::not_calibrated, -1, 0.0, 1.0);
  // The first calibration takes the length at every station for gravity's.
  const double push_mps2 = setup.config.acceleration_bound_mps2;
  if (sound && !setup.calibrated && push_mps2 > 0.0) return fail(Errc::may_accelerate, -1, push_mps2, 0.0);
  for (int i = 0; i < n && sound && !setup.calibrated; ++i) sound = sound_prior(setup.array, i);
  if (sound && !setup.array.uncertainty().is_covariance()) return fail(Errc::implausible);
  return sound;
}

Expected<void> set_datasheet(const Datasheet& datasheet, MonitorSetup& setup) noexcept {
  const Expected<SensorArray> array = datasheet.array();
  if (!array) return tl::unexpected<Error>(array.error());
  setup.model = datasheet.model();
  setup.array = *array;
  setup.array.set_uncertainty(datasheet.uncertainty());
  for (int i = 0; i < datasheet.size; ++i) {
    setup.full_scale_raw[static_cast<size_t>(i)] = datasheet.sensor[static_cast<size_t>(i)].full_scale_raw;
    setup.resolution_raw[static_cast<size_t>(i)] = datasheet.sensor[static_cast<size_t>(i)].resolution_raw;
  }
  setup.calibrated = false;
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
