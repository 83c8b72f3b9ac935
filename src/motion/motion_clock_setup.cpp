#include <cmath>

#include "clock_limits.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

constexpr int kWaitIndex = 198, kClocksIndex = 199, kFirstClockIndex = 200, kGyroIndex = 150;
constexpr double kLeastWait = 5.0, kMostWait = 40.0;  // sample periods of a chip
/// What four weights may add up to without their signs, where steps differ by up to a tenth: 1.336 where two of 0.9
/// enclose one of 1.1 in whose middle the instant lies.
constexpr double kWeights = 1.34;
constexpr double kLongestStep = 1.1;  // sample periods

Expected<void> in_range(double value, double least, double most, int index) noexcept {
  if (!std::isfinite(value)) return fail(Errc::not_finite, index, value);
  if (value < least) return fail(Errc::out_of_range, index, value, least);
  if (value > most) return fail(Errc::out_of_range, index, value, most);
  return {};
}

double lag_of(const MotionClock& clock) noexcept { return clock.offset_bound_s + clock.rate_bound * clock.valid_s; }

/// By which noise of a mean of interpolated samples may pass that of as many samples: a mean with weights w of what the
/// matrix C makes of the samples has the variance |C' w|^2, at most |w|^2 times the largest sum of |C| along a row and
/// the largest along a column (T14).
double noise_factor(const MotionClock& clock, double period_s) noexcept {
  const double shared = kLongestStep * clock.sample_period_s / period_s;  // instants that a sample has a part in
  return kWeights * std::sqrt(shared > 1.0 ? shared + 0.25 / shared : 1.0);
}

/// One clock to every sensor and gyro.
Expected<void> each_has_one(const SensorArray& array, const MotionSetup& setup, const ClockSetup& clocks) noexcept {
  for (int i = 0; i < array.size(); ++i) {
    int count = 0;
    for (int c = 0; c < clocks.clocks; ++c) count += clocks.clock[static_cast<std::size_t>(c)].sensors.has(i) ? 1 : 0;
    if (count != 1) return fail(Errc::out_of_range, i, count, 1.0);
  }
  for (int g = 0; g < setup.gyros; ++g) {
    int count = 0;
    for (int c = 0; c < clocks.clocks; ++c)
      count += clocks.clock[static_cast<std::size_t>(c)].gyro[static_cast<std::size_t>(g)] ? 1 : 0;
    if (count != 1) return fail(Errc::out_of_range, kGyroIndex + g, count, 1.0);
  }
  return {};
}

}  // namespace

Expected<void> check_clock(const MotionClock& clock, int number, double period_s) noexcept {
  struct Field {
    double value, least, most;
  };
  const std::array<Field, 8> fields{{{clock.sample_period_s, 1e-5, 1.0},
                                     {clock.offset_s, -kMostTime_s, kMostTime_s},
                                     {clock.rate, -0.05, 0.05},
                                     {clock.since_s, -kMostTime_s, kMostTime_s},
                                     {clock.valid_s, 0.0, kMostTime_s},
                                     {clock.offset_bound_s, 0.0, 1.0},
                                     {clock.rate_bound, 0.0, 0.05},
                                     {lag_of(clock), 0.0, period_s}}};
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const int index = kFirstClockIndex + 10 * number + static_cast<int>(k);
    if (const Expected<void> sound = in_range(fields[k].value, fields[k].least, fields[k].most, index); !sound)
      return sound;
  }
  return {};
}

Expected<void> check(const SensorArray& array, const MotionSetup& setup, const ClockSetup& clocks) noexcept {
  if (const Expected<void> sound = in_range(clocks.clocks, 1.0, kMotionClocks, kClocksIndex); !sound) return sound;
  for (int c = 0; c < clocks.clocks; ++c) {
    const MotionClock& one = clocks.clock[static_cast<std::size_t>(c)];
    if (const Expected<void> sound = check_clock(one, c, setup.sample_period_s); !sound) return sound;
    const double period_s = one.sample_period_s;
    if (const Expected<void> sound = in_range(clocks.wait_s, kLeastWait * period_s, kMostWait * period_s, kWaitIndex);
        !sound)
      return sound;
  }
  return each_has_one(array, setup, clocks);
}

Expected<void> with_clocks(const ClockSetup& clocks, SensorArray& array, MotionSetup& setup) noexcept {
  if (const Expected<void> sound = check(array, setup); !sound) return sound;
  if (const Expected<void> sound = check(array, setup, clocks); !sound) return sound;
  MotionSetup grown = setup;
  std::array<SensorRow, kCapacity> rows{};
  for (int i = 0; i < array.size(); ++i) rows[static_cast<std::size_t>(i)] = array.row(i);
  double gyro_lag_s = 0.0, gyro_noise = 1.0;
  for (int c = 0; c < clocks.clocks; ++c) {
    const MotionClock& one = clocks.clock[static_cast<std::size_t>(c)];
    const double lag_s = lag_of(one), noise = noise_factor(one, setup.sample_period_s);
    for (int i = 0; i < array.size(); ++i) {
      if (!one.sensors.has(i)) continue;
      grown.errors[static_cast<std::size_t>(i)].lag_s += lag_s;
      rows[static_cast<std::size_t>(i)].sigma_mps2 *= noise;
    }
    for (int g = 0; g < setup.gyros; ++g) {
      if (!one.gyro[static_cast<std::size_t>(g)]) continue;
      gyro_lag_s = std::fmax(gyro_lag_s, lag_s);
      gyro_noise = std::fmax(gyro_noise, noise);
    }
  }
  grown.gyro.lag_s += gyro_lag_s;
  grown.gyro.noise_radps *= gyro_noise;
  if (const Expected<void> sound = check(array, grown); !sound) return sound;
  if (const Expected<void> sound = array.set_rows(rows.data()); !sound) return sound;
  setup = grown;
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
