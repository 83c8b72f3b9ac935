/// Calibration from gravity alone: the forward maximum-likelihood fit  a = W g + b + e  in one common
/// frame (a departure from the paper's, whose Hessian is singular: `paper/paper_calibration.hpp`), with the
/// datasheet as prior. Every triple of the array follows from the one fit.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/calibration/detail/station_list.hpp"
#include "plumb/core/sample.hpp"
#include "plumb/gravity/gravity.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

enum class StopReason : std::uint8_t { none, converged, iteration_limit, no_descent, not_finite };
const char* to_string(StopReason reason) noexcept;

/// Where a fit starts. Both ways end at the same place where the data have full rank; the closed form needs fewer
/// iterations, and arrives from errors many times those of a datasheet.
enum class FitStart : std::uint8_t {
  automatic,   ///< closed form where it exists, else the datasheet
  datasheet,   ///< the nominal values
  closed_form  ///< as `automatic`; the report says what it was
};
const char* to_string(FitStart start) noexcept;

/// Parameters of the fit: per sensor W_x, W_y, W_z (dimensionless, in the tool frame) and b [m/s^2].
inline constexpr int kFitParameters = 4 * kCapacity;

/// A direction in parameter space that the stations cannot see, in prior units.
struct NullDirection {
  std::array<double, kFitParameters> component{};
};
inline constexpr int kMaxNullDirections = 16;

/// Stations with one roll group tag each (`Station::roll_group`) that a fit can tell apart.
inline constexpr int kMaxRollGroups = 16;

/// A station that the fit rejected, because its residual is not noise.
struct Outlier {
  int station = -1;
  double standardised = 0.0;  ///< length of its residual in standard deviations, n - 2 dimensions together
  int sensor = -1;            ///< whose reading explains most of it; -1 with three sensors, where all do equally
  double share = 0.0;         ///< of the squared residual that goes without that reading
};
inline constexpr int kMaxOutliers = 16;

/// Residuals that the declared noise explains with less than this probability are something else.
inline constexpr double kNoNoise = 1e-6;

/// The part of all scale changes that the sensors share, which is all that a wrong length of gravity or a wrong unit
/// does to a calibration (the direction is not affected).
struct CommonScale {
  double mean = 0.0;     ///< of |W_i| - 1 over the sensors
  double scatter = 0.0;  ///< standard deviation of the single changes about it
  double sigma = 0.0;    ///< what the datasheet expects of `mean`: rms prior of a scale over sqrt(n)
  /// `mean` in units of `sigma`; 0 where all scales are frozen.
  double sigmas() const noexcept { return sigma > 0.0 ? mean / sigma : 0.0; }
};

/// The rotation across the roll axis by which roll groups turned all axes together from the nominal ones: what a roll
/// axis that is not the one stated does. The nominal axes, each by its prior, know it within `sigma_rad`.
struct CommonTurn {
  double rad = 0.0;
  double sigma_rad = 0.0;  ///< 1 sigma of the nominal axes, in the direction of the turn; 0 where none was judged
  int sensor = -1;         ///< whose own axis, off alone, explains the axes better than a common turn; -1 none
  double sigmas() const noexcept { return sigma_rad > 0.0 ? rad / sigma_rad : 0.0; }
};

/// The mean residual of one sensor over the stations of one temperature level, where it is beyond what noise and misfit
/// leave: in fewer than 1e-4 of fits to sensors that follow the model.
struct LevelMisfit {
  int sensor = -1;  ///< -1: none
  double degc = 0.0;
  double mean_mps2 = 0.0;
  double sigma_mps2 = 0.0;
  SensorSet suspects;  ///< it, and those whose own mean explains the stations about as well: it is one of these
  double sigmas() const noexcept {
    return sigma_mps2 > 0.0 ? (mean_mps2 < 0.0 ? -mean_mps2 : mean_mps2) / sigma_mps2 : 0.0;
  }
};

/// A station hotter or colder has no thermometer that works [degC].
inline constexpr double kPlausibleMin_degc = -100.0;
inline constexpr double kPlausibleMax_degc = 400.0;

/// The figures by which a fit is judged.
struct FitFigures {
  int stations = 0;         ///< used: without outliers
  int parameters = 0;       ///< 4n
  int rank = 0;             ///< of the prior-scaled information of the data alone
  int gauge = 0;            ///< of the missing rank: common rotations (3, or 1 where roll groups see the others)
  int null_directions = 0;  ///< number beyond the gauge; at most kMaxNullDirections are kept
  double condition = 0.0;   ///< of the observable block, in prior units: ratio of its extreme singular values
  /// 1 sigma of what calibration leaves in a reading, misfit included: RowUncertainty::at(i, i, g), mean over the
  /// sphere.
  std::array<double, kCapacity> e_cal_mps2{};
  std::array<double, kCapacity> residual_rms_mps2{};  ///< of a - W g - b, per sensor over the stations
  double norm_rms_mps2 = 0.0;                         ///< of |x| - G over the stations
  double parity_rms_mps2 = 0.0;                       ///< of the orthonormal parity residuals; 0 where n = 3
  double noise_mps2 = 0.0;                            ///< of the noisiest mean of a station, by the datasheet; rms
  double misfit_mps2 = 0.0;                           ///< noise beyond the datasheet's that the residuals ask for
  double chi2 = 0.0;                                  ///< against the datasheet's noise alone
  int degrees_of_freedom = 0;
  double p_value = 1.0;
  double excitation = 0.0;            ///< least eigenvalue of the Gram matrix of the 9 harmonics, uniform sphere = 1
  double temperature_min_degc = 0.0;  ///< span of the stations: beyond it by > 5 degC a monitor confirms nothing
  double temperature_max_degc = 0.0;
  int outliers = 0;               ///< stations rejected; at most kMaxOutliers are kept, in order
  int clipped = 0;                ///< readings at or beyond the full scale, not used
  SensorSet clipped_sensors;      ///< whose they were
  int roll_groups = 0;            ///< groups of stations that share an inclination
  int single_station_groups = 0;  ///< of them those with a single station, which say nothing
  Vec3 roll_axis{};               ///< as the fit took it; zero where no two stations share a group
  double roll_axis_deviation_rad = 0.0;
  /// 1 sigma of an inclination about `FitOptions::roll_axis` at the stations' own attitudes, as far as calibration
  /// goes; without roll rows the part of the nominal axes, which no station sees, included.
  double inclination_sigma_rad = 0.0;
  CommonTurn common_turn;    ///< with roll groups only
  LevelMisfit level_misfit;  ///< over two temperature levels or more
  /// Of a value that is implausible: the sensors of which any one alone, wrongly described, explains the stations about
  /// as well. More than one: it is one of these.
  SensorSet suspects;
  /// The sensor whose residuals exceed those of the others beyond chance where they are no noise (p < `kNoNoise`), by
  /// what factor (rms), and the noise beyond the datasheet's that is its own. All sigmas are widened, named or not; -1
  /// where there is none, or where too little is left over to tell.
  int high_variance_sensor = -1;
  double loud_excess = 1.0;
  double loud_misfit_mps2 = 0.0;
  /// Part of the stations' squared residuals, in the weights of the fit, that goes without a sensor's readings; for
  /// healthy sensors all alike, about 1 / (n - 2). 0 with three sensors.
  std::array<double, kCapacity> residual_share{};
  /// Of one sample about the mean of its station, pooled over the stations that know (`Station::scatter`); 0 where
  /// none.
  std::array<double, kCapacity> sample_noise_mps2{};
  CommonScale common_scale;
  FitStart start = FitStart::datasheet;  ///< where it really started
  int iterations = 0;
  StopReason stop = StopReason::none;
};

struct FitReport : FitFigures {
  std::array<NullDirection, kMaxNullDirections> null_direction{};
  std::array<double, kFitParameters> sigma{};  ///< posterior 1 sigma, gauge removed (W dimensionless, b in m/s^2)
  std::array<double, kFitParameters>
      data_share{};  ///< 1 - (sigma_post/sigma_prior)^2: 1 = from data, 0 = from the datasheet
  std::array<Outlier, kMaxOutliers> outlier{};
};

/// An accepted calibration: the model turns raw values into m/s^2, the array says along which axes and
/// how surely.
struct Calibration {
  SensorModel model;  ///< common-frame form, misalignment zero
  SensorArray array;  ///< calibrated axes, noise, and the uncertainty that calibration leaves
  FitReport report;
};

/// A residual is too large beyond its bound in m/s^2, and beyond so many standard deviations of a station's mean where
/// that is more: the means of coarse sensors scatter by more than any calibration can mend.
inline constexpr double kResidualNoiseSigmas = 3.0;
inline double residual_bound_mps2(double bound_mps2, const FitFigures& figures) noexcept {
  const double noise = kResidualNoiseSigmas * figures.noise_mps2;
  return noise > bound_mps2 ? noise : bound_mps2;
}

struct FitOptions {
  int max_iterations = 100;           ///< those that look for outliers included
  double stop_relative = 1.5e-6;      ///< the paper's stop rule, with the prior sigma as absolute floor
  double max_norm_rms_mps2 = 0.05;    ///< poor_fit beyond it and beyond `kResidualNoiseSigmas` sigmas
  double max_scale_change = 0.25;     ///< implausible beyond it: max(SF/SF0, SF0/SF) - 1
  double max_axis_change_rad = 0.26;  ///< implausible beyond it (15 deg)
  double max_bias_sigmas = 8.0;       ///< implausible beyond it, in prior sigmas
  bool require_full_rank = true;      ///< unobservable where rank < 4n - 3 (4n - 1 with roll groups)
  bool estimate_misfit = true;
  FitStart start = FitStart::automatic;
  /// Huber, then Tukey, then least squares without the stations that Tukey leaves beyond six sigma (4.685 with three
  /// sensors). Where no residual is beyond that against the datasheet's noise, nothing is done and nothing changes:
  /// clean data pay nothing for it, and so it is on.
  bool reject_outliers = true;
  double max_outlier_share = 0.25;  ///< of the stations; poor_fit beyond it: that is a fault, not an outlier
  /// Of one sensor's residuals over those of the others, rms; poor_fit beyond it, where p < 1e-3. Needs four sensors
  /// and some twenty stations. However noisy a sensor, it drags the fit of the others along, so that the ratio stays
  /// near 4.
  double max_sensor_excess = 3.0;
  /// Of a sensor's own samples over the declared noise; poor_fit beyond it where the residuals are no noise either
  /// (p < `kNoNoise`). The limits of a monitor are made of the declared noise, and no misfit mends those.
  double max_noise_factor = 2.0;
  Vec3 roll_axis{0.0, 0.0, 1.0};  ///< about which stations of one `Station::roll_group` are rolled; unit, tool frame
  double roll_axis_deviation_rad = 0.0;  ///< 1 sigma by which the inclination differs from roll to roll

  static constexpr auto fields() noexcept {
    using F = FitOptions;
    return field_list(not_stored(&F::max_iterations), &F::stop_relative, &F::max_norm_rms_mps2, &F::max_scale_change,
                      &F::max_axis_change_rad, &F::max_bias_sigmas, &F::require_full_rank, &F::estimate_misfit,
                      not_stored(&F::start), &F::reject_outliers, &F::max_outlier_share, &F::max_sensor_excess,
                      &F::max_noise_factor, &F::roll_axis, &F::roll_axis_deviation_rad);
  }
};

/// What a fit of biases and scales says where the axes are held: as much of a `Calibration` as changes.
struct HeldFit {
  std::array<double, kCapacity> length{};     ///< |W|: the new scale over the nominal one
  std::array<double, kCapacity> bias_mps2{};  ///< b, in the sense in which the sensor reads
  int rank = 0;
  int degrees_of_freedom = 0;
  double chi2 = 0.0;
  double p_value = 1.0;

  /// 0 where no freedom is left.
  double chi2_per_freedom() const noexcept { return degrees_of_freedom > 0 ? chi2 / degrees_of_freedom : 0.0; }
};

namespace fit {
struct Problem;
struct Sums;
struct Room;
struct Fitted;
}  // namespace fit

/// One bounded Gauss-Newton iteration per call, no heap: the host tool runs it to the end, a monitor
/// may drive it step by step. The first call finds the start instead, where that is the closed form.
class Calibrator {
 public:
  Calibrator(const Datasheet& datasheet, const GravityReference& gravity, const FitOptions& options) noexcept;
  /// Of no sensors: room for a fit that is assigned later.
  Calibrator() noexcept = default;

  /// One iteration over the given stations (always the same ones until `done`).
  void iterate(const Station* stations, int count) noexcept;
  /// The same for a fit whose axes are all held (prior `axis_rad` 0) and whose stations have no roll groups: the same
  /// digits on a small stack. Of at most 32 stations.
  void iterate_held(const StationList& stations) noexcept;
  bool done() const noexcept { return stop_ != StopReason::none; }
  int iterations() const noexcept { return iterations_; }
  const GravityReference& gravity() const noexcept { return gravity_; }
  /// After its state has been read back: goes on with the datasheet and the options that it was made with.
  void resume(const Datasheet& datasheet, const FitOptions& options) noexcept;
  double cost() const noexcept { return cost_; }
  /// Where the fit stands: per sensor W and b [m/s^2], in the frame it has drifted to (`finish` turns it back).
  std::array<double, kFitParameters> parameters() const noexcept;

  /// Whether the fit has rejected this station as an outlier: for any number of them, where a report lists only
  /// kMaxOutliers.
  bool sets_aside(const Station& station) const noexcept;

  /// Ranks, covariances, residuals and acceptance. Errors, in this order: those of `Datasheet::array`; not_finite
  /// (index = sensor: scale factor 0 or no number); out_of_range (index 0: roll axis not of unit length, 1: more than
  /// kMaxRollGroups roll groups, 2: deviation negative or NaN); too_few_stations; diverged (not finite; gravity, a
  /// sigma or a prior but 0 outside 1e-100 .. 1e100; a temperature outside kPlausibleMin_degc .. kPlausibleMax_degc:
  /// index = station of the cause, if one; or not converged); unobservable (value = rank, limit = needed); implausible
  /// (index = sensor, -1 where it is one of report.suspects, or where roll groups turned all axes beyond what the
  /// nominal ones allow, value = turn; value = limit = 0 where it holds the same numbers as another); poor_fit (index =
  /// sensor where one is the cause, else -1). `report`, where given, is filled as far as the stations allow. May be
  /// called again.
  Expected<Calibration> finish(const Station* stations, int count, FitReport* report = nullptr) const noexcept;
  /// `finish` after `iterate_held`: the same judgement without the covariance, on a small stack. The datasheet must
  /// hold the rows of an array that `SensorArray::make` has accepted. `out` is filled where the fit itself came to an
  /// end.
  Error finish_held(const StationList& stations, HeldFit& out) const noexcept;

 private:
  /// What the iterations are at: plain least squares; the two losses that find the outliers; least squares without.
  enum class Phase : std::uint8_t { start, squares, huber, tukey, screened };

  void find_start(const Station* stations, int count) noexcept;
  // `Axes` is how the axes are treated, those that are free or those that are held: fit::FreeAxes or fit::HeldAxes.
  template <class Axes>
  bool weigh(const fit::Problem& problem, const std::array<double, kFitParameters>& natural) noexcept;
  /// Symmetric, lower triangle, stride 4n. Needed within one iteration alone and so on the stack, not in the state.
  using Information = std::array<double, std::size_t{kFitParameters} * kFitParameters>;

  fit::Sums accumulate_best(const fit::Problem& problem, std::array<double, kFitParameters>& natural, double* blocks,
                            std::array<double, kFitParameters>& rhs, const fit::Room& room) noexcept;
  template <class Axes>
  bool step_from(const fit::Problem& problem, const std::array<double, kFitParameters>& natural,
                 const std::array<double, kFitParameters>& rhs, const double* blocks, const fit::Room& room,
                 const typename Axes::Matrix& normal) noexcept;
  bool step_alone(const fit::Problem& problem, const std::array<double, kFitParameters>& natural,
                  const std::array<double, kFitParameters>& rhs, const double* blocks) noexcept;
  template <class Axes>
  bool solve(const fit::Problem& problem, std::array<double, kFitParameters>& natural, fit::Sums& sums,
             const fit::Room& room) noexcept;
  template <class Axes>
  void iterate_over(const fit::Problem& problem, const fit::Room& room) noexcept;
  bool goes_down(double cost, bool finite) noexcept;
  bool settled(const fit::Problem& problem, const std::array<double, kFitParameters>& natural,
               double relative) const noexcept;
  bool misfit_changed(const fit::Sums& sums, double* factor) noexcept;
  template <class Axes>
  bool advance(const fit::Problem& problem, const std::array<double, kFitParameters>& natural, const fit::Sums& sums,
               bool weights_settled, double* factor) noexcept;

  Error finish_into(const Station* stations, int count, FitReport& report, Calibration& out) const noexcept;
  int screen_out(StationList& stations) const noexcept;
  Error refused_held(const StationList& stations, FitFigures& figures) const noexcept;
  Error judge_held(const StationList& stations, const fit::Fitted& fitted, FitFigures& figures) const noexcept;
  bool describe_held(const StationList& stations, fit::Fitted& fitted, FitFigures& figures) const noexcept;
  Error refused(const Station* stations, int count, FitReport& report) const noexcept;
  bool describe(const fit::Problem& problem, fit::Fitted& fitted, Information& covariance,
                FitReport& report) const noexcept;
  Error judge(const fit::Problem& problem, const fit::Fitted& fitted, FitReport& report) const noexcept;

  Datasheet datasheet_;
  GravityReference gravity_;
  FitOptions options_;
  std::array<double, kFitParameters> theta_{};   ///< deviation from the datasheet in units of the prior
  std::array<double, kFitParameters> step_{};    ///< the last step, same units
  std::array<double, kFitParameters> best_{};    ///< where the cost was lowest, same units
  std::array<double, kFitParameters> screen_{};  ///< W and b by which the outliers were separated from the rest
  double cost_ = 0.0;
  double damping_ = 0.0;  ///< Levenberg-Marquardt, relative to the diagonal; 0 unless the cost rose
  double misfit_mps2_ = 0.0;
  double screen_misfit_mps2_ = 0.0;  ///< the noise beyond the datasheet's that went with it
  int misfit_rounds_ = 0;
  int robust_steps_ = 0;
  int freedom_ = 0;      ///< of the fit, where outliers are looked for
  bool looked_ = false;  ///< for outliers
  int iterations_ = 0;
  int rises_ = 0;  ///< iterations since the cost was lowest
  int bad_station_ = -1;
  bool fresh_ = true;  ///< no cost yet to compare with: at the start and after a change of weights
  Phase phase_ = Phase::start;
  FitStart started_ = FitStart::datasheet;
  StopReason stop_ = StopReason::none;

  friend struct FieldsOf;
  /// Between two iterations. What the fit is made from is given anew; the last step and the sums are made anew.
  static constexpr int parameter_count(int sensors) noexcept { return 4 * sensors; }
  static constexpr auto fields() noexcept {
    using C = Calibrator;
    return field_list(not_stored(&C::datasheet_), &C::gravity_, not_stored(&C::options_),
                      leading(any(&C::theta_), &parameter_count), not_stored(&C::step_),
                      leading(any(&C::best_), &parameter_count), leading(any(&C::screen_), &parameter_count),
                      any(&C::cost_), any(&C::damping_), any(&C::misfit_mps2_), any(&C::screen_misfit_mps2_),
                      within(&C::misfit_rounds_, 0, 100), within(&C::robust_steps_, 0, 1000),
                      within(&C::freedom_, -kFitParameters, 1000000), &C::looked_, within(&C::iterations_, 0, 100000),
                      within(&C::rises_, 0, 1000), within(&C::bad_station_, -1, 1000000), &C::fresh_,
                      up_to(&C::phase_, Phase::screened), up_to(&C::started_, FitStart::closed_form),
                      up_to(&C::stop_, StopReason::not_finite));
  }
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
