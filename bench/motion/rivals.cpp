// Written from reading these files; their words and code are not repeated. Commits are those of the copies read.
//   ArduPilot/ardupilot
//     libraries/AP_Arming/AP_Arming.cpp                      073170d77dc8348ed73f4004e9dbf7a2c93230b6
//     ArduCopter/AP_Arming.cpp                               dd445c3b4e3c4251a10a41c38c814ab19ef1f9b1
//     libraries/AP_InertialSensor/AP_InertialSensor.cpp      5b049ea0bf3108e7da35fbfe73e766d8cfd74a76
//     libraries/AP_NavEKF3/AP_NavEKF3_Outputs.cpp            971f76c0f1a141188e17b6eaedbbc2b7fa4481c6
//     ArduCopter/ekf_check.cpp                               92e0e66054d325b9305f38f91575d55f28d637fd
// PX4's rules stand in px4_rules.cpp. The generalised likelihood test is that of Daly, Gai and Harrison (1979).
#include "rivals.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "plumb/motion/motion_window.hpp"
#include "plumb/numeric/tails.hpp"
#include "px4_rules.hpp"

namespace plumb_bench {

const std::array<const char*, kRules> kRuleNames{
    "plumb, motion monitor",       "PX4, EKF2 selector",  "PX4, sensor voter",       "ArduPilot, accels consistent",
    "median, lever terms removed", "GLT with noise only", "GLT, limit tuned as well"};

namespace {

using namespace plumb;

constexpr std::size_t kUnits = 3;
/// A vector from each unit: its sensors are three in a row, along x, y and z.
using Units = std::array<Vec3, kUnits>;

Units units_of(const Readings& reading) {
  Units out;
  for (std::size_t i = 0; i < 3 * kUnits; ++i) out[i / 3][i % 3] = reading[i];
  return out;
}

SensorSet sensors_of(std::size_t unit) { return SensorSet(7U << (3U * unit)); }

Vec3 mean_of(const Units& all) { return scaled(plus(plus(all[0], all[1]), all[2]), 1.0 / kUnits); }

/// The unit with the largest value, and that value.
struct Largest {
  std::size_t unit = 0;
  double value = 0.0;
};
Largest largest_of(const std::array<double, kUnits>& value) {
  const auto at = std::max_element(value.begin(), value.end());
  return {static_cast<std::size_t>(at - value.begin()), *at};
}

UnitVectors vectors_of(const Units& all) {
  UnitVectors out;
  out.count = kUnits;
  for (std::size_t u = 0; u < kUnits; ++u) out.vector[u] = all[u];
  out.delivered = (1U << kUnits) - 1U;
  return out;
}

/// Units as a mask of bench/motion/px4_rules.hpp.
FlightFinding blamed(std::uint32_t units) {
  FlightFinding out;
  for (std::size_t u = 0; u < kUnits; ++u) {
    if ((units >> u & 1U) != 0) out.isolated = out.isolated | sensors_of(u);
  }
  out.alarm = units != 0;
  return out;
}

/// ArduPilot's check that accelerometers agree, before arming: readings behind the 20 Hz filter of INS_ACCEL_FILTER,
/// each unit against the first, z at half weight, the limit of ARMING_ACCTHRESH, three times that for the third unit.
/// It says that they disagree, not who. ArduPilot itself makes it once a second and never in flight; here the second
/// goes on. Its choice of the unit in use heeds driver errors alone, lanes and vibration failsafe innovations alone.
class ArduPilotCheck {
 public:
  FlightFinding step(const Units& reading, double time_s) {
    if (!started_) older_ = before_ = first_ = second_ = reading;
    started_ = true;
    for (std::size_t u = 0; u < kUnits; ++u) filter(reading[u], u);
    if (time_s < next_look_s_) return found_;
    next_look_s_ += 1.0;
    found_.alarm = false;
    for (std::size_t u = 1; u < kUnits; ++u) {
      const Vec3 off = minus(first_[u], first_[0]);
      const double limit_mps2 = u < 2 ? kLimit_mps2 : 3.0 * kLimit_mps2;
      found_.alarm = found_.alarm || norm({off[0], off[1], 0.5 * off[2]}) > limit_mps2;
    }
    return found_;
  }

 private:
  /// Butterworth of second order through the bilinear transform, at 1 kHz. Its gain at rest is one.
  void filter(const Vec3& reading, std::size_t u) {
    const double w = std::tan(3.14159265358979323846 * 20.0 / 1000.0), d = 1.0 + std::sqrt(2.0) * w + w * w;
    const double gain = w * w / d, a1 = 2.0 * (w * w - 1.0) / d, a2 = (1.0 - std::sqrt(2.0) * w + w * w) / d;
    const Vec3 in = plus(plus(reading, scaled(before_[u], 2.0)), older_[u]);
    const Vec3 out = minus(scaled(in, gain), plus(scaled(first_[u], a1), scaled(second_[u], a2)));
    older_[u] = before_[u];
    before_[u] = reading;
    second_[u] = first_[u];
    first_[u] = out;
  }

  static constexpr double kLimit_mps2 = 0.75;
  bool started_ = false;
  Units before_{}, older_{};  ///< the last two readings
  Units first_{}, second_{};  ///< the last two answers of the filter
  double next_look_s_ = 1.0;
  FlightFinding found_;
};

/// What rotation adds at `r`: (ww' - |w|^2 + [alpha]x) r, of means.
Vec3 lever_term(const GyroMeans& gyro, const Vec3& r) {
  const Symmetric& s = gyro.rate_product;
  const Vec3 turned{s[0] * r[0] + s[3] * r[1] + s[4] * r[2], s[3] * r[0] + s[1] * r[1] + s[5] * r[2],
                    s[4] * r[0] + s[5] * r[1] + s[2] * r[2]};
  return plus(minus(turned, scaled(r, s[0] + s[1] + s[2])), cross(gyro.acceleration_radps2, r));
}

/// How far the units lie apart over two blocks of 32 samples, once both gyros' mean has taken the lever terms out.
/// The means are the monitor's own, so that only the rules differ.
struct Apart {
  Largest from_median;         ///< length of the vector against the median of each axis [m/s^2]
  Largest explained;           ///< squared parity that a fault of that unit alone would explain [(m/s^2)^2]
  double parity_square = 0.0;  ///< of all, six degrees of freedom
  double noise_square = 0.0;   ///< variance of each of those
};

class Blocks {
 public:
  explicit Blocks(const FlightBrief& brief)
      : brief_(brief), window_(brief.array.size(), brief.setup.gyros, brief.setup.sample_period_s) {}

  std::optional<Apart> add(const MotionSample& sample) {
    window_.add(sample);
    if ((window_.ended() >> kScale & 1U) == 0) return std::nullopt;
    const MotionMeans means = window_.means(kScale);
    if (means.samples == 0 || !means.usable.contains(SensorSet::first(3 * kUnits))) return std::nullopt;
    return apart(units_of(level(means)), means.noise_share());
  }

 private:
  Readings level(const MotionMeans& means) const {
    Readings out = means.reading_mps2;
    const double share = 1.0 / brief_.setup.gyros;
    for (std::size_t g = 0; g < static_cast<std::size_t>(brief_.setup.gyros); ++g) {
      for (std::size_t i = 0; i < 3 * kUnits; ++i)
        out[i] -= share * lever_term(means.gyro[g], brief_.setup.lever_arm_m[i])[i % 3];
    }
    return out;
  }

  Apart apart(const Units& unit, double noise_share) const {
    const Vec3 mean = mean_of(unit);
    std::array<double, kUnits> from_median{}, explained{};
    Apart out;
    for (std::size_t u = 0; u < kUnits; ++u) {
      Vec3 off{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double a = unit[0][axis], b = unit[1][axis], c = unit[2][axis];
        off[axis] = unit[u][axis] - std::max(std::min(a, b), std::min(std::max(a, b), c));
      }
      from_median[u] = norm(off);
      const Vec3 residual = minus(unit[u], mean);
      out.parity_square += dot(residual, residual);
      explained[u] = dot(residual, residual) * kUnits / (kUnits - 1.0);
    }
    out.from_median = largest_of(from_median);
    out.explained = largest_of(explained);
    out.noise_square = brief_.array.sigma_mps2(0) * brief_.array.sigma_mps2(0) * noise_share;
    return out;
  }

  static constexpr int kScale = 2;
  static_assert(kMotionSamples[kScale] == 32);
  const FlightBrief& brief_;
  MotionWindow window_;
};

/// All rules but the monitor, and what each said last.
class Rivals {
 public:
  Rivals(const FlightBrief& brief, const TunedLimits& limits)
      : limits_(limits), blocks_(brief), glt_quantile_(quantile(brief.setup)) {}

  const std::array<FlightFinding, kRules - 1>& step(const MotionSample& sample) {
    const Units reading = units_of(sample.reading_mps2);
    auto& [selector, voter, check, median, glt, glt_tuned] = found_;
    if (px4_.add(vectors_of(reading))) {
      selector = blamed(selector_.step(px4_.mean(), px4_.period_s()));
      voter = blamed(voter_.step(px4_.mean(), px4_.period_s()));
    }
    check = check_.step(reading, sample.time_s);
    if (const std::optional<Apart> apart = blocks_.add(sample)) {
      median = finding(apart->from_median.value > limits_.median_mps2, apart->from_median.unit);
      glt = finding(apart->parity_square > glt_quantile_ * apart->noise_square, apart->explained.unit);
      glt_tuned = finding(std::sqrt(apart->parity_square) > limits_.parity_mps2, apart->explained.unit);
    }
    return found_;
  }

 private:
  static FlightFinding finding(bool alarm, std::size_t unit) {
    if (!alarm) return {};
    return {true, sensors_of(unit), {}};
  }
  /// Of six degrees of freedom, at the false alarms that the monitor is allowed too: a test every 32 samples.
  static double quantile(const MotionSetup& setup) {
    const double tests_per_hour = 3600.0 / (32.0 * setup.sample_period_s);
    return chi2_tail_quantile(setup.false_alarms_per_hour / tests_per_hour, 6);
  }

  TunedLimits limits_;
  Px4Means px4_{1000.0};
  Px4Selector selector_;
  Px4Voter voter_;
  ArduPilotCheck check_;
  Blocks blocks_;
  double glt_quantile_;
  std::array<FlightFinding, kRules - 1> found_{};
};

}  // namespace

TunedLimits quiet_limits(const FlightCase& healthy) {
  const FlightBrief brief = brief_of(healthy);
  Blocks blocks(brief);
  TunedLimits out{0.0, 0.0};
  feed(healthy, [&](const scenario::FlightSample&, const MotionSample& sample) {
    const std::optional<Apart> apart = blocks.add(sample);
    if (!apart) return;
    out.median_mps2 = std::max(out.median_mps2, apart->from_median.value);
    out.parity_mps2 = std::max(out.parity_mps2, std::sqrt(apart->parity_square));
  });
  return out;
}

std::array<FlightOutcome, kRules> fly_rivals(const FlightCase& one, const TunedLimits& limits) {
  if (one.array != FlightArray::triads || one.sensors != 3 * static_cast<int>(kUnits) || one.gyros < 1)
    throw std::runtime_error("rivals judge three parallel triads and need a gyro");
  const FlightBrief brief = brief_of(one);
  const auto monitor = std::make_unique<MotionMonitor>();
  if (const auto sound = monitor->configure(brief.array, brief.setup); !sound)
    throw std::runtime_error(describe(sound.error().code));
  Rivals rivals(brief, limits);
  std::array<FlightOutcome, kRules> out;
  feed(one, [&](const scenario::FlightSample& truth, const MotionSample& sample) {
    const MotionVerdict& v = monitor->step(sample);
    score(brief, truth.time_s, {v.alarm, v.isolated, v.excluded}, &out[0]);
    const auto& found = rivals.step(sample);
    for (std::size_t k = 0; k < found.size(); ++k) score(brief, truth.time_s, found[k], &out[k + 1]);
  });
  return out;
}

}  // namespace plumb_bench
