/// A fit judged by what it did not use: stations held out, sensors omitted. The caller owns all storage; the work is a
/// bounded number of fits.
#pragma once

#include "plumb/calibration/temperature_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Station k belongs to fold k mod `folds`. Of each of the first `rounds` folds the stations are held out of a fit to
/// all others, then predicted by it. folds = count is leave-one-out; folds = 4 with rounds = 1 holds a quarter out
/// once.
struct HoldOutPlan {
  int folds = 4;
  int rounds = 4;  ///< 1 .. folds
};

/// What a calibration says of one station that it has not seen.
struct StationPrediction {
  bool judged = false;
  double norm_error_mps2 = 0.0;  ///< |x| - G
  double parity_rms_mps2 = 0.0;  ///< of the orthonormal parity residuals; 0 with three sensors
  /// rms of norm and parity residuals, each in units of the sigma that noise, misfit and covariance of the fit say.
  double sigmas = 0.0;
};

/// `judged` is false where fewer than three independent sensors delivered or there are no samples.
StationPrediction predict(const Calibration& calibration, const GravityReference& gravity,
                          const Station& station) noexcept;

struct HoldOut {
  int judged = 0;      ///< stations predicted
  int not_judged = 0;  ///< held out, but the rest gave no fit of full rank, or the station no vector
  double norm_rms_mps2 = 0.0;
  double norm_max_mps2 = 0.0;
  double parity_rms_mps2 = 0.0;
  double parity_max_mps2 = 0.0;
  double sigmas = 0.0;  ///< rms over the stations; 1 = the fit predicts as well as it claims
  int worst = -1;       ///< station with the largest `sigmas`
};

/// `scratch` holds `count` stations and is overwritten; `each`, where given, receives `count` predictions. Nothing is
/// judged where folds < 2, rounds is outside 1 .. folds, or a pointer is null.
HoldOut hold_out(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
                 const HoldOutPlan& plan, const FitOptions& options, Station* scratch,
                 StationPrediction* each = nullptr) noexcept;

/// The same by fits over temperature; give the order that the fit to all stations has, for the automatic one may differ
/// from fold to fold. `more_scratch` holds `count` stations too.
HoldOut hold_out_over_temperature(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                  int count, const HoldOutPlan& plan, const TemperatureOptions& options,
                                  Station* scratch, Station* more_scratch, TemperatureWork& work,
                                  StationPrediction* each = nullptr) noexcept;

/// The sensor without which the rest agrees.
struct OddSensor {
  int sensor = -1;            ///< -1: none stands out
  double with_mps2 = 0.0;     ///< misfit of the fit to all sensors; infinite where that does not settle
  double without_mps2 = 0.0;  ///< misfit of the fit without it
  double ratio = 1.0;         ///< chi^2 per degree of freedom without it, over the least without any other
};

/// Omits one sensor after the other. A sensor stands out if chi^2 per degree of freedom without it is at most
/// kOddRatio of the least without any other, with at least kOddFreedom degrees of freedom left; a fit that does not
/// settle within the physical bounds of `options` is the worst. No station is rejected as an outlier: omit those
/// that must not speak. n fits; `scratch` holds `count` stations.
inline constexpr double kOddRatio = 0.1;
inline constexpr int kOddFreedom = 4;
OddSensor odd_sensor(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations, int count,
                     const FitOptions& options, Station* scratch) noexcept;

/// Options under which every fit that converges is returned, for figures about fits that would be refused.
FitOptions without_limits(FitOptions options) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
