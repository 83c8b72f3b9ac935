/// Slow drift below every limit: the slope over time of each sensor's parity residual, over the last few hundred clean
/// blocks. It decides nothing; it tells the host which way a sensor is going before it gets anywhere.
#pragma once

#include <array>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"
#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Regression on time with exponential forgetting, all sums about their means, so that nothing grows.
class Trend {
 public:
  static constexpr double kMemoryBlocks = 256.0;
  /// A slope is reported when it is so many of its own sigmas, the scatter of the residuals taken as found.
  static constexpr double kToldSigmas = 6.0;
  static constexpr int kLeastBlocks = 32;

  void clear() noexcept { *this = Trend{}; }
  /// One passed block: readings of the sensors `used`, and the vector that they gave.
  void add(const SensorArray& array, const BlockEvidence& block, SensorSet used, const Vec3& x_mps2,
           double time_s) noexcept;
  /// Drift of sensor i were it the only one to drift [m/s^2 per hour]; 0 where none is found. `check`: part of its
  /// reading that the others check (diagonal of the parity projector).
  double rate_mps2_per_h(int i, double check) const noexcept;

 private:
  double weight_ = 0.0, time_s_ = 0.0, time_square_ = 0.0;
  std::array<double, kCapacity> mean_{}, product_{}, square_{};

  friend struct FieldsOf;
  bool plausible() const noexcept { return weight_ >= 0.0 && weight_ <= kMemoryBlocks + 1.0; }
  static constexpr auto fields() noexcept {
    using T = Trend;
    return field_list(&T::weight_, any(&T::time_s_), any(&T::time_square_), per_sensor(any(&T::mean_)),
                      per_sensor(any(&T::product_)), per_sensor(any(&T::square_)));
  }
};

}  // namespace PLUMB_ABI
}  // namespace plumb
