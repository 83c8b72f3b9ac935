/// What one block of samples at rest says about one set of sensors: can a single acceleration of
/// gravity's length still explain their readings? Parity residual and norm residual with limits that
/// carry both noise and what is systematic (docs/theory.md, section 3.2).
#pragma once

#include <array>
#include <cmath>

#include "plumb/array/geometry.hpp"
#include "plumb/core/config.hpp"
#include "plumb/gravity/gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Readings beyond this are held at it: large enough that nothing believes them, small enough that no square or sum of
/// them overflows.
inline constexpr double kReadingClamp_mps2 = 1e5;
/// A tolerance beyond ten times gravity says no more than one of that size: the vector points anywhere.
inline constexpr float kMostTolerance_mps2 = 100.0F;

/// The evidence of a block: means of the readings and what their noise may be.
struct BlockEvidence {
  Readings mean_mps2{};
  SensorSet usable;             ///< channels that delivered in at least half of the samples
  double samples = 0.0;         ///< N behind the mean
  double spread_mps2_sq = 0.0;  ///< v: variance of the vector inside the block beyond noise [(m/s^2)^2]
  double motion_mps2 = 0.0;     ///< how far the length of what all sensors felt may be from gravity's: the tool shakes
  /// tau_i: largest error of the mean of sensor i beside noise and calibration, of either sign and whatever the others
  /// err by: drift since the calibration. It enters every limit and the protection level as a bound, not as a variance.
  std::array<float, kCapacity> tolerance_mps2{};

  bool plausible() const noexcept {
    for (const double mean : mean_mps2) {
      if (!(std::fabs(mean) <= 2.0 * kReadingClamp_mps2)) return false;  // twice: for the rounding of a mean
    }
    for (const float tolerance : tolerance_mps2) {
      if (!(tolerance >= 0.0F && tolerance <= kMostTolerance_mps2)) return false;
    }
    return samples >= 0.0 && spread_mps2_sq >= 0.0 && motion_mps2 >= 0.0;
  }
  static constexpr auto fields() noexcept {
    using E = BlockEvidence;
    return field_list(per_sensor(&E::mean_mps2), &E::usable, &E::samples, &E::spread_mps2_sq, &E::motion_mps2,
                      per_sensor(&E::tolerance_mps2));
  }
};

/// Quantiles in standard deviations, precomputed from the rates of the configuration.
struct TestLimits {
  std::array<double, kCapacity - 1> reject{};        ///< [nu]: sqrt of chi^2_nu quantile at the rejection rate
  std::array<double, kCapacity - 2> parity_alarm{};  ///< [nu]: the same at the false-alarm rate, of parity rows alone
  double norm_alarm = 0.0;                           ///< one degree of freedom, false-alarm rate
  /// What 99 of 100 calibrations stay below at every attitude, in standard deviations of what they leave
  /// (docs/theory.md, section 3.3). Of parity and norm together; of parity alone and of one norm alone, both at the
  /// same time.
  double calibration = 0.0, parity_calibration = 0.0, norm_calibration = 0.0;
  static constexpr double gravity = 3.0;  ///< sigmas of a gravity reference, where it calibrated and where it is used
  /// A: largest steady acceleration that the host allows for. What the sensors feel is then |g + a|, off G by at most
  /// A.
  double acceleration_mps2 = 0.0;

  static constexpr auto fields() noexcept {
    using L = TestLimits;
    return field_list(&L::reject, &L::parity_alarm, &L::norm_alarm, &L::calibration, &L::parity_calibration,
                      &L::norm_calibration, &L::acceleration_mps2);
  }

  /// Valid whatever a calibration leaves in n rows.
  static TestLimits from_rates(int n, double false_alarm_rate, double rejection_rate,
                               double acceleration_mps2 = 0.0) noexcept;
  /// Those of this array: parity is held tighter where its calibration left all parity rows alike.
  TestLimits of(const SensorArray& array) const noexcept;
};

/// All statistics and limits are in standard deviations of the block mean (whitened, times sqrt(N)).
struct SetTest {
  bool tested = false;   ///< rank 3 and all members usable
  Vec3 x_mps2{};         ///< weighted least squares over the set
  Mat3 covariance{};     ///< of x, noise of the block mean [(m/s^2)^2]
  double samples = 0.0;  ///< N behind it
  double parity = 0.0;   ///< |parity residual|, |S|-3 degrees of freedom
  double norm = 0.0;     ///< (|x| - G), signed, in its own sigma
  double norm_error_mps2 = 0.0;
  double norm_sigma_mps2 = 0.0;    ///< s_T: 1 sigma of |x| for one sample
  double parity_systematic = 0.0;  ///< b_S of the parity rows alone
  double norm_systematic = 0.0;    ///< b_S of the norm row alone
  double systematic = 0.0;         ///< b_S of all rows together
  double least_leverage = 0.0;     ///< min over members of the parity projector's diagonal: 0 = an unchecked member
  int parity_rows = 0;

  double combined() const noexcept;  ///< sqrt(parity^2 + norm^2)
  double reject_limit(const TestLimits& limits) const noexcept;
  double parity_reject_limit(const TestLimits& limits) const noexcept;
  double parity_alarm_limit(const TestLimits& limits) const noexcept;
  double norm_alarm_limit(const TestLimits& limits) const noexcept;
  double norm_reject_limit(const TestLimits& limits) const noexcept;

  /// A set that was not tested is consistent (docs/theory.md, section 5.2). Comparisons are written so that a NaN,
  /// which cannot arise from finite readings, would leave the set consistent and raise the alarm.
  bool consistent(const TestLimits& limits) const noexcept { return !tested || !(combined() > reject_limit(limits)); }
  bool parity_consistent(const TestLimits& limits) const noexcept {
    return !tested || parity_rows == 0 || !(parity > parity_reject_limit(limits));
  }
};

/// sqrt(N) misfit / sigma of the sensor of a set whose misfit is the largest: in standard deviations of the noise of a
/// block mean. 0 where no misfit is known, not a number where one is none.
double largest_misfit(const SensorArray& array, const RowUncertainty& uncertainty, SensorSet set,
                      double samples) noexcept;
/// By how much a limit of one standard deviation grows for it. A misfit is drawn anew at every attitude and is a part
/// of the noise there: sqrt(1 + misfit^2) - 1 (docs/theory.md, section 3.3).
inline double noise_growth(double misfit) noexcept { return std::sqrt(1.0 + misfit * misfit) - 1.0; }

/// |parity residual| of the readings `y_mps2` of a set, in standard deviations of one sample; 0 where it is not
/// determined: fewer than four, or no rank 3.
double parity_residual(const SensorArray& array, const Readings& y_mps2, SensorSet set) noexcept;

SetTest test_set(const SensorArray& array, const GravityReference& gravity, const TestLimits& limits,
                 const BlockEvidence& block, SensorSet set) noexcept;
/// The same into `out`, which must not have been used. `uncertainty` null: calibration leaves nothing open in the rows,
/// and what would only add up zeros is omitted.
void test_set(const SensorArray& array, const RowUncertainty* uncertainty, const GravityReference& gravity,
              const TestLimits& limits, const BlockEvidence& block, SensorSet set, SetTest& out) noexcept;
/// The same as if calibration had left another uncertainty in the rows.
SetTest test_set(const SensorArray& array, const RowUncertainty& uncertainty, const GravityReference& gravity,
                 const TestLimits& limits, const BlockEvidence& block, SensorSet set) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
