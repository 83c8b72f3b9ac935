#include "three_gyros.hpp"

#include <cmath>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>

#include "force_check.hpp"
#include "plumb/core/units.hpp"

namespace plumb_bench {
namespace {

using namespace plumb;
using scenario::FlightSample;

constexpr std::size_t kTriads = 3;
/// Bounds of a triad as `stated_setup` has them for one gyro; true errors are drawn within them.
constexpr double kScale = 0.01, kAxis_rad = 0.01, kLag_s = 20e-6;
/// White noise is beyond this many sigmas in one of some 1e9 samples.
constexpr double kNoiseSigmas = 6.0;
double bias_radps() { return rad_from_deg(0.35); }
double noise_radps() { return rad_from_deg(0.1); }

/// What a component of a healthy triad is off by at most.
double component_bound(double rate_radps) {
  return (kScale + std::sqrt(2.0) * kAxis_rad) * rate_radps + bias_radps() + kNoiseSigmas * noise_radps();
}

class Triads {
 public:
  Triads(const ThreeGyroCase& one, std::uint64_t seed) : one_(one), random_(seed), faulty_(seed % kTriads) {
    for (std::size_t g = 0; g < kTriads; ++g) {
      for (std::size_t c = 0; c < 9; ++c) matrix_[g][c] = (c % 4 == 0 ? kScale : kAxis_rad) * uniform();
      for (double& b : bias_[g]) b = bias_radps() * uniform();
      lag_s_[g] = kLag_s * uniform();
    }
  }

  TriadRates at(const FlightSample& truth) {
    past_.push_back(truth.true_rate_radps);
    if (past_.size() > kLateSamples + 1) past_.pop_front();
    TriadRates out;
    out.triads = static_cast<int>(kTriads);
    for (std::size_t g = 0; g < kTriads; ++g) {
      out.given[g] = true;
      const Vec3 w = plus(truth.true_rate_radps, scaled(truth.true_angular_acceleration_radps2, lag_s_[g]));
      for (std::size_t c = 0; c < 3; ++c) {
        double y = w[c] + bias_[g][c] + noise_radps() * normal_(random_);
        for (std::size_t k = 0; k < 3; ++k) y += matrix_[g][3 * c + k] * w[k];
        out.rate_radps[g][c] = y;
      }
    }
    if (truth.time_s >= one_.onset_s) distort(truth.time_s - one_.onset_s, out.rate_radps[faulty_]);
    held_ = truth.time_s < one_.onset_s ? out.rate_radps[faulty_] : held_;
    return out;
  }
  std::size_t faulty() const { return faulty_; }

 private:
  static constexpr std::size_t kLateSamples = 20;
  double uniform() { return 2.0 * std::uniform_real_distribution<double>()(random_) - 1.0; }

  void distort(double since_s, Vec3& w) {
    switch (one_.play) {
      case GyroPlay::healthy: return;
      case GyroPlay::dead: w = {}; return;
      case GyroPlay::stuck: w = held_; return;
      case GyroPlay::scale: w = scaled(w, 2.0); return;
      case GyroPlay::bias: w[0] += rad_from_deg(20.0); return;
      case GyroPlay::drift: w[1] += rad_from_deg(5.0) * since_s; return;
      case GyroPlay::oscillation: w[2] += 2.0 * std::sin(2.0 * kPi * 30.0 * since_s); return;
      case GyroPlay::noise:
        for (double& x : w) x += 1.0 * normal_(random_);
        return;
      case GyroPlay::late: w = past_.front(); return;
      case GyroPlay::saturated:
        for (double& x : w) x = x > 0.5 ? 0.5 : x < -0.5 ? -0.5 : x;
        return;
    }
  }

  ThreeGyroCase one_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::size_t faulty_;
  std::array<std::array<double, 9>, kTriads> matrix_{};
  std::array<Vec3, kTriads> bias_{};
  std::array<double, kTriads> lag_s_{};
  std::deque<Vec3> past_;
  Vec3 held_{};
};

/// Three parallel triads, each a chip.
SensorArray gyro_axes() {
  std::array<SensorRow, kCapacity> rows{};
  for (std::size_t i = 0; i < 3 * kTriads; ++i) {
    Vec3 axis{};
    axis[i % 3] = 1.0;
    rows[i] = {make_id(("g" + std::to_string(i + 1)).c_str()), axis, noise_radps(),
               static_cast<std::uint8_t>(1 + i / 3)};
  }
  return *SensorArray::make(rows.data(), static_cast<int>(3 * kTriads));
}

RateSetup gyro_setup(double rate_bound_radps) {
  RateSetup out;
  out.errors.fill({kScale, std::sqrt(2.0) * kAxis_rad, bias_radps(), kLag_s, 0.0});
  out.rate_bound_radps = 2.0 * rate_bound_radps;
  return out;
}

RateSample rate_sample(const TriadRates& rates, double time_s) {
  RateSample out;
  out.time_s = time_s;
  out.delivered = SensorSet::first(static_cast<int>(3 * kTriads));
  for (std::size_t i = 0; i < 3 * kTriads; ++i) out.rate_radps[i] = rates.rate_radps[i / 3][i % 3];
  return out;
}

/// The median is the only gyro, corroborated; all that it may be off by enters as what interpolation would add.
MotionSetup force_setup(const ThreeGyroCase& one, MotionSetup setup) {
  for (int i = 0; i < one.flight.sensors; ++i) {
    Vec3& arm = setup.lever_arm_m[static_cast<std::size_t>(i)];
    arm = scaled(arm, one.arm_m / norm(arm));
  }
  setup.gyros = 1;
  setup.gyro_corroborated = true;
  setup.gyro = {0.0, 0.0, 0.0, 0.0, kLag_s};
  return setup;
}

}  // namespace

const char* to_string(GyroPlay play) noexcept {
  constexpr std::array<const char*, kGyroPlays> kNames = {"healthy",
                                                          "dead",
                                                          "stuck",
                                                          "scale 2",
                                                          "bias 20 deg/s",
                                                          "drift 5 deg/s a second",
                                                          "2 rad/s at 30 Hz",
                                                          "noise 1 rad/s",
                                                          "20 ms late",
                                                          "saturated at 0.5 rad/s"};
  return kNames[static_cast<std::size_t>(play)];
}

ThreeGyroOutcome fly_three_gyros(const ThreeGyroCase& one) {
  ThreeGyroOutcome out;
  const FlightBrief brief = brief_of(one.flight);
  const MotionSetup setup = force_setup(one, brief.setup);
  const auto accelerometers = std::make_unique<MotionMonitor>();
  const auto gyros = std::make_unique<RateMonitor>();
  const bool ready = accelerometers->configure(brief.array, setup).has_value() &&
                     gyros->configure(gyro_axes(), gyro_setup(setup.rate_bound_radps)).has_value();
  if (!ready) throw std::runtime_error("a monitor of the flight refuses its setup");
  Triads triads(one, one.flight.seed);
  const SensorSet faulty =
      one.play == GyroPlay::healthy ? SensorSet() : SensorSet(7U << static_cast<unsigned>(3 * triads.faulty()));
  TrueForce past_force, past_rate;
  FlightCase flown = one.flight;
  flown.arm_m = one.arm_m;
  feed(flown, [&](const FlightSample& truth, const MotionSample& read) {
    const TriadRates rates = triads.at(truth);
    const MedianRate median = median_rate(rates, 1);
    const double bound = component_bound(norm(truth.true_rate_radps));
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = std::fabs(median.rate_radps[c] - truth.true_rate_radps[c]);
      out.worst_median_share = std::fmax(out.worst_median_share, error / bound);
    }
    MotionSample sample = read;
    sample.rate_given = {median.given, false};
    sample.rate_radps[0] = median.rate_radps;
    const GyroErrors triad = {kScale, kAxis_rad, bias_radps(), noise_radps(), 0.0};
    sample.interpolation_radps[0] = median_error_radps(triad, norm(median.rate_radps), kNoiseSigmas);
    past_force.add(truth.specific_force_mps2);
    past_rate.add(truth.true_rate_radps);
    const MotionVerdict& v = accelerometers->step(sample);
    score(brief, truth.time_s, {v.alarm, v.isolated, v.excluded}, &out.accelerometers);
    if (v.block_ended && v.block.validity == ForceValidity::bounded)
      check_bound(v.block, past_force.mean(kForceBlock), &out.accelerometers.block);
    const RateVerdict& g = gyros->step(rate_sample(rates, truth.time_s));
    const bool failed = truth.time_s >= one.onset_s;
    if (!(g.isolated | g.excluded).empty() && failed && out.gyro_isolated_s < 0.0)
      out.gyro_isolated_s = truth.time_s - one.onset_s;
    out.gyro_wrongly_isolated =
        out.gyro_wrongly_isolated || !(failed ? faulty : SensorSet()).contains(g.isolated | g.excluded);
    if (past_rate.count() > 2 && g.sample.validity == ForceValidity::bounded) {
      ++out.rate_checks;
      const double error = norm(minus(g.sample.rate_radps, past_rate.mean(1)));
      out.rate_violations += error > g.sample.bound_radps ? 1U : 0U;
    }
  });
  return out;
}

}  // namespace plumb_bench
