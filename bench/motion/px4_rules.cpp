// Written from reading these files; their words and code are not repeated. Commits are those of the copies read.
//   PX4/PX4-Autopilot
//     src/modules/sensors/voted_sensors_update.cpp           0d3cf7493b8b8a593f7218c0d1dd2502be040918
//     src/modules/sensors/data_validator/DataValidator.cpp   f3cb7d30ef084fb402192c21ea8079bda72a9102
//     src/modules/sensors/data_validator/DataValidator.hpp   033e9cee3625392e07633088a3ebeb245a9f1dd4
//     src/modules/sensors/vehicle_imu/imu_parameters.yaml    d709b0468b4797508eb2a8bf9c5e9be1958375c7
//     src/modules/ekf2/EKF2Selector.cpp                      0835c432e34983339899d690c17b4634d02722a2
//     src/modules/ekf2/params_selector.yaml                  2e09b28957b85b8387890f381e6ee7040ad7d6ef
#include "px4_rules.hpp"

#include <algorithm>
#include <cmath>

namespace plumb_bench {

using namespace plumb;

namespace {

constexpr std::uint32_t bit(std::size_t unit) noexcept { return std::uint32_t{1} << unit; }

}  // namespace

Px4Means::Px4Means(double rate_hz) noexcept
    : period_s_(1.0 / rate_hz), samples_(std::max(1, static_cast<int>(std::lround(kPeriod_s * rate_hz)))) {}

bool Px4Means::add(const UnitVectors& reading) noexcept {
  if (count_ == samples_) {
    mean_ = {};
    count_ = 0;
  }
  if (count_ == 0) mean_.delivered = reading.delivered;
  mean_.count = reading.count;
  mean_.delivered &= reading.delivered;
  for (std::size_t u = 0; u < reading.count; ++u)
    mean_.vector[u] = plus(mean_.vector[u], scaled(reading.vector[u], 1.0 / samples_));
  return ++count_ == samples_;
}

std::uint32_t Px4Selector::step(const UnitVectors& reading, double period_s) noexcept {
  constexpr double kAcceleration_mps2 = 1.0, kVelocity_mps = 2.0;
  Vec3 mean{};
  double units = 0.0;
  for (std::size_t u = 0; u < reading.count; ++u) {
    if ((reading.delivered & bit(u)) == 0) continue;
    mean = plus(mean, reading.vector[u]);
    units += 1.0;
  }
  std::size_t worst = 0;
  for (std::size_t u = 0; u < reading.count; ++u) {
    if ((reading.delivered & bit(u)) != 0) {
      smooth_[u] = plus(scaled(smooth_[u], 0.95), scaled(minus(reading.vector[u], scaled(mean, 1.0 / units)), 0.05));
      excess_mps_[u] = std::max(0.0, excess_mps_[u] + (norm(smooth_[u]) - kAcceleration_mps2) * period_s);
    }
    if (excess_mps_[u] > excess_mps_[worst]) worst = u;
  }
  return excess_mps_[worst] > kVelocity_mps ? bit(worst) : 0;
}

std::uint32_t Px4Voter::step(const UnitVectors& reading, double period_s) noexcept {
  constexpr int kMostRepeats = 100;
  constexpr double kTimeout_s = 0.04;
  std::uint32_t out = 0;
  for (std::size_t u = 0; u < reading.count; ++u) {
    const bool delivers = (reading.delivered & bit(u)) != 0;
    silent_s_[u] = delivers ? 0.0 : silent_s_[u] + period_s;
    for (std::size_t axis = 0; axis < 3 && delivers; ++axis) {
      const bool same = std::fabs(reading.vector[u][axis] - last_[u][axis]) < 1e-6;
      repeats_[u] = same ? repeats_[u] + 1 : 0;
    }
    if (delivers) last_[u] = reading.vector[u];
    if (repeats_[u] > kMostRepeats || silent_s_[u] > kTimeout_s) out |= bit(u);
  }
  return out;
}

}  // namespace plumb_bench
