#include "plumb/session/motion_inputs.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {
namespace {

/// As `MotionWindow` takes a step for one period.
constexpr double kLeastStep = 0.5, kMostStep = 1.5;
/// Beyond it a step is a gap, and says nothing about the period: the longest that `plumb::check` takes.
constexpr double kLongestPeriod_s = 1.0;

}  // namespace

void MotionInputsWatch::add(double time_s) noexcept {
  MotionInputs& f = found_;
  ++f.rows;
  const double step_s = time_s - last_s_;
  last_s_ = time_s;
  if (f.rows == 1) return;
  if (!(step_s > 0.0)) {
    if (f.steps_back == 0) f.first_back_s = time_s;
    ++f.steps_back;
    return;
  }
  const bool regular = step_s > kLeastStep * period_s_ && step_s < kMostStep * period_s_;
  if (regular || step_s <= kLongestPeriod_s) {
    Steps& steps = regular ? regular_ : irregular_;
    steps.sum_s += step_s;
    ++steps.count;
  }
  const Steps& most = regular_.count >= irregular_.count ? regular_ : irregular_;
  if (most.count > 0) f.mean_step_s = most.sum_s / static_cast<double>(most.count);
  f.period_is_another = irregular_.count > regular_.count;
  if (regular) {
    f.jitter_s = std::fmax(f.jitter_s, std::fabs(step_s - period_s_));
    return;
  }
  if (f.steps_irregular == 0) f.first_irregular_s = time_s;
  ++f.steps_irregular;
}

void MotionInputsWatch::add_rate(std::size_t gyro, bool given, const Vec3& rate_radps) noexcept {
  RateInputs& f = found_.gyro[gyro];
  double& same_from_s = same_from_s_[gyro];
  if (!given) {
    if (f.missing == 0) f.first_missing_s = last_s_;
    ++f.missing;
    same_from_s = last_s_;
    return;
  }
  const bool same = f.rates > 0 && rate_radps == rate_radps_[gyro];
  if (!same) same_from_s = last_s_;
  ++f.rates;
  rate_radps_[gyro] = rate_radps;
  const double size_radps = norm(rate_radps);
  if (size_radps > f.largest_radps) {
    f.largest_radps = size_radps;
    f.largest_at_s = last_s_;
  }
  if (!same || last_s_ - same_from_s <= f.still_s) return;
  f.still_s = last_s_ - same_from_s;
  f.still_from_s = same_from_s;
  f.still_at_zero = size_radps == 0.0;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
