#include "plumb/motion/motion_setup.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

struct Bound {
  double value;
  double least;
  double most;
};

Expected<void> within_range(const Bound& field, int index) noexcept {
  if (!std::isfinite(field.value)) return fail(Errc::not_finite, index, field.value);
  if (field.value < field.least) return fail(Errc::out_of_range, index, field.value, field.least);
  if (field.value > field.most) return fail(Errc::out_of_range, index, field.value, field.most);
  return {};
}

/// Each is put together from those of the scale before it.
Expected<void> check_blocks(const BlockSamples& blocks) noexcept {
  if (blocks[0] != 1) return fail(Errc::out_of_range, 114, blocks[0], 1);
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    const int index = 114 + static_cast<int>(k), part = blocks[k - 1];
    if (blocks[k] < 2 * part) return fail(Errc::out_of_range, index, blocks[k], 2 * part);
    if (blocks[k] > kLongestBlock) return fail(Errc::out_of_range, index, blocks[k], kLongestBlock);
    if (blocks[k] % part != 0) return fail(Errc::out_of_range, index, blocks[k], blocks[k] - blocks[k] % part);
  }
  return {};
}

}  // namespace

double relative_error(const GyroErrors& bounds) noexcept {
  const double of_truth = bounds.scale + std::sqrt(2.0) * bounds.axis_rad;
  return of_truth / (1.0 - of_truth);
}

Expected<void> check(const SensorArray& array, const MotionSetup& setup) noexcept {
  if (array.size() < 3) return fail(Errc::too_few_sensors, -1, array.size(), 3);
  if (array.size() > kMotionCapacity) return fail(Errc::too_many_sensors, -1, array.size(), kMotionCapacity);
  for (int i = 0; i < array.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const MotionErrors& e = setup.errors[k];
    const Vec3& arm = setup.lever_arm_m[k];
    const std::array<Bound, 9> fields{{{arm[0], -100.0, 100.0},
                                       {arm[1], -100.0, 100.0},
                                       {arm[2], -100.0, 100.0},
                                       {e.lever_m, 0.0, 1.0},
                                       {e.lag_s, 0.0, 1.0},
                                       {e.rectification, 0.0, 1.0},
                                       {e.scale, 0.0, 0.5},
                                       {e.axis_rad, 0.0, 0.5},
                                       {e.bias_mps2, 0.0, 100.0}}};
    for (const Bound& field : fields) {
      if (const Expected<void> sound = within_range(field, i); !sound) return sound;
    }
  }
  if (const Expected<void> sound = check_blocks(setup.block_samples); !sound) return sound;
  const GyroErrors& g = setup.gyro;
  const std::array<Bound, 14> fields{
      {{setup.sample_period_s, 1e-5, 1.0},
       {static_cast<double>(setup.gyros), 0.0, kGyros},
       {g.scale, 0.0, 0.4},
       {g.axis_rad, 0.0, 0.4},
       {g.bias_radps, 0.0, 10.0},
       {g.noise_radps, 0.0, 10.0},
       {g.lag_s, 0.0, 1.0},
       {setup.rate_bound_radps, 0.0, 1000.0},
       {setup.force_bound_mps2, 0.0, 1e5},
       {setup.false_alarms_per_hour, 1e-9, 1.0},
       {setup.dwell_s, 0.0, 10.0},
       {setup.quiet_s, 0.0, 3600.0},
       {static_cast<double>(setup.max_faults), 0.0, kMotionDepth},
       {static_cast<double>(setup.shortest_block), 1.0, static_cast<double>(setup.block_samples[2])}}};
  for (std::size_t k = 0; k < fields.size(); ++k) {
    if (const Expected<void> sound = within_range(fields[k], 100 + static_cast<int>(k)); !sound) return sound;
  }
  return {};
}

}  // namespace PLUMB_ABI
}  // namespace plumb
