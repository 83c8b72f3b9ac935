// Written from reading these files of PX4/PX4-Autopilot, of these commits:
//   src/modules/sensors/data_validator/DataValidator.cpp       25ed6b67fb1174d88b4834076ec812c3fabd139d
//   src/modules/sensors/data_validator/DataValidatorGroup.cpp  0f41d4f690712b3c98ffb12b7dfb9e877f87cd69
//   src/modules/sensors/data_validator/DataValidator.hpp       033e9cee3625392e07633088a3ebeb245a9f1dd4
#include "px4_voter.hpp"

#include <cmath>

namespace plumb_bench {
namespace {

constexpr float kSlow = 0.01F, kSame = 1e-6F, kDensityWindow = 100.0F, kRegular = 0.9F;
constexpr std::uint64_t kTimeout_us = 40000;
constexpr std::uint32_t kMostRepeats = 100, kMostErrors = 10000;

}  // namespace

void Px4Unit::take(std::uint64_t time_us, const Px4Reading& reading) noexcept {
  ++taken_;
  if (reading.driver_errors > driver_errors_) {
    error_density_ += static_cast<float>(reading.driver_errors - driver_errors_);
  } else if (error_density_ > 0.0F) {
    error_density_ -= 1.0F;
  }
  driver_errors_ = reading.driver_errors;
  for (std::size_t k = 0; k < axis_.size(); ++k) {
    const float value = reading.axis[k];
    if (!std::isfinite(value)) continue;
    Axis& axis = axis_[k];
    if (time_us_ == 0) {
      axis = {};
      axis.slow = value;
    } else {
      const float fast = value - axis.slow, off = fast - axis.mean;
      axis.mean += off / static_cast<float>(taken_);
      axis.square += off * (fast - axis.mean);
      axis.scatter = std::sqrt(axis.square / static_cast<float>(taken_ - 1));
      repeats_ = std::fabs(axis.last - value) < kSame ? repeats_ + 1 : 0;
    }
    axis.slow = (1.0F - kSlow) * axis.slow + kSlow * value;
    axis.last = value;
  }
  time_us_ = time_us;
}

float Px4Unit::trust(std::uint64_t now_us) noexcept {
  if (time_us_ == 0 || now_us > time_us_ + kTimeout_us || repeats_ > kMostRepeats || driver_errors_ > kMostErrors)
    return 0.0F;
  error_density_ = std::fmin(error_density_, kDensityWindow);
  return 1.0F - error_density_ / kDensityWindow;
}

int Px4Units::step(std::uint64_t time_us, const Px4Reading* readings) noexcept {
  for (std::size_t u = 0; u < unit_.size(); ++u) unit_[u].take(time_us, readings[u]);
  int best = used_;
  float most = used_ < 0 ? -1.0F : unit_[static_cast<std::size_t>(used_)].trust(time_us);
  for (std::size_t u = 0; u < unit_.size(); ++u) {
    const float trust = unit_[u].trust(time_us);
    if (!(trust > 0.0F) || !(trust > most || (most < kRegular && trust >= kRegular))) continue;
    best = static_cast<int>(u);
    most = trust;
  }
  used_ = best;
  return best;
}

}  // namespace plumb_bench
