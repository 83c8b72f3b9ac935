/// The figures of the report that are sums over the stations. Private to the calibration module.
#pragma once

#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

/// The length of gravity sees the parameters through the spherical harmonics of degree 0 to 2 alone.
inline constexpr int kHarmonics = 9;

/// How evenly the directions of gravity are spread, for the report.
class Harmonics {
 public:
  void add(const Vec3& direction) noexcept;
  /// Least eigenvalue of the Gram matrix of the harmonics, uniform sphere = 1; 0 where it could not be had.
  double excitation(int stations) const noexcept;

 private:
  std::array<double, std::size_t{kHarmonics} * kHarmonics> gram_{};  ///< lower triangle
};

class FitTally {
 public:
  /// `harmonics`, where given, sees every direction.
  explicit FitTally(Harmonics* harmonics = nullptr) noexcept : harmonics_(harmonics) {}
  void add(const StationSolver& station, double g_mps2) noexcept;
  void write(int n, FitFigures& report) const noexcept;
  /// 0 where there are no harmonics.
  double excitation() const noexcept { return harmonics_ != nullptr ? harmonics_->excitation(stations_) : 0.0; }
  /// Of a fitted direction, mean over the stations [rad^2].
  double direction_variance() const noexcept { return stations_ > 0 ? direction_variance_ / stations_ : 0.0; }
  /// Degrees of freedom of the stations' own residuals: what roll rows add, and what they determine, is no part of it.
  int freedom(const FitFigures& report) const noexcept {
    return rows_ - 2 * stations_ - (report.rank - (3 - report.gauge));
  }
  /// Sensor whose residuals are most above those of the others, and by what factor (rms); -1 where none is known
  /// from the rest.
  int highest_variance(int n, int freedom, double& excess) const noexcept;
  /// Whether noise alike in all sensors would hardly ever single out the one with the highest variance so (Fisher's z).
  bool beyond_chance(int sensor, int freedom, double excess) const noexcept;
  /// Variance of that sensor's reading at a station over what the weights of the fit say.
  double variance_factor(int sensor, int n, int freedom) const noexcept;

 private:
  Harmonics* harmonics_;
  std::array<double, kCapacity> squared_residual_{};
  std::array<int, kCapacity> seen_{};
  std::array<double, kCapacity> explained_{};  ///< of chi^2, by leaving the sensor out
  std::array<double, kCapacity> alone_{};      ///< stations at which that can be found out
  double squared_norm_ = 0.0;
  double squared_parity_ = 0.0;
  double chi2_ = 0.0;
  double direction_variance_ = 0.0;
  int stations_ = 0;
  int rows_ = 0;
};

/// Sensor whose reading explains most of an outlier's residual, and how much of it; -1 with three readings.
int blamed(const StationSolver& station, double& share) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
