// A calibration that the host brings: what is taken from it, and when it is tried.
#include <cmath>
#include <limits>

#include "plumb/array/geometry.hpp"
#include "plumb/health/recalibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

using Row = std::array<double, 4>;     // of a sensor's parameters: W_x, W_y, W_z, b
using Block = std::array<double, 16>;  // of two sensors' parameters, by rows

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
constexpr std::size_t packed(int a, int b) noexcept { return at(a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a); }

/// Scale changes W along the axis, bias is b.
Row direction_of(const SensorArray& array, int parameter) noexcept {
  const Vec3& h = array.axis(parameter / 2);
  return parameter % 2 == 0 ? Row{h[0], h[1], h[2], 0.0} : Row{0.0, 0.0, 0.0, 1.0};
}

double covariance_along(const RowUncertainty& u, int i, const Row& a, int j, const Row& b) noexcept {
  double sum = 0.0;
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) sum += a[at(p)] * u.covariance[packed(4 * i + p, 4 * j + q)] * b[at(q)];
  }
  return sum;
}

/// L C R', where a side that is taken over keeps only what lies across its axis.
Block kept_part(const SensorArray& array, int i, bool i_taken, int j, bool j_taken) noexcept {
  const auto across = [&array](int sensor, bool taken, int p, int q) {
    if (!taken) return p == q ? 1.0 : 0.0;
    if (p == 3 || q == 3) return 0.0;
    return (p == q ? 1.0 : 0.0) - array.axis(sensor)[at(p)] * array.axis(sensor)[at(q)];
  };
  Block half{}, out{};
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) {
      for (int k = 0; k < 4; ++k) {
        half[at(4 * p + q)] += across(i, i_taken, p, k) * array.uncertainty().covariance[packed(4 * i + k, 4 * j + q)];
      }
    }
  }
  for (int p = 0; p < 4; ++p) {
    for (int q = 0; q < 4; ++q) {
      for (int k = 0; k < 4; ++k) out[at(4 * p + q)] += half[at(4 * p + k)] * across(j, j_taken, q, k);
    }
  }
  return out;
}

/// 1 sigma of an axis, in one direction across it [rad].
double axis_sigma_rad(const SensorArray& array, int i) noexcept {
  const Block across = kept_part(array, i, true, i, true);
  return std::sqrt(std::fmax(0.0, across[0] + across[5] + across[10]) / 2.0);
}

}  // namespace

double Recalibration::offered_variance(int parameter) const noexcept {
  return offered_covariance_[packed(parameter, parameter)];
}

void Recalibration::keep_offered_covariance(const SensorArray& array) noexcept {
  for (int a = 0; a < 2 * array.size(); ++a) {
    for (int b = 0; b <= a; ++b) {
      offered_covariance_[packed(a, b)] =
          covariance_along(array.uncertainty(), a / 2, direction_of(array, a), b / 2, direction_of(array, b));
    }
  }
}

/// What of one sensor's calibration is taken, and what is wrong with it at sight.
Error Recalibration::read_offer(const InForce& in_force, const SensorModel& model, const SensorArray& array,
                                int i) noexcept {
  const double limit_rad = kCommissioningSigmas * std::fmax(kOfferAxis_rad, axis_sigma_rad(in_force.array, i));
  const double off_rad = angle_between_rad(array.axis(i), in_force.array.axis(i));
  if (!(off_rad <= limit_rad)) return Error{Errc::implausible, i, off_rad, limit_rad};
  const double worst = std::fmax(std::sqrt(offered_variance(2 * i)) / drift_[at(i)].scale,
                                 std::sqrt(offered_variance(2 * i + 1)) / drift_[at(i)].bias_mps2);
  const double least = std::fmin(offered_variance(2 * i), offered_variance(2 * i + 1));
  if (!(least > 0.0 && worst <= 1.0)) return Error{Errc::implausible, i, worst, 1.0};
  const SensorCoefficients& now = in_force.model.sensor[at(i)];
  length_[at(i)] = model.scale_at(i, now.reference_degc) / now.scale[0];
  shift_mps2_[at(i)] = model.bias_at(i, now.reference_degc) * length_[at(i)] - now.bias[0];
  return Error{};
}

Expected<void> Recalibration::offer(const InForce& in_force, const SensorModel& model, const SensorArray& array,
                                    SensorSet sensors, double time_s) noexcept {
  const int n = in_force.array.size();
  offered_sensors_ = 0;
  if (model.size != n || array.size() != n) return fail(Errc::not_calibrated, -1, model.size, n);
  for (double m : model.misalignment) {
    if (m != 0.0) return fail(Errc::not_calibrated, -1, m, 0.0);
  }
  // Between two fits none of this means anything yet.
  sensors_ = sensors;
  keep_offered_covariance(array);
  Error error;
  for (int i = 0; i < n && error.code == Errc::ok; ++i) {
    if (sensors.has(i)) error = read_offer(in_force, model, array, i);
  }
  if (error.code == Errc::ok) error = check_bounds(in_force.model, time_s);
  if (error.code != Errc::ok) return tl::unexpected<Error>(error);
  offered_sensors_ = n;
  offered_s_ = time_s;
  return {};
}

void Recalibration::withdraw_offer() noexcept {
  if (!offered() || phase_ != RecalibrationPhase::idle) return;
  offered_sensors_ = 0;
  refusal_ = Error{Errc::wrong_state};
}

/// No fit: the stations are waited for until they move gravity along every axis, then judge.
Recalibration::Outcome Recalibration::examine_offer(const InForce& in_force, double time_s) noexcept {
  if (untried_ && store_.size() >= kOfferStations && ready(in_force)) return judge(in_force, time_s);
  const double waited_s = time_s - offered_s_;
  if (waited_s >= 0.0 && waited_s <= kOfferLife_s) return Outcome::none;
  refusal_ = Error{Errc::too_few_stations, -1, 1.0 * store_.size(), 1.0 * kOfferStations};
  stop();
  return Outcome::rejected;
}

/// Axes as sure as they were; biases and scales as sure as the offer says, whose tests have confirmed it. What the two
/// share is not known here and left out.
void Recalibration::uncertainty_of_offer(const SensorArray& array, RowUncertainty& out) const noexcept {
  out = array.uncertainty();
  for (int i = 0; i < array.size(); ++i) {
    for (int j = 0; j <= i; ++j) {
      const bool both = sensors_.has(i) && sensors_.has(j);
      const Block kept = kept_part(array, i, sensors_.has(i), j, sensors_.has(j));
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < (i == j ? p + 1 : 4); ++q) {
          double sum = kept[at(4 * p + q)];
          for (int k = 0; both && k < 4; ++k) {
            const int a = 2 * i + k / 2, b = 2 * j + k % 2;
            sum += direction_of(array, a)[at(p)] * offered_covariance_[packed(a, b)] * direction_of(array, b)[at(q)];
          }
          out.covariance[packed(4 * i + p, 4 * j + q)] = sum;
        }
      }
    }
  }
}

/// The part that moves the vector and leaves the readings in agreement, whatever the attitude. Its stations know it by
/// the length alone, within the bound on gravity and on the calibration, and an offer may be wrong about its sigmas.
Recalibration::Change Recalibration::unseen_by_parity(const SensorArray& array, const Change& change) const noexcept {
  const LeastSquares map = least_squares(array, sensors_);
  if (!map.valid) return change;
  Change out{};
  for (int p = 0; p < 4; ++p) {
    Readings readings{};
    for (int i = 0; i < array.size(); ++i) readings[at(i)] = change[at(4 * i + p)];
    const Vec3 x = map.estimate(readings);
    for (int i = 0; i < array.size(); ++i) {
      if (sensors_.has(i)) out[at(4 * i + p)] = dot(array.axis(i), x);
    }
  }
  return out;
}

/// What was read back can only be what `offer` has let pass.
bool Recalibration::offer_is_plausible(const InForce& in_force) const noexcept {
  if (offered_sensors_ != in_force.array.size() || fitting()) return false;
  for (int a = 0; a < 2 * offered_sensors_; ++a) {
    for (int b = 0; b <= a; ++b) {
      const double c = offered_covariance_[packed(a, b)];
      if (!(c * c <= offered_variance(a) * offered_variance(b) * (1.0 + 1e-9))) return false;
    }
    const double limit = a % 2 == 0 ? drift_[at(a / 2)].scale : drift_[at(a / 2)].bias_mps2;
    const bool sane = offered_variance(a) > 0.0 && offered_variance(a) <= limit * limit;
    if (sensors_.has(a / 2) && !sane) return false;
  }
  const double any_time_s = std::numeric_limits<double>::infinity();
  return check_bounds(in_force.model, any_time_s).code == Errc::ok;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
