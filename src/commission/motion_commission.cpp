#include "plumb/commission/motion_commission.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "plumb/motion/motion_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {
namespace {

constexpr double kMostLagPeriods = 32.0;

Vec3 row_of(const FittedUnit& unit, std::size_t c) noexcept {
  return {unit.rows[3 * c], unit.rows[3 * c + 1], unit.rows[3 * c + 2]};
}

/// Noise of a sample that would leave as much in block pairs as the fit leaves: that of single samples is vibration,
/// which falls much faster with the length of a block than noise and which the lag accounts for.
double noise_of(const MotionFit& fit, const CommissionSettings& settings) {
  if (settings.bounds.noise_mps2 > 0.0) return settings.bounds.noise_mps2;
  MotionMeans block;
  block.samples = kMotionSamples[static_cast<std::size_t>(settings.fit.scale)];
  return fit.residual_mps2 / std::sqrt(block.noise_share());
}

Expected<SensorArray> array_of(const MotionFit& fit, double noise_mps2) {
  std::vector<SensorRow> rows;
  for (std::size_t u = 0; u < fit.unit.size(); ++u) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 row = row_of(fit.unit[u], c);
      const std::string id = std::string("u") + std::to_string(u + 1) + "xyz"[c];
      rows.push_back({make_id(id.c_str()), scaled(row, 1.0 / norm(row)), noise_mps2,
                      static_cast<std::uint8_t>(rows.size() / 3 + 1)});
    }
  }
  return SensorArray::make(rows.data(), static_cast<int>(rows.size()));
}

double largest(const Vec3& v) noexcept { return std::max({v[0], v[1], v[2]}); }

/// All but the lag. Rows and bias of a unit are known together better than each alone: what they are off by together,
/// among the forces of the recording, is bounded as a bias; scale and axis have their floors for what goes beyond.
MotionErrors errors_of(const FittedUnit& unit, std::size_t c, const BoundRule& rule) {
  MotionErrors out;
  out.scale = rule.scale;
  out.axis_rad = rule.axis_rad;
  out.bias_mps2 = rule.bias_mps2 + rule.factor * unit.model_sigma_mps2[c];
  out.lever_m = rule.lever_m + rule.factor * largest(unit.arm_sigma_m);
  return out;
}

GyroErrors gyro_errors_of(const MotionLog& log, const std::vector<UnitAlignment>& alignment, const BoundRule& rule) {
  GyroErrors out = rule.gyro;
  double square = 0.0, count = 0.0;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    const MotionSample sample = sample_of(log, k);
    const Vec3 difference = minus(sample.rate_radps[0], sample.rate_radps[1]);
    if (!std::isfinite(norm(difference))) continue;
    square += dot(difference, difference), count += 6.0;
  }
  out.noise_radps = std::sqrt(square / count);
  for (const UnitAlignment& unit : alignment) {
    out.axis_rad = std::max(out.axis_rad, rule.factor * largest(unit.turn_sigma_rad));
    out.lag_s = std::max(out.lag_s, rule.factor * unit.delay_sigma_s);
  }
  return out;
}

void set_lag(double lag_s, const MotionFit& fit, const BoundRule& rule, MotionSetup* setup) {
  for (std::size_t i = 0; i < 3 * fit.unit.size(); ++i) {
    const FittedUnit& unit = fit.unit[i / 3];
    setup->errors[i].lag_s = std::max(lag_s, std::fabs(unit.lag_s) + rule.factor * unit.lag_sigma_s);
  }
}

bool contradicts_itself(const MotionCommissioning& found, const MotionLog& log) {
  const auto monitor = std::make_unique<MotionMonitor>();
  if (!monitor->configure(found.array, found.setup)) return true;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    if (monitor->step(found.sample(log, k)).alarm) return true;
  }
  return false;
}

/// The least lag with which the monitor finds the recording without contradiction, to a part in a hundred; none where
/// none is enough.
double lag_needed(MotionCommissioning found, const MotionLog& log, const BoundRule& rule) {
  double low = 0.0, high = kMostLagPeriods * log.period_s;
  set_lag(high, found.fit, rule, &found.setup);
  if (contradicts_itself(found, log)) return -1.0;
  while (high - low > 0.01 * high) {
    const double middle = 0.5 * (low + high);
    set_lag(middle, found.fit, rule, &found.setup);
    (contradicts_itself(found, log) ? low : high) = middle;
    if (high < 1e-6) break;
  }
  return high;
}

MotionSetup setup_of(const MotionFit& fit, const BoundRule& rule) {
  MotionSetup out;
  out.gyros = kGyros;
  out.rate_bound_radps = rule.rate_bound_radps;
  Vec3 middle{};
  for (const FittedUnit& unit : fit.unit)
    middle = plus(middle, scaled(unit.arm_m, 1.0 / static_cast<double>(fit.unit.size())));
  for (std::size_t i = 0; i < 3 * fit.unit.size(); ++i) {
    const FittedUnit& unit = fit.unit[i / 3];
    out.lever_arm_m[i] = minus(unit.arm_m, middle);
    out.errors[i] = errors_of(unit, i % 3, rule);
  }
  return out;
}

}  // namespace

MotionLog MotionCommissioning::aligned(const MotionLog& log, const std::vector<UnitAlignment>& clocks) const {
  std::vector<UnitAlignment> both = clocks;
  for (std::size_t u = 0; u < both.size() && u < alignment.size(); ++u) both[u].to_frame = alignment[u].to_frame;
  return commission::aligned(log, both);
}

MotionSample MotionCommissioning::sample(const MotionLog& aligned_log, std::size_t k) const {
  MotionSample out = sample_of(aligned_log, k);
  for (std::size_t i = 0; i < 3 * fit.unit.size(); ++i) {
    const FittedUnit& unit = fit.unit[i / 3];
    out.reading_mps2[i] = (out.reading_mps2[i] - unit.bias_mps2[i % 3]) / norm(row_of(unit, i % 3));
  }
  return out;
}

CommissionExpected<MotionCommissioning> commission_motion(const MotionLog& log, const CommissionSettings& settings) {
  const BoundRule& rule = settings.bounds;
  const CommissionExpected<std::vector<UnitAlignment>> alignment = align_by_gyros(log, settings.alignment);
  if (!alignment) return tl::unexpected<std::string>(alignment.error());
  MotionCommissioning out;
  out.alignment = *alignment;
  const MotionLog level = commission::aligned(log, out.alignment);
  const CommissionExpected<MotionFit> fit = fit_motion(level, out.alignment, settings.fit);
  if (!fit) return tl::unexpected<std::string>(fit.error());
  out.fit = *fit;
  const Expected<SensorArray> array = array_of(out.fit, noise_of(out.fit, settings));
  if (!array) {
    return tl::unexpected<std::string>(std::string("the fitted axes: ") + describe(array.error().code) +
                                       ". Remedy: " + remedy(array.error().code));
  }
  out.array = *array;
  out.setup = setup_of(out.fit, rule);
  out.setup.sample_period_s = log.period_s;
  out.setup.shortest_block = rule.shortest_block;
  out.setup.gyro = gyro_errors_of(level, out.alignment, rule);
  out.lag_needed_s = lag_needed(out, level, rule);
  if (out.lag_needed_s < 0.0) {
    return tl::unexpected<std::string>(
        "the units contradict each other whatever skew is allowed for. Remedy: look for a "
        "faulty sensor, a lost row or a loose mounting");
  }
  set_lag(std::max(rule.lag_factor * out.lag_needed_s, rule.lag_periods * log.period_s), out.fit, rule, &out.setup);
  return out;
}

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
