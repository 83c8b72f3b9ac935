/// Calibration from gravity alone: the forward maximum-likelihood fit  a = W g + b + e  in one common
/// frame (a departure from eqs (7), (10)-(12), whose Hessian is singular; calibration note 0), with the
/// datasheet as prior. Every triple of the array follows from the one fit.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/gravity/gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class StopReason : std::uint8_t { none, converged, iteration_limit, no_descent, not_finite };
const char* to_string(StopReason reason) noexcept;

/// Parameters of the fit: per sensor W_x, W_y, W_z (dimensionless, in the tool frame) and b [m/s^2].
inline constexpr int kFitParameters = 4 * kCapacity;

/// A direction in parameter space that the stations cannot see, in prior units.
struct NullDirection {
  std::array<double, kFitParameters> component{};
};
inline constexpr int kMaxNullDirections = 16;

struct FitReport {
  int stations = 0;
  int parameters = 0;       ///< 4n
  int rank = 0;             ///< of the prior-scaled information of the data alone
  int gauge = 0;            ///< of the missing rank: common rotations (3 for a norm-and-parity fit)
  int null_directions = 0;  ///< number beyond the gauge; at most kMaxNullDirections are kept
  std::array<NullDirection, kMaxNullDirections> null_direction{};
  double condition = 0.0;  ///< of the observable block, in prior units: ratio of its extreme singular values
  std::array<double, kFitParameters> sigma{};  ///< posterior 1 sigma, gauge removed (W dimensionless, b in m/s^2)
  std::array<double, kFitParameters>
      data_share{};  ///< 1 - (sigma_post/sigma_prior)^2: 1 = from data, 0 = from the datasheet
  /// 1 sigma of what calibration leaves in a reading, misfit included: RowUncertainty::at(i, i, g), mean over the
  /// sphere.
  std::array<double, kCapacity> e_cal_mps2{};
  std::array<double, kCapacity> residual_rms_mps2{};  ///< of a - W g - b, per sensor over the stations
  double norm_rms_mps2 = 0.0;                         ///< of |x| - G over the stations
  double parity_rms_mps2 = 0.0;                       ///< of the orthonormal parity residuals; 0 where n = 3
  double misfit_mps2 = 0.0;                           ///< noise beyond the datasheet's that the residuals ask for
  double chi2 = 0.0;                                  ///< against the datasheet's noise alone
  int degrees_of_freedom = 0;
  double p_value = 1.0;
  double excitation = 0.0;            ///< least eigenvalue of the Gram matrix of the 9 harmonics, uniform sphere = 1
  double temperature_min_degc = 0.0;  ///< span of the stations: beyond it by > 5 degC a monitor confirms nothing
  double temperature_max_degc = 0.0;
  int iterations = 0;
  StopReason stop = StopReason::none;
};

/// An accepted calibration: the model turns raw values into m/s^2, the array says along which axes and
/// how surely.
struct Calibration {
  SensorModel model;  ///< common-frame form, misalignment zero
  SensorArray array;  ///< calibrated axes, noise, and the uncertainty that calibration leaves
  FitReport report;
};

struct FitOptions {
  int max_iterations = 50;
  double stop_relative = 1.5e-6;      ///< eq (12), with the prior sigma as absolute floor
  double max_norm_rms_mps2 = 0.05;    ///< poor_fit beyond it
  double max_scale_change = 0.25;     ///< implausible beyond it: max(SF/SF0, SF0/SF) - 1
  double max_axis_change_rad = 0.26;  ///< implausible beyond it (15 deg)
  double max_bias_sigmas = 8.0;       ///< implausible beyond it, in prior sigmas
  bool require_full_rank = true;      ///< unobservable where rank < 4n - 3 (n >= 4), 9 (n = 3)
  bool estimate_misfit = true;
};

/// One bounded Gauss-Newton iteration per call, no heap: the host tool runs it to the end, a monitor
/// may drive it step by step.
class Calibrator {
 public:
  Calibrator(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options) noexcept;

  /// One iteration over the given stations (always the same ones until `done`).
  void iterate(const Station* stations, int count) noexcept;
  bool done() const noexcept { return stop_ != StopReason::none; }
  int iterations() const noexcept { return iterations_; }
  double cost() const noexcept { return cost_; }
  /// Where the fit stands: per sensor W and b [m/s^2], in the frame it has drifted to (`finish` turns it back).
  std::array<double, kFitParameters> parameters() const noexcept;

  /// Ranks, covariances, residuals and acceptance. Errors, in this order: those of `Datasheet::array`,
  /// too_few_stations, diverged (not finite, or not converged), unobservable (value = rank, limit =
  /// rank needed), implausible (index = sensor), poor_fit. `report`, where given, is filled as far as
  /// the stations allow. May be called again.
  Expected<Calibration> finish(const Station* stations, int count, FitReport* report = nullptr) noexcept;

 private:
  bool settled(const std::array<double, kFitParameters>& natural) const noexcept;
  bool misfit_changed(double chi2, double weighted_chi2, int rows, int stations) noexcept;

  Datasheet datasheet_;
  GravityReference gravity_;
  FitOptions options_;
  std::array<double, kFitParameters> theta_{};  ///< deviation from the datasheet in units of the prior
  std::array<double, kFitParameters> step_{};   ///< the last step, same units
  std::array<double, kFitParameters> best_{};   ///< where the cost was lowest, same units
  std::array<double, std::size_t{kFitParameters} * kFitParameters> normal_{};
  std::array<double, std::size_t{kFitParameters} * kFitParameters> scratch_{};
  double cost_ = 0.0;
  double damping_ = 0.0;  ///< Levenberg-Marquardt, relative to the diagonal; 0 unless the cost rose
  double misfit_mps2_ = 0.0;
  int misfit_rounds_ = 0;
  int iterations_ = 0;
  int rises_ = 0;      ///< iterations since the cost was lowest
  bool fresh_ = true;  ///< no cost yet to compare with: at the start and after a change of weights
  StopReason stop_ = StopReason::none;
};

/// Runs a Calibrator to its end.
Expected<Calibration> calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                int count, const FitOptions& options = {}, FitReport* report = nullptr) noexcept;

/// Residuals a - W g - b of every sensor at one station [m/s^2], with the fitted direction.
struct StationResidual {
  Vec3 gravity_mps2{};
  Readings residual_mps2{};
  double norm_error_mps2 = 0.0;  ///< |x| - G, x by least squares
};
StationResidual station_residual(const Calibration& calibration, const GravityReference& gravity,
                                 const Station& station) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
