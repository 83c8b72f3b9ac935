/// What many blocks together have shown: of the noise, of slow motion, of gravity, of the calibration, of drift.
#pragma once

#include "plumb/health/calibration_check.hpp"
#include "plumb/health/detail/gravity_finding.hpp"
#include "plumb/health/detail/noise_study.hpp"
#include "plumb/health/detail/slow_motion.hpp"
#include "plumb/health/detail/temperature_rate.hpp"
#include "plumb/health/detail/trend.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

struct Studies {
  NoiseStudy noise;
  SlowMotion slow_motion;
  GravityFinding gravity;
  CalibrationCheck check;
  Trend trend;
  TemperatureRate temperature_rate;

  void clear() noexcept { *this = Studies{}; }

  static constexpr auto fields() noexcept {
    using S = Studies;
    return field_list(&S::noise, &S::slow_motion, &S::gravity, &S::check, &S::trend, &S::temperature_rate);
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
