#include "plumb/motion/motion_quantile.hpp"

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

double motion_noise_quantile(const MotionSetup& setup, int sets) noexcept {
  double tests_per_hour = 0.0;
  for (const int samples : setup.block_samples)
    tests_per_hour += (2.0 * sets + 1.0) * 3600.0 / (samples * setup.sample_period_s);
  return normal_tail_quantile(0.5 * setup.false_alarms_per_hour / (tests_per_hour > 1.0 ? tests_per_hour : 1.0));
}

}  // namespace PLUMB_ABI
}  // namespace plumb
