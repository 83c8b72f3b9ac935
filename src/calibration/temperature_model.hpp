/// The parts of the fit over temperature. Private to the calibration module.
///
/// Per sensor  V / SF_0 = s(tau) (W g + b + beta(tau)) + e,  s = 1 + sum_1..K s_j T_j, beta = sum_0..K b_j T_j with b_0
/// that of the datasheet, tau the temperature scaled to the span of use. Divided by s and less beta, a station reads as
/// one of a tool without temperature: all that the fit at one temperature has (solver, closed bounds, outliers, tally)
/// works on such *reduced* stations, and only the derivatives know of s and beta.
#pragma once

#include "fit_report.hpp"
#include "plumb/calibration/temperature_fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {

/// Per sensor W, b, then s_1, b_1, s_2, b_2 ... up to the order of the fit.
using JointVector = std::array<double, kJointParameters>;
using Cubics = std::array<Cubic, kCapacity>;

struct JointState {
  Parameters theta{};  ///< W and b
  Cubics scale{};      ///< s_j; [0] = 1
  Cubics bias{};       ///< b_j in the gravity sense; [0] as in the datasheet
};

/// What is fixed during one fit. Orders above that of the fit stay as the datasheet has them.
struct Joint {
  Joint(const Datasheet& nominal_sheet, const ChebyshevSpan& use, int highest_order) noexcept;

  int sensors() const noexcept { return sheet.size; }
  int per_sensor() const noexcept { return 4 + 2 * order; }
  int parameters() const noexcept { return per_sensor() * sensors(); }

  const Datasheet& datasheet;
  ChebyshevSpan use_degc;
  int order;
  double sign;                         ///< of the readings
  Datasheet sheet;                     ///< of a tool without temperature, in the raw unit of the log
  JointState nominal;                  ///< of the datasheet
  Cubics scale_sigma{}, bias_sigma{};  ///< prior, by order; [0] unused
  PriorRoots roots;                    ///< of W and b
};

/// The station as a tool without temperature would have read it. Clipped channels are omitted.
Station reduced(const Joint& joint, const JointState& state, const Station& station) noexcept;
/// Reduces all stations; one whose copy has no samples (an outlier) stays without.
void reduce_all(const Joint& joint, const JointState& state, const Station* stations, int count, Station* to) noexcept;

/// Deviation from the datasheet in prior units, and back.
JointVector joint_prior_units(const Joint& joint, const JointState& state) noexcept;
void add_terms(const Joint& joint, const JointVector& step, JointState& state) noexcept;

/// The datasheet with the fitted polynomials, their mean left to W and b.
Datasheet with_polynomials(const Joint& joint, const JointState& state) noexcept;

struct JointSums {
  Sums sums;
  JointVector rhs{};  ///< prior units
};
/// Information about all parameters in prior units (lower triangle, stride `parameters`), and what pulls at them.
/// `reduced` are the stations as reduced by `state`, with the temperatures of the originals.
void accumulate(const Joint& joint, const JointState& state, const Problem& reduced, double misfit_variance, Loss loss,
                double* information, JointSums& out, FitTally* tally = nullptr) noexcept;

/// What the analysis leaves for the composition.
struct JointAnalysis {
  const Joint& joint;
  const JointState& state;
  double g_mps2;
  double misfit_variance;
  double floor;  ///< eigenvalues below it times the largest count as zero
  const Station* stations;
  int count;
  Station* scratch;  ///< the stations as reduced by `state`, before and after
};
/// Rank, gauge, condition and null directions; `work.information` (lower triangle) is kept. False where the
/// eigenvalues could not be had.
bool find_rank(const JointAnalysis& analysis, TemperatureWork& work, TemperatureReport& report) noexcept;
/// From the sum over the stations to the posterior covariance in natural units with the common rotation taken out, both
/// triangles.
bool to_posterior(const Joint& joint, const Parameters& theta, double* information) noexcept;
/// The same, and the coefficients with their sigmas. `work.information` is the sum over the stations;
/// left there: the posterior covariance in natural units with the common rotation taken out, both triangles.
bool analyse(const JointAnalysis& analysis, TemperatureWork& work, TemperatureReport& report, FitReport& fit) noexcept;

/// Covariance of W and b (4n x 4n, both triangles) as they act at one temperature, from the joint one.
void covariance_at(const Joint& joint, const JointState& state, const double* covariance, double temperature_degc,
                   double* out) noexcept;
/// What to expect at the ends and in the middle of the span of use, from the joint covariance.
void note_forecast(const Joint& joint, const JointState& state, double g_mps2, double misfit_mps2,
                   TemperatureWork& work, TemperatureReport& report) noexcept;
/// One covariance that covers every temperature of the span, in `work.vectors`; returns the inflation. 0 where there
/// is none.
double covering_covariance(const Joint& joint, const JointState& state, const ChebyshevSpan& span_degc,
                           TemperatureWork& work) noexcept;

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
