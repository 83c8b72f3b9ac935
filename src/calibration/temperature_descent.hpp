/// The iteration of the fit over temperature. Private to the calibration module.
#pragma once

#include "temperature_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

/// Damped Gauss-Newton from the datasheet; outliers and noise beyond the datasheet's as in `Calibrator`.
class Descent {
 public:
  /// `scratch` holds the reduced stations: `count` of them, without samples where one is an outlier.
  Descent(const Joint& joint, double g_mps2, const FitOptions& options, const Station* stations, int count,
          Station* scratch, TemperatureWork& work) noexcept;

  void run() noexcept;

  const JointState& state() const noexcept { return state_; }
  /// The reduced stations at `state`.
  Problem problem() const noexcept;
  double misfit_variance() const noexcept { return misfit_; }
  double cost() const noexcept { return cost_; }
  int iterations() const noexcept { return iterations_; }
  int bad_station() const noexcept { return bad_station_; }
  StopReason stop() const noexcept { return stop_; }
  void turn_to_datasheet() noexcept;
  /// Writes the outliers into the report.
  void note_outliers(FitReport& report) const noexcept;

 private:
  enum class Phase : std::uint8_t { squares, huber, tukey, screened };

  void iterate() noexcept;
  bool weigh() noexcept;
  Loss loss() const noexcept;
  void sum() noexcept;
  bool goes_down(double cost) noexcept;
  bool step() noexcept;
  bool settled(double relative) const noexcept;
  bool advance(bool weights_settled) noexcept;
  bool misfit_changed() noexcept;
  void set_outliers_aside() noexcept;

  const Joint& joint_;
  double g_mps2_;
  const FitOptions& options_;
  const Station* stations_;
  int count_;
  Station* scratch_;
  TemperatureWork& work_;
  JointState state_, best_;
  JointSums sums_;
  JointVector step_{};
  Parameters moved_{};  ///< of W and b, by the last step, common rotation taken out
  Outlier outlier_[kMaxOutliers];
  int outliers_ = 0;
  double misfit_ = 0.0;  ///< variance
  double cost_ = 0.0;
  double damping_ = 0.0;
  int iterations_ = 0, rises_ = 0, robust_steps_ = 0, misfit_rounds_ = 0, freedom_ = 0, bad_station_ = -1;
  bool fresh_ = true, looked_ = false;
  Phase phase_ = Phase::squares;
  StopReason stop_ = StopReason::none;
};

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
