#include "plumb/survey/checks.hpp"

#include <algorithm>
#include <cmath>

#include "algebra.hpp"
#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

Check compare(double measured, double reference, double sigma, double bias, double fixed,
              const CheckSettings& settings) {
  Check out{measured, reference, sigma, fixed, false};
  if (settings.limits == LimitKind::from_uncertainty)
    out.limit = normal_tail_quantile(0.5 * std::clamp(settings.false_alarm, 1e-15, 0.999)) * sigma + bias;
  out.passed = std::fabs(out.difference()) <= out.limit;  // NaN fails
  return out;
}

double root_of_squares(double a, double b, double c) { return std::hypot(a, std::hypot(b, c)); }

tl::unexpected<Undefined> because(NoAngle why) { return tl::unexpected<Undefined>(Undefined{why, 0.0, 0.0}); }

/// Takes back what the checks forbid.
void withhold(Attitude& attitude, StationStatus status) {
  if (status == StationStatus::accepted) return;
  if (status == StationStatus::rejected) {
    attitude.inclination = because(NoAngle::gravity_failed);
    attitude.gravity_toolface = attitude.inclination;
    attitude.magnetic_toolface = attitude.inclination;
    attitude.azimuth = because(NoAngle::gravity_failed);
    attitude.covariance.fill(0.0);
    return;
  }
  attitude.magnetic_toolface = because(NoAngle::field_failed);
  attitude.azimuth = because(NoAngle::field_failed);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      if (row > 1 || column > 1) attitude.covariance[4 * row + column] = 0.0;
    }
  }
}

}  // namespace

const char* to_string(LimitKind kind) noexcept { return kind == LimitKind::fixed ? "fixed" : "from uncertainty"; }

const char* to_string(StationStatus status) noexcept {
  switch (status) {
    case StationStatus::accepted: return "accepted";
    case StationStatus::inclination_only: return "inclination only";
    case StationStatus::rejected: return "rejected";
  }
  return "?";
}

StationChecks check_station(const Measurement& station, const Covariance6& total, const Reference& reference,
                            const CheckSettings& settings) {
  const Totals totals = totals_of(station.gravity_mps2, station.field_tesla);
  const std::array<double, 18> derivatives = totals_jacobian(station.gravity_mps2, station.field_tesla);
  const auto j = matrix_of<3, 6>(derivatives);
  const Eigen::Vector3d variance = (j * matrix_of<6, 6>(total) * j.transpose()).diagonal().cwiseMax(0.0);
  const auto bias = [&](int row) {
    double sum = 0.0;
    for (int k = 0; k < 6; ++k) sum += std::fabs(j(row, k)) * station.bias_bound[static_cast<std::size_t>(k)];
    return sum;
  };
  const geomagnetic::FieldReference& field = reference.field;
  StationChecks out;
  out.gravity = compare(totals.gravity_mps2, reference.gravity.g_mps2,
                        std::hypot(std::sqrt(variance[0]), reference.gravity.sigma_mps2), bias(0),
                        settings.fixed.gravity_mps2, settings);
  out.field =
      compare(totals.field_tesla, field.total_tesla,
              root_of_squares(std::sqrt(variance[1]), field.total_tesla_sigma.common, field.total_tesla_sigma.random),
              bias(1), settings.fixed.field_tesla, settings);
  out.dip = compare(totals.dip_rad, field.dip_rad,
                    root_of_squares(std::sqrt(variance[2]), field.dip_rad_sigma.common, field.dip_rad_sigma.random),
                    bias(2), settings.fixed.dip_rad, settings);
  return out;
}

SurveyStation judge_station(const Measurement& station, const Reference& reference, const StationSettings& settings) {
  const Covariance6 total = total_covariance(station, settings.tool);
  const StationChecks checks = check_station(station, total, reference, settings.checks);
  SurveyStation out{station,
                    reference,
                    checks,
                    StationStatus::rejected,
                    attitude_of(station, total),
                    because(NoAngle::gravity_failed),
                    because(NoAngle::gravity_failed)};
  if (checks.gravity.passed && out.attitude.inclination)
    out.status = checks.field_passed() ? StationStatus::accepted : StationStatus::inclination_only;
  withhold(out.attitude, out.status);
  if (!out.attitude.azimuth) {
    out.true_azimuth = tl::unexpected<Undefined>(out.attitude.azimuth.error());
    out.grid_azimuth = tl::unexpected<Undefined>(out.attitude.azimuth.error());
    return out;
  }
  out.true_azimuth = true_azimuth(*out.attitude.azimuth, reference.field);
  if (out.true_azimuth)
    out.grid_azimuth = grid_azimuth(*out.true_azimuth, settings.convergence);
  else
    out.grid_azimuth = tl::unexpected<Undefined>(out.true_azimuth.error());
  return out;
}

std::string SurveyStation::flags() const {
  std::string out;
  if (!std::isfinite(checks.gravity.measured + checks.field.measured + checks.dip.measured)) out += 'N';
  if (!checks.gravity.passed) out += 'G';
  if (!checks.field.passed) out += 'B';
  if (!checks.dip.passed) out += 'D';
  if (!attitude.azimuth && attitude.azimuth.error().why == NoAngle::vertical) out += 'V';
  if (!attitude.azimuth && attitude.azimuth.error().why == NoAngle::no_horizontal) out += 'H';
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
