#include "plumb/scenario/flight.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "flight_bank.hpp"
#include "flight_errors.hpp"
#include "flight_motion.hpp"
#include "flight_random.hpp"
#include "plumb/scenario/portable_math.hpp"
#include "tilted.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace scenario {
namespace {

/// Instants per sample.
constexpr std::uint64_t kOversampling = 8;

/// Instants before the first sample: 0.25 s, in which filters settle and which sensors that are late look back on.
std::uint64_t lead_in(double rate_hz) noexcept {
  return kOversampling * static_cast<std::uint64_t>(std::ceil(0.25 * rate_hz));
}

std::vector<BankSensor> bank_sensors(const FlightSpec& spec, const std::vector<FlightSensorErrors>& errors) {
  std::vector<BankSensor> out;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const FlightSensorErrors& wrong = errors[i];
    BankSensor one;
    one.axis = tilted(spec.axis[i], wrong.axis_x_rad, wrong.axis_y_rad);
    one.lever_arm_m = plus(spec.lever_arm_m[i], wrong.lever_error_m);
    one.gain = 1.0 + wrong.scale;
    one.bandwidth_hz = spec.bandwidth_hz * (1.0 + wrong.bandwidth);
    one.rectification = wrong.rectification;
    out.push_back(one);
  }
  return out;
}

std::vector<double> gyro_bandwidths_hz(const FlightSpec& spec, const std::vector<FlightGyroErrors>& errors) {
  std::vector<double> out;
  for (const FlightGyroErrors& wrong : errors) out.push_back(spec.bandwidth_hz * (1.0 + wrong.bandwidth));
  return out;
}

double clipped_at(double x, double full_scale) noexcept { return std::clamp(x, -full_scale, full_scale); }

double sine_of_cycles(double cycles) noexcept { return portable_sincos(2.0 * kPi * (cycles - std::floor(cycles))).sin; }

}  // namespace

class Flight::Parts {
 public:
  explicit Parts(const FlightSpec& what);
  FlightSample next();

  const FlightSpec spec;
  const std::vector<FlightSensorErrors> errors;
  const std::vector<FlightGyroErrors> gyro_errors;

 private:
  /// How far sensors look ahead of the sample's instant and back, in instants.
  struct Reach {
    std::uint64_t ahead = 2, back = 2;
  };
  Reach reach() const noexcept;
  double skew_s(std::size_t sensor, double time_s) const noexcept;
  /// An instant of the bank, and the part of a step after it.
  struct Moment {
    std::uint64_t instant = 0;
    double part = 0.0;
  };
  Moment moment(double skew_s) const noexcept;
  double reading_mps2(std::size_t sensor, double time_s) noexcept;
  Vec3 rate_radps(std::size_t gyro, double time_s) noexcept;

  const double step_s_;
  const Reach reach_;
  Motion motion_;
  FlightBank bank_;
  std::vector<NormalSource> noise_, gyro_noise_;
  std::vector<std::array<Vec3, 3>> gyro_axes_;
  std::vector<std::optional<double>> last_mps2_;
  std::vector<std::optional<Vec3>> last_radps_;
  std::uint64_t sample_ = 0;
  std::uint64_t instant_;  ///< of the sample
};

Flight::Parts::Reach Flight::Parts::reach() const noexcept {
  double ahead_s = 0.0, back_s = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    double latest_s = errors[i].skew_s, earliest_s = errors[i].skew_s;
    for (const FlightFault& fault : spec.faults) {
      if (fault.kind != FlightFaultKind::skew || !fault.sensors.has(static_cast<int>(i))) continue;
      latest_s += std::max(fault.size, 0.0);
      earliest_s += std::min(fault.size, 0.0);
    }
    ahead_s = std::max(ahead_s, latest_s);
    back_s = std::max(back_s, -earliest_s);
  }
  for (const FlightGyroErrors& wrong : gyro_errors) {
    ahead_s = std::max(ahead_s, wrong.skew_s);
    back_s = std::max(back_s, -wrong.skew_s);
  }
  return {static_cast<std::uint64_t>(ahead_s / step_s_) + 2, static_cast<std::uint64_t>(back_s / step_s_) + 2};
}

Flight::Parts::Parts(const FlightSpec& what)
    : spec(what),
      errors(draw_sensor_errors(spec)),
      gyro_errors(draw_gyro_errors(spec)),
      step_s_(1.0 / (spec.rate_hz * static_cast<double>(kOversampling))),
      reach_(reach()),
      motion_(spec.kind, spec.seed, step_s_, static_cast<double>(lead_in(spec.rate_hz)) * step_s_, spec.vibration),
      bank_(bank_sensors(spec, errors), gyro_bandwidths_hz(spec, gyro_errors), spec.bandwidth_hz, step_s_,
            spec.rectifies_before_filter, reach_.ahead + reach_.back),
      last_mps2_(errors.size()),
      last_radps_(gyro_errors.size()),
      instant_(lead_in(spec.rate_hz)) {
  for (std::uint32_t i = 0; i < errors.size(); ++i)
    noise_.emplace_back(flight_stream_of(spec.seed, flight_stream::kNoise + i));
  for (std::uint32_t g = 0; g < gyro_errors.size(); ++g) {
    std::array<Vec3, 3> axes{};
    for (std::uint32_t k = 0; k < 3; ++k) {
      axes[k][k] = 1.0;
      axes[k] = tilted(axes[k], gyro_errors[g].axis_x_rad[k], gyro_errors[g].axis_y_rad[k]);
      gyro_noise_.emplace_back(flight_stream_of(spec.seed, flight_stream::kGyroNoise + 3 * g + k));
    }
    gyro_axes_.push_back(axes);
  }
}

double Flight::Parts::skew_s(std::size_t sensor, double time_s) const noexcept {
  double skew_s = errors[sensor].skew_s;
  for (const FlightFault& fault : spec.faults) {
    const bool acts = fault.sensors.has(static_cast<int>(sensor)) && time_s >= fault.onset_s;
    if (fault.kind == FlightFaultKind::skew && acts) skew_s += fault.size;
  }
  return skew_s;
}

Flight::Parts::Moment Flight::Parts::moment(double skew_s) const noexcept {
  const double away = skew_s / step_s_;
  const double whole = std::floor(away);
  return {static_cast<std::uint64_t>(static_cast<std::int64_t>(instant_) + static_cast<std::int64_t>(whole)),
          away - whole};
}

double Flight::Parts::reading_mps2(std::size_t sensor, double time_s) noexcept {
  const Moment then = moment(skew_s(sensor, time_s));
  const double bias_mps2 = errors[sensor].bias_mps2;
  double x = bank_.sensor(sensor, then.instant, then.part) + bias_mps2;
  double noise = spec.noise_mps2 * noise_[sensor].next();
  std::optional<double> stands;
  std::uint32_t position = 0;
  for (const FlightFault& fault : spec.faults) {
    const std::uint32_t sub = flight_stream::kFaultNoise + 32 * position++ + static_cast<std::uint32_t>(sensor);
    if (!fault.sensors.has(static_cast<int>(sensor)) || time_s < fault.onset_s) continue;
    const double since_s = time_s - fault.onset_s;
    switch (fault.kind) {
      case FlightFaultKind::bias: x += fault.size; break;
      case FlightFaultKind::dead: x = bias_mps2; break;
      case FlightFaultKind::stuck: stands = last_mps2_[sensor]; break;
      case FlightFaultKind::noise: noise += fault.size * flight_stream_of(spec.seed, sub).normal(sample_); break;
      case FlightFaultKind::scale: x *= 1.0 + fault.size; break;
      case FlightFaultKind::skew: break;  // in the instant
      case FlightFaultKind::drift: x += fault.size * since_s; break;
      case FlightFaultKind::oscillation: x += fault.size * sine_of_cycles(fault.frequency_hz * since_s); break;
      case FlightFaultKind::saturated: stands = fault.size < 0.0 ? -spec.full_scale_mps2 : spec.full_scale_mps2; break;
    }
  }
  const double reading = stands ? *stands : clipped_at(x + noise, spec.full_scale_mps2);
  last_mps2_[sensor] = reading;
  return reading;
}

Vec3 Flight::Parts::rate_radps(std::size_t gyro, double time_s) noexcept {
  const FlightGyroErrors& wrong = gyro_errors[gyro];
  const Moment then = moment(wrong.skew_s);
  const Vec3 true_radps = bank_.rate(gyro, then.instant, then.part);
  Vec3 x{};
  for (std::size_t k = 0; k < 3; ++k)
    x[k] = (1.0 + wrong.scale[k]) * dot(gyro_axes_[gyro][k], true_radps) + wrong.bias_radps[k];
  Vec3 noise{};
  for (std::size_t k = 0; k < 3; ++k) noise[k] = spec.gyro_noise_radps * gyro_noise_[3 * gyro + k].next();
  std::optional<Vec3> stands;
  for (const GyroFault& fault : spec.gyro_faults) {
    if (fault.gyro != static_cast<int>(gyro) || time_s < fault.onset_s) continue;
    switch (fault.kind) {
      case GyroFaultKind::dead: x = wrong.bias_radps; break;
      case GyroFaultKind::stuck: stands = last_radps_[gyro]; break;
      case GyroFaultKind::scale: x = scaled(x, 1.0 + fault.size); break;
      case GyroFaultKind::bias: x = plus(x, {fault.size, fault.size, fault.size}); break;
    }
  }
  const Vec3 reading = stands ? *stands : plus(x, noise);
  last_radps_[gyro] = reading;
  return reading;
}

FlightSample Flight::Parts::next() {
  while (bank_.steps() < instant_ + reach_.ahead) bank_.step(motion_.next());
  FlightSample out;
  out.time_s = static_cast<double>(sample_) / spec.rate_hz;
  out.specific_force_mps2 = bank_.nominal(0, instant_);
  out.true_rate_radps = bank_.nominal(1, instant_);
  out.true_angular_acceleration_radps2 = bank_.nominal(2, instant_);
  for (std::size_t i = 0; i < errors.size(); ++i) out.reading_mps2[i] = reading_mps2(i, out.time_s);
  for (std::size_t g = 0; g < gyro_errors.size(); ++g) out.rate_radps[g] = rate_radps(g, out.time_s);
  ++sample_;
  instant_ += kOversampling;
  return out;
}

tl::expected<Flight, std::string> Flight::make(const FlightSpec& spec) {
  if (const auto allowed = check(spec); !allowed) return tl::unexpected<std::string>(allowed.error());
  return Flight(std::make_unique<Parts>(spec));
}

Flight::Flight(std::unique_ptr<Parts> parts) noexcept : parts_(std::move(parts)) {}
Flight::Flight(Flight&&) noexcept = default;
Flight& Flight::operator=(Flight&&) noexcept = default;
Flight::~Flight() = default;

FlightSample Flight::next() { return parts_->next(); }
const std::vector<FlightSensorErrors>& Flight::errors() const noexcept { return parts_->errors; }
const std::vector<FlightGyroErrors>& Flight::gyro_errors() const noexcept { return parts_->gyro_errors; }

}  // namespace scenario
}  // namespace PLUMB_ABI
}  // namespace plumb
