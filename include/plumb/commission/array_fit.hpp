/// Commissioning of one array from a log in motion, by least squares on the parity of block pairs: lever arms, lags and
/// rectification of calibrated accelerometers on one clock, any axes, with a gyro. What the calibration and the gyro
/// may be off by is fitted beside them, within what is known of it.
#pragma once

#include <string>
#include <vector>

#include "plumb/commission/motion_log.hpp"
#include "plumb/motion/motion_setup.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace commission {

/// Sigmas that a bound stands for, and that a bound is made of; fixed before any recording was judged.
inline constexpr double kBoundSigmas = 3.0;

/// What an array is known to be before it moves.
struct ArrayOnBoard {
  SensorArray array;
  /// Period, gyros, chips (which share an arm), stated arms, bounds of scale, axis and bias of each sensor; of the gyro
  /// what is known, or a wide guess. Its bounds of arm, lag and rectification are not looked at.
  MotionSetup setup;
  /// What the user states of each sensor, and what counts where the motion shows less; a negative one is not stated.
  std::array<double, kCapacity> lever_bound_m{}, lag_bound_s{}, rectification_bound{};
};

/// Beside the array's own: what nothing is known of, 1 sigma; and where a figure that no bound is stated of counts as
/// open.
struct ArrayFitSettings {
  int scale = 2;                ///< index of kMotionSamples: blocks of 32 samples
  double arm_m = 0.1;           ///< of each component of a lever arm about the stated one
  double within_chip_m = 5e-4;  ///< of each component, from sensor to sensor of one chip
  double lag_s = 0.001;         ///< of each sensor against the mean of all
  double rectification = 1e-3;
  double most_arm_m = 0.01;  ///< three sigma beyond which an arm is not known
  double most_lag_s = 0.001;
  double most_rectification = 1e-4;
};

/// One estimate, with its standard deviation, which covers what is open by the stated bound.
struct Estimate {
  double value = 0.0;
  double sigma = 0.0;
  bool open = false;  ///< the motion shows less than was stated, or nothing
};

struct ArrayFit {
  std::vector<std::array<Estimate, 3>> arm_m;  ///< by sensor: the correction of the stated one; their mean is zero
  bool stated_arms_hold = true;                ///< else their stated bounds count nowhere
  std::vector<Estimate> lag_s;                 ///< by sensor; their mean is zero
  std::vector<Estimate> rectification;
  std::vector<Estimate> scale, axis_rad, bias_mps2;  ///< what the calibration is off by; axis: the size of the turn
  std::array<Estimate, 9> gyro{};                    ///< true rate = (1 + this) (rate - bias), by rows
  std::array<Estimate, 3> gyro_bias_radps{};
  Estimate gyro_lag_s;                      ///< against the mean of the sensors
  std::vector<double> unknown;              ///< all of them, as `residual_of` takes them
  int parameters = 0, rank = 0, gauge = 0;  ///< of arms, lags and rectification; rank: of them those not open
  int block_pairs = 0;
  double residual_mps2 = 0.0;         ///< rms of a parity residual of the block pairs
  double residual_before_mps2 = 0.0;  ///< the same with nothing fitted
};

/// Block pairs of a stretch of samples: what the fit needs of them.
class ArrayPairs {
 public:
  ArrayPairs(const ArrayOnBoard& on_board, const std::vector<MotionSample>& samples, std::size_t first, std::size_t end,
             int scale);
  struct Pair;
  const std::vector<Pair>& all() const noexcept { return pairs_; }
  int size() const noexcept;
  int incomplete() const noexcept { return incomplete_; }  ///< left out: a sensor clipped or missing, or no rate
  ArrayPairs(ArrayPairs&&) noexcept;
  ~ArrayPairs();

 private:
  std::vector<Pair> pairs_;
  int incomplete_ = 0;
};

/// Block pairs that a fit takes at least.
int pairs_needed(const ArrayOnBoard& on_board);

/// Least squares. Only too few pairs are refused; what is open is marked, and who uses the fit judges that.
CommissionExpected<ArrayFit> fit_array(const ArrayOnBoard& on_board, const ArrayPairs& pairs,
                                       const ArrayFitSettings& settings = {});

/// The same with other pairs: rms of a parity residual.
double residual_of(const ArrayOnBoard& on_board, const ArrayPairs& pairs, const ArrayFit& fit);

}  // namespace commission
}  // namespace PLUMB_ABI
}  // namespace plumb
