/// The paper's own auto-calibration, kept beside the forward fit so that its method can be run, shown and compared. It
/// sees the length of gravity alone: of the n(n+1) parameters 9 combinations show in the data whatever n is, the
/// Hessian is singular (docs/theory.md, section 9.4), and what the 9 leave open (the common frame, all parity) stays
/// where the datasheet had it. `calibration.hpp` is the fit to use.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/calibration.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

/// Parameters of n sensors: n biases, n scale factors, n(n-1) misalignments.
constexpr int paper_parameters(int n) noexcept { return n * (n + 1); }

/// Up to this many sensors the paper's fit is offered (its misalignments grow as n squared).
inline constexpr int kPaperCapacity = kCapacity < 8 ? kCapacity : 8;
inline constexpr int kPaperParameters = paper_parameters(kPaperCapacity);

/// Directions in parameter space that the length of gravity can show: the harmonics of degree 0 to 2 on the sphere.
inline constexpr int kPaperRank = 9;

/// Sets of axes with a smaller least singular value are refused (|det| of a triple below about 1e-3).
inline constexpr double kPaperMinSingular = 1e-3;

/// For n fitted sensors, in the order of the array: B_1..B_n [m/s^2], SF_1..SF_n [raw per m/s^2], then m_12, m_13, ...
/// row by row without the diagonal. The first n(n+1) entries count, the rest are 0.
using PaperParameters = std::array<double, kPaperParameters>;

namespace paper {
class ThreeSensorStep;
}

/// The error of one station as a function of the parameters, for the sensors `used` of one datasheet.
class PaperError {
 public:
  /// Errors: too_few_sensors; too_many_sensors; out_of_range (index 3: `used` names a sensor beyond the datasheet,
  /// 4: gravity outside 1e-100 .. 1e100, 5: a prior sigma below 0); not_finite (index = sensor: axis, prior,
  /// coefficient, or SF = 0); axes_rank_deficient.
  static Expected<PaperError> make(const Datasheet& datasheet, const GravityReference& gravity,
                                   SensorSet used) noexcept;

  int sensors() const noexcept { return n_; }
  int parameters() const noexcept { return paper_parameters(n_); }
  SensorSet used() const noexcept { return used_; }
  /// The datasheet's values, no misalignment: where every fit starts.
  const PaperParameters& start() const noexcept { return start_; }
  /// 1 sigma of each parameter as the datasheet has it: bias, relative scale times |SF|, axis of the row.
  const PaperParameters& prior() const noexcept { return prior_; }

  /// Whether the station has all sensors of `used`, and samples.
  bool usable(const Station& station) const noexcept { return station.count > 0 && station.delivered.contains(used_); }

  /// e_g of eq (7) [(m/s^2)^2], with the least-squares map of the nominal axes, unweighted. Temperature terms of the
  /// datasheet go along: those of a scale factor keep their ratio to it, those of a bias stay. NaN where a scale
  /// factor vanishes. `gradient`, where given, receives `parameters()` derivatives.
  double operator()(const PaperParameters& at, const Station& station,
                    PaperParameters* gradient = nullptr) const noexcept;

  /// Adds weight times the second derivatives of the error to the lower triangle of a row-major matrix of
  /// `parameters()` columns.
  void add_curvature(const PaperParameters& at, const Station& station, double weight, double* matrix) const noexcept;

  /// Half the gradient of the sum of squares and its Gauss-Newton matrix over the usable stations: lower triangle,
  /// row-major with leading dimension `stride`, a multiple of four that is at least `parameters()`; what lies above the
  /// diagonal is not to be read. Returns `cost`, to rounding.
  double gauss_newton(const PaperParameters& at, const Station* stations, int count, double* matrix, int stride,
                      PaperParameters& gradient) const noexcept;

  /// E_g of eq (10) [(m/s^2)^4]: mean square of the error over the usable stations; NaN where there are none.
  double cost(const PaperParameters& at, const Station* stations, int count) const noexcept;

  /// Writes the parameters into a model of the whole array; entries of other sensors are left alone.
  void store(const PaperParameters& at, SensorModel& model) const noexcept;

 private:
  friend class paper::ThreeSensorStep;
  struct Point;
  struct Prepared;
  Prepared prepare(const PaperParameters& at) const noexcept;
  void temper(double temperature_degc, Prepared& prepared) const noexcept;
  Point point(Prepared& prepared, const Station& station) const noexcept;
  void derivatives(const Point& p, const Prepared& prepared, PaperParameters& gradient) const noexcept;
  int misalignment(int i, int j) const noexcept { return 2 * n_ + i * (n_ - 1) + (j < i ? j : j - 1); }

  int n_ = 0;
  SensorSet used_;
  double g_squared_ = 0.0;
  std::array<int, kPaperCapacity> sensor_{};
  std::array<Vec3, kPaperCapacity> map_{};  ///< columns of the least-squares map
  std::array<SensorCoefficients, kPaperCapacity> nominal_{};
  PaperParameters start_{};
  PaperParameters prior_{};
};

/// Eq (11): the new parameters are the old ones less damping times inverse Hessian times gradient. As printed it has
/// no inverse to work with; the departure that makes it solvable is the default.
enum class PaperStep : std::uint8_t {
  /// Gauss-Newton in prior-scaled parameters with the pseudo-inverse of fixed rank 9: the smallest step, in prior
  /// sigmas, that does what the nine strongest directions ask for. What only noise or nothing shows is left alone,
  /// and so is the little more that a drifting bias shows over a span of temperatures.
  minimum_norm,
  /// The plain inverse of the full Hessian, as printed: documents what that does, for nothing else. Over 300 simulated
  /// tools of four sensors it never ends (26 % with a damping of 0.5); of three, 98 % end, by luck of rounding, in a
  /// frame that drifts.
  plain_inverse,
};

struct PaperOptions {
  PaperStep step = PaperStep::minimum_norm;
  double damping = 1.0;  ///< alpha, in (0, 1]
  /// Epsilon of the stop rule, eq (12), with the prior sigma as absolute floor of the denominator: a bias or a
  /// misalignment near zero has no relative accuracy.
  double stop = 1.5e-6;
  int max_iterations = 100;  ///< 1 .. kMaxPaperIterations
};

inline constexpr int kMaxPaperIterations = 100;

/// The state after one iteration, as Figs 4 to 10 draw it.
struct PaperIteration {
  PaperParameters parameter{};
  double cost = 0.0;    ///< E_g [(m/s^2)^4]
  double change = 0.0;  ///< what the stop rule compares with `stop`; 0 at the start
};

/// Every iteration of a fit, the start first; `size` entries are filled. 60 KB at capacity 8 and above.
struct PaperTrace {
  int size = 0;
  std::array<PaperIteration, kMaxPaperIterations + 1> iteration{};
};

/// A fit of the sensors `used` by the paper's method.
struct PaperFit {
  SensorSet used;
  SensorModel model;       ///< with misalignments, over the nominal axes; sensors not in `used` as in the datasheet
  bool converged = false;  ///< the stop rule was met
  StopReason stop = StopReason::none;  ///< converged, iteration_limit or not_finite
  int iterations = 0;                  ///< steps taken
  double start_cost = 0.0;             ///< E_g of the datasheet's values
  double cost = 0.0;                   ///< E_g at the end
  /// Of the prior-scaled Jacobian at the end, singular values within the reach of the datasheet's noise counted as
  /// zero: 9 where the stations suffice. Below 9 the step leant on noise.
  int rank = 0;

  /// Whether there is a fit to measure with: it ended, and the stations showed all that the length of gravity can show.
  bool sound() const noexcept { return converged && rank == kPaperRank; }
};

/// Fits the sensors in `used` to the stations that have them all, starting from the datasheet. Needs 100 KB of stack at
/// capacity 8 and above (24 KB at capacity 4): a matrix of 72 x 72 and its factor of 72 x 32.
/// Errors: out_of_range (index 0 damping, 1 stop, 2 max_iterations); those of `PaperError::make`; too_few_stations
/// (fewer than kPaperRank usable); not_finite (index = station: temperature, raw value, or SF* = 0 at the start).
/// A fit that did not converge is returned with `converged` false, at its last finite parameters: showing that is what
/// this storage is for. `trace`, where given, ends with the parameters returned.
Expected<void> paper_calibrate(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                               int count, SensorSet used, const PaperOptions& options, PaperFit& out,
                               PaperTrace* trace = nullptr) noexcept;

/// Vector from the readings of the fitted sensors: the model with its misalignments, then unweighted least squares over
/// the nominal axes of `used`. Zero where these have rank < 3.
Vec3 paper_vector(const SensorArray& nominal, const PaperFit& fit, const std::array<double, kCapacity>& raw,
                  double temperature_degc) noexcept;

/// The same over those of `of` alone that the fit holds; the cross terms of the others are omitted with them.
Vec3 paper_vector(const SensorArray& nominal, const PaperFit& fit, const std::array<double, kCapacity>& raw,
                  double temperature_degc, SensorSet of) noexcept;

/// What paper mode monitors with: the fit of all sensors and, per triple of the array, a fit of its own (step 1).
struct PaperCalibration {
  PaperFit all;
  int triples = 0;
  std::array<PaperFit, triple_count_of(kPaperCapacity)> triple{};  ///< in the order of SensorArray::triple
};

/// Fits all sensors, then every triple. A triple that cannot be fitted (axes in one plane, too few stations) is left
/// with `used` alone, neither converged nor sound. Errors: too_many_sensors (value = sensors, limit = kPaperCapacity);
/// those of `paper_calibrate` for all sensors.
Expected<void> paper_calibrate_all(const Datasheet& datasheet, const GravityReference& gravity, const Station* stations,
                                   int count, const PaperOptions& options, PaperCalibration& out) noexcept;

}  // namespace PLUMB_ABI
}  // namespace plumb
