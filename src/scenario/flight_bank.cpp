#include "flight_bank.hpp"

#include <cmath>

#include "plumb/core/units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Over which vibration is averaged, and what is slower is no vibration [s].
constexpr double kVibrationTime_s = 0.05;

using Mat4 = std::array<std::array<double, 4>, 4>;

Mat4 product(const Mat4& a, const Mat4& b) noexcept {
  Mat4 out{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) out[i][j] += a[i][k] * b[k][j];
    }
  }
  return out;
}

/// e^m by its series: for entries of up to 5 the terms left out are below 1e-16 of the sum.
Mat4 exponential(const Mat4& m) noexcept {
  Mat4 sum{}, term{};
  for (std::size_t i = 0; i < 4; ++i) sum[i][i] = term[i][i] = 1.0;
  for (int n = 1; n <= 60; ++n) {
    term = product(term, m);
    for (auto& row : term) {
      for (double& x : row) x /= n;
    }
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) sum[i][j] += term[i][j];
    }
  }
  return sum;
}

std::uint64_t power_of_two(std::size_t least) noexcept {
  std::uint64_t rows = 1;
  while (rows < least) rows *= 2;
  return rows;
}

}  // namespace

FlightBank::FlightBank(const std::vector<BankSensor>& sensors, const std::vector<double>& gyro_hz, double nominal_hz,
                       double step_s, bool rectifies_before_filter, std::size_t instants)
    : sensors_(sensors.size()),
      channels_(sensors.size() + kNominal + 3 * gyro_hz.size()),
      before_filter_(rectifies_before_filter),
      mean_share_(step_s / kVibrationTime_s),
      mask_(power_of_two(instants) - 1),
      values_((mask_ + 1) * channels_),
      slopes_((mask_ + 1) * channels_) {
  for (std::size_t c = 0; c < channels_; ++c) {
    gain_[c] = 1.0;
    if (c < sensors_) {
      set_weights(c, sensors[c]);
      gain_[c] = sensors[c].gain;
      rectification_[c] = sensors[c].rectification;
    }
    const std::size_t first_gyro = sensors_ + kNominal;
    const double others_hz = c < first_gyro ? nominal_hz : gyro_hz[(c - first_gyro) / 3];
    set_filter(c, c < sensors_ ? sensors[c].bandwidth_hz : others_hz, step_s);
  }
}

/// y'' = p^2 (u - y) - sqrt(2) p y' with u from u0 to u1 in one step, the step as the unit of time.
void FlightBank::set_filter(std::size_t channel, double bandwidth_hz, double step_s) noexcept {
  const double p = 2.0 * kPi * bandwidth_hz * step_s;
  Mat4 m{};  // y, y', u, u1 - u0
  m[0][1] = 1.0;
  m[1] = {-p * p, -std::sqrt(2.0) * p, p * p, 0.0};
  m[2][3] = 1.0;
  const Mat4 e = exponential(m);
  from_value_[channel] = e[0][0];
  from_slope_[channel] = e[0][1];
  from_last_[channel] = e[0][2] - e[0][3];
  from_now_[channel] = e[0][3];
  to_value_[channel] = e[1][0];
  to_slope_[channel] = e[1][1];
  to_last_[channel] = e[1][2] - e[1][3];
  to_now_[channel] = e[1][3];
}

/// h.f + h.(alpha x r) + h.(w (w.r) - r w^2)
void FlightBank::set_weights(std::size_t channel, const BankSensor& sensor) noexcept {
  const Vec3& h = sensor.axis;
  const Vec3& r = sensor.lever_arm_m;
  const Vec3 turned = cross(r, h);
  for (std::size_t k = 0; k < 3; ++k) {
    weight_[k][channel] = h[k];
    weight_[3 + k][channel] = turned[k];
    weight_[6 + k][channel] = h[k] * r[k] - dot(h, r);
  }
  weight_[9][channel] = h[0] * r[1] + h[1] * r[0];
  weight_[10][channel] = h[0] * r[2] + h[2] * r[0];
  weight_[11][channel] = h[1] * r[2] + h[2] * r[1];
}

void FlightBank::filter(const Row& input) noexcept {
  for (std::size_t c = 0; c < channels_; ++c) {
    const double value =
        from_value_[c] * value_[c] + from_slope_[c] * slope_[c] + from_last_[c] * last_[c] + from_now_[c] * input[c];
    slope_[c] = to_value_[c] * value_[c] + to_slope_[c] * slope_[c] + to_last_[c] * last_[c] + to_now_[c] * input[c];
    value_[c] = value;
    last_[c] = input[c];
  }
}

void FlightBank::rectify(const Row& input) noexcept {
  for (std::size_t c = 0; c < sensors_; ++c) {
    mean_[c] += mean_share_ * (input[c] - mean_[c]);
    const double vibration = input[c] - mean_[c];
    square_[c] += mean_share_ * (vibration * vibration - square_[c]);
  }
}

void FlightBank::step(const MotionInstant& motion) noexcept {
  const Vec3& f = motion.specific_force_mps2;
  const Vec3& w = motion.rate_radps;
  const Vec3& a = motion.angular_acceleration_radps2;
  const std::array<double, kWeights> source = {
      f[0], f[1], f[2], a[0], a[1], a[2], w[0] * w[0], w[1] * w[1], w[2] * w[2], w[0] * w[1], w[0] * w[2], w[1] * w[2]};
  Row input{};
  for (std::size_t k = 0; k < kWeights; ++k) {
    for (std::size_t c = 0; c < sensors_; ++c) input[c] += weight_[k][c] * source[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    input[sensors_ + k] = f[k];
    input[sensors_ + 3 + k] = w[k];
    input[sensors_ + 6 + k] = a[k];
    for (std::size_t c = sensors_ + kNominal; c < channels_; c += 3) input[c + k] = w[k];
  }
  filter(input);
  rectify(before_filter_ ? input : value_);
  const std::size_t row = (steps_ & mask_) * channels_;
  for (std::size_t c = 0; c < channels_; ++c) {
    values_[row + c] = gain_[c] * value_[c] + rectification_[c] * square_[c];
    slopes_[row + c] = gain_[c] * slope_[c];
  }
  ++steps_;
}

/// Cubic through the values and slopes of both neighbours: straight lines would miss 0.5 % of a tone of 250 Hz.
double FlightBank::between(std::size_t channel, std::uint64_t instant, double part) const noexcept {
  const double y0 = at(values_, instant)[channel];
  if (!(part > 0.0)) return y0;
  const double y1 = at(values_, instant + 1)[channel];
  const double d0 = at(slopes_, instant)[channel];
  const double d1 = at(slopes_, instant + 1)[channel];
  const double up = y1 - y0;
  return y0 + part * (d0 + part * ((3.0 * up - 2.0 * d0 - d1) + part * (d0 + d1 - 2.0 * up)));
}

Vec3 FlightBank::rate(std::size_t gyro, std::uint64_t instant, double part) const noexcept {
  const std::size_t first = sensors_ + kNominal + 3 * gyro;
  return {between(first, instant, part), between(first + 1, instant, part), between(first + 2, instant, part)};
}

Vec3 FlightBank::nominal(std::size_t number, std::uint64_t instant) const noexcept {
  const double* first = at(values_, instant) + sensors_ + 3 * number;
  return {first[0], first[1], first[2]};
}

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
