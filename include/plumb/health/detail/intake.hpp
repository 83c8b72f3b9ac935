/// What a monitor does with a sample before any evidence is taken from it: is its time in order, what do its channels
/// read, which channels have fallen silent.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "plumb/calibration/sensor_model.hpp"
#include "plumb/core/detail/flag.hpp"
#include "plumb/detection/channel_monitor.hpp"
#include "plumb/detection/stationarity.hpp"
#include "plumb/health/detail/in_force.hpp"
#include "plumb/health/detail/settings.hpp"
#include "plumb/health/rotation.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// How a sample's time stands to the one before.
enum class Arrival : std::uint8_t {
  refused,  ///< not finite, or not later: the sample must not be used
  in_order,
  after_gap,  ///< later than the longest gap allows
  /// Samples that increase among themselves have been refused for so long that they are the truth now; or the host says
  /// that time begins anew.
  new_time_base
};

/// So many refused samples that increase among themselves are a new time base, not a glitch.
inline constexpr int kNewTimeBase = 16;

/// Strictly increasing time, from the samples alone.
class SampleClock {
 public:
  void clear() noexcept { *this = SampleClock{}; }
  /// The next finite time is a new time base, whatever it is: somebody who knows says so.
  void expect_new_time_base() noexcept {
    started_ = false;
    refused_run_ = kNewTimeBase - 1;
  }
  Arrival admit(double time_s, double max_gap_s) noexcept;
  /// Of the last sample that was not refused; 0 before the first.
  double last_s() const noexcept { return last_s_; }

 private:
  double last_s_ = 0.0;
  double last_refused_s_ = 0.0;
  int refused_run_ = 0;
  Flag started_;

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using C = SampleClock;
    return field_list(&C::last_s_, &C::last_refused_s_, within(&C::refused_run_, 0, kNewTimeBase - 1), &C::started_);
  }
};

/// Scale factors and biases of a model at the temperature of the last sample. A thermometer repeats itself for many
/// samples on end, and the cubics of all sensors need not be evaluated again for each of them.
class CoefficientsAt {
 public:
  /// To be called where the model changes.
  void forget() noexcept { temperature_degc_ = std::numeric_limits<double>::quiet_NaN(); }
  /// Makes them those at `temperature_degc`.
  void take(const SensorModel& model, double temperature_degc) noexcept;
  /// Whether they are what the model says at the temperature that they were taken for.
  bool hold(const SensorModel& model) const noexcept;
  /// Its reciprocal in a build in single precision; 0 where the scale is 0.
  double scale(std::size_t a) const noexcept { return scale_[a]; }
  double bias_mps2(std::size_t a) const noexcept { return bias_mps2_[a]; }

 private:
  double temperature_degc_ = std::numeric_limits<double>::quiet_NaN();  ///< NaN: equal to none
  std::array<double, kCapacity> scale_{}, bias_mps2_{};

  friend struct FieldsOf;
  static constexpr auto fields() noexcept {
    using C = CoefficientsAt;
    return field_list(any(&C::temperature_degc_), any(&C::scale_), any(&C::bias_mps2_));
  }
};

/// Reading `v` of channel i: clamped; taken out of `gate.usable` where it is not finite.
void keep_reading(int i, double v, Readings& y, GateResult& gate) noexcept;

/// Readings of the usable channels [m/s^2] by a model in the common-frame form, clamped; a channel whose reading is not
/// finite is taken out of `gate.usable`. `temperature_degc` stands in where the sample has none. `kept` is that of this
/// model from the sample before.
Readings readings_of(const SensorModel& model, CoefficientsAt& kept, const Sample& sample, double temperature_degc,
                     GateResult& gate) noexcept;
/// The same with nothing kept.
Readings readings_of(const SensorModel& model, const Sample& sample, double temperature_degc,
                     GateResult& gate) noexcept;

/// Channels that are silent in window after window of rows without ever being lost for long enough in a row.
class SilenceCounter {
 public:
  void clear() noexcept { *this = SilenceCounter{}; }
  /// Takes note of one row of n channels, whether it enters a block or not.
  void add(SensorSet usable, int n) noexcept {
    if (rows_ < kWindowCapacity) ++rows_;
    if (usable.contains(SensorSet::first(n))) return;
    for (std::size_t a = 0; a < static_cast<std::size_t>(n); ++a) {
      if (!usable.has(static_cast<int>(a)) && missed_[a] < kWindowCapacity) ++missed_[a];
    }
  }
  bool is_due(int window) const noexcept { return rows_ >= window; }
  /// Ends a window: `note` of the channels that were usable in at least half of its rows.
  SensorSet close(int n, int confirm) noexcept;
  /// Takes note of one block; returns those of the first n channels that were not usable in `confirm` blocks in a row,
  /// and none where that is all of them (a gap of the bus).
  SensorSet note(SensorSet usable, int n, int confirm) noexcept;

 private:
  std::array<std::uint16_t, kCapacity> run_{};
  std::array<std::uint16_t, kCapacity> missed_{};
  std::uint16_t rows_ = 0;

  friend struct FieldsOf;
  static constexpr auto changing() noexcept { return field_list(&SilenceCounter::missed_, &SilenceCounter::rows_); }
  static constexpr auto fields() noexcept {
    using S = SilenceCounter;
    return field_list(per_sensor(&S::run_), per_sensor(&S::missed_), &S::rows_);
  }
};

/// From a sample to its readings.
struct Intake {
  /// While the tool turns by more than this, and no lever arm tells what the sensors feel of it, evidence rests.
  static constexpr double kStillRate_radps = 0.02;  ///< 0.04 mm/s^2 at 0.1 m
  /// Output beyond the calibrated span by more than this is unconfirmed.
  static constexpr double kTemperatureMargin_degc = 5.0;

  ChannelMonitor gate;
  SilenceCounter silence;
  CoefficientsAt coefficients;  ///< of the model in force
  SampleClock clock;
  Rotation rotation;               ///< as the host said
  double temperature_degc = 25.0;  ///< last finite one
  Flag temperature_out;            ///< in the block at hand
  Flag rotation_locked;            ///< the tool turned in the block at hand

  /// As before the first sample, but for the gate.
  void power_on() noexcept {
    silence.clear();
    coefficients.forget();
    clock.clear();
    rotation = Rotation{};
    temperature_degc = 25.0;
    temperature_out = rotation_locked = false;
  }
  /// Readings of one sample. With a rate and lever arms that are known, what the sensors feel of the turning is off.
  Readings read(const InForce& in_force, const Settings& settings, const Sample& sample, GateResult& gate) noexcept;
  /// Temperature and rotation of the block to which the sample belongs. True where the temperature is outside the
  /// calibrated span and its margin.
  bool note_conditions(const InForce& in_force, const Settings& settings, const Sample& sample,
                       bool begins_block) noexcept {
    if (rotation.turning && !models_rotation(settings)) {
      const bool still = rotation.rate_known && norm(rotation.rate_radps) <= kStillRate_radps;
      rotation_locked = rotation_locked || !still;
    }
    const double t = sample.temperature_degc;
    const bool outside = !(t >= in_force.temperature_min_degc - kTemperatureMargin_degc &&
                           t <= in_force.temperature_max_degc + kTemperatureMargin_degc);
    temperature_out = begins_block ? outside : temperature_out || outside;  // one hot sample taints its block
    if (std::isfinite(t)) temperature_degc = t;
    return outside;
  }

 private:
  bool models_rotation(const Settings& settings) const noexcept {
    return rotation.rate_known && settings.lever_arms_known;
  }

  friend struct FieldsOf;
  static constexpr auto core() noexcept { return field_list(&Intake::rotation, &Intake::gate); }
  static constexpr auto changing() noexcept {
    using I = Intake;
    return field_list(&I::coefficients, &I::clock, &I::temperature_degc, &I::temperature_out, &I::rotation_locked);
  }
  static constexpr auto fields() noexcept {
    using I = Intake;
    return field_list(&I::gate, &I::silence, not_stored(&I::coefficients), &I::clock, &I::rotation,
                      &I::temperature_degc, &I::temperature_out, &I::rotation_locked);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
