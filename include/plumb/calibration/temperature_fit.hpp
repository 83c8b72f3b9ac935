/// Calibration over temperature: one fit of axes, scale factors and biases to stations at several temperatures, scale
/// and bias of every sensor polynomials of one order in the temperature. Inside they are Chebyshev polynomials over the
/// span of use (docs/theory.md, section 9.7); the result is in powers of T_S - T_C, as `SensorCoefficients` has them.
#pragma once

#include <array>
#include <cstdint>

#include "plumb/calibration/calibration.hpp"
#include "plumb/calibration/null_directions.hpp"
#include "plumb/numeric/chebyshev.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

inline constexpr int kMaxTemperatureOrder = 3;
/// The highest order that the stations support.
inline constexpr int kAutomaticOrder = -1;

/// Parameters a sensor: W (3), b, and two for every order above zero. 40 of four sensors with cubics.
inline constexpr int kJointPerSensor = 4 + 2 * kMaxTemperatureOrder;
inline constexpr int kJointParameters = kJointPerSensor * kCapacity;

/// Stations whose temperatures differ by less are at one level: a tool warms up by as much in a day's work, which is no
/// evidence about a polynomial.
inline constexpr double kLevelsApart_degc = 10.0;
inline constexpr int kMaxTemperatureLevels = 16;

/// The distinct temperatures of the stations with samples, from the lowest up; of more than kMaxTemperatureLevels only
/// the lowest are kept. A level is the mean of its stations.
struct TemperatureLevels {
  int count = 0;
  std::array<double, kMaxTemperatureLevels> degc{};
  std::array<double, kMaxTemperatureLevels> begin_degc{};  ///< its lowest station; it reaches kLevelsApart_degc up
  std::array<int, kMaxTemperatureLevels> stations{};
  double lowest_degc = 0.0;  ///< of all stations
  double highest_degc = 0.0;
};
TemperatureLevels temperature_levels(const Station* stations, int count) noexcept;
/// From the lowest to the highest station [degC], without those that are alone at their level: a single station, or a
/// slip of the thermometer, confirms nothing.
ChebyshevSpan confirmed_span(const Station* stations, int count, const TemperatureLevels& levels) noexcept;
/// The same, of the level that has the most stations.
ChebyshevSpan fullest_level(const Station* stations, int count, const TemperatureLevels& levels) noexcept;

/// Whether the temperature went one way from the first station to the last, never back by a level: whatever changed
/// with time then looks like a drift with temperature.
bool one_way(const Station* stations, int count) noexcept;

/// Temperatures to record next so that `wanted` levels cover the span; returns their number, at most `wanted` less
/// those there are. Multiples of 5 degC, or ends of the span; each as far from all others as can be.
int missing_levels(const TemperatureLevels& levels, const ChebyshevSpan& use_degc, int wanted,
                   std::array<double, kMaxTemperatureOrder + 1>& degc) noexcept;

struct TemperatureOptions {
  int order = kAutomaticOrder;           ///< or 0 .. 3; 0 is the fit of `calibration.hpp`
  int max_order = kMaxTemperatureOrder;  ///< of the automatic choice, 0 .. 3
  /// [degC] where the calibration will be used; lowest = highest: the span of the stations.
  ChebyshevSpan use_degc{0.0, 0.0};
  /// Roll groups ask for order 0 (the automatic choice then takes it): over temperature the frame is that of the
  /// datasheet.
  FitOptions fit;
};

/// A coefficient as it stands in `SensorCoefficients`, with its marginal 1 sigma.
struct TemperatureCoefficient {
  double value = 0.0;
  double sigma = 0.0;
  double data_share = 0.0;  ///< as in `FitReport`
};
struct SensorTemperature {
  std::array<TemperatureCoefficient, kMaxTemperatureOrder + 1> scale{};  ///< SF, SFT1..3
  std::array<TemperatureCoefficient, kMaxTemperatureOrder + 1> bias{};   ///< B, BT1..3
};

/// One parameter of a direction that the stations leave open.
struct TemperatureTerm {
  ParameterKind kind = ParameterKind::bias;
  int order = 0;  ///< Chebyshev order; 0 for an axis
  int sensor = 0;
  double amount = 0.0;  ///< in prior sigmas; of an axis the length
};
inline constexpr int kMaxTemperatureTerms = 8;
struct TemperatureNull {
  int terms = 0;                                             ///< the largest are kept, from kNullTermShare up
  std::array<TemperatureTerm, kMaxTemperatureTerms> term{};  ///< the one by which it is distinguished first
};

/// What the calibration is expected to leave at one temperature, 1 sigma.
struct TemperatureForecast {
  double degc = 0.0;
  double reading_mps2 = 0.0;  ///< of the worst sensor, mean over the sphere
  int sensor = 0;             ///< which that is
  double tilt_rad = 0.0;      ///< of all sensors together, rms over the sphere
};

struct TemperatureReport {
  int order = 0;  ///< of the fit that is reported
  TemperatureLevels levels;
  ChebyshevSpan use_degc{0.0, 0.0};
  /// Levels that the order asked for still needs; of the automatic choice, those of the next order above.
  int missing = 0;
  std::array<double, kMaxTemperatureOrder + 1> missing_degc{};
  /// The temperature of the stations is a function of their inclination, so that the two cannot be distinguished.
  bool follows_inclination = false;
  /// The temperature only rose, or only fell, from station to station: a fit of an order above 0 cannot tell what time
  /// did from what temperature did.
  bool follows_time = false;
  bool rolls = false;  ///< roll groups are in use: they fix a frame of their own, at order 0 only

  int parameters = 0;  ///< (4 + 2 order) n
  int rank = 0;        ///< by the rule of `FitReport`; n = 4: 13 + 8 a level, at most 37 of 40 with cubics
  int gauge = 0;
  int null_directions = 0;  ///< beyond the gauge; at most kMaxNullDirections are kept
  std::array<TemperatureNull, kMaxNullDirections> null{};
  /// Of the observable part, Chebyshev polynomials over the span of use, all orders in prior units of the zeroth. Far
  /// above 30: to be extrapolated.
  double condition = 0.0;
  std::array<SensorTemperature, kCapacity> sensor{};
  std::array<TemperatureForecast, 3> forecast{};  ///< at the ends and the middle of the span of use: low, middle, high
  /// By what the mean variance over the calibrated span is multiplied so that it covers every temperature of it.
  double inflation = 1.0;
  int iterations = 0;
};

/// Memory of the fit, owned by the caller; overwritten. 1.4 MB at capacity 24, 154 KB at 8.
struct TemperatureWork {
  std::array<double, std::size_t{kJointParameters} * kJointParameters> information{};
  std::array<double, std::size_t{kJointParameters} * kJointParameters> scratch{};
  std::array<double, std::size_t{kJointParameters} * kJointParameters> vectors{};
};

/// The joint fit, Gauss-Newton from the datasheet, with the prior of the datasheet for every order. `scratch` holds
/// `count` stations and is overwritten. The calibration that it returns carries an uncertainty that covers every
/// temperature of the stations' span and kLevelMargin_degc beyond; its report counts the parameters of the joint fit,
/// with sigma and data_share of W and b at the mean over the span of use.
///
/// Errors, in this order: those of `Calibrator::finish`, where they apply; out_of_range (index 2: order or max_order,
/// 3: the span of use is outside kPlausibleMin_degc .. kPlausibleMax_degc, or narrower than kLevelsApart_degc where it
/// is given, 4: a prior
/// is not above 0, 5: an order above 0 beside roll groups); too_few_levels (value = levels, limit = order + 1;
/// report.missing_degc says where); unobservable; implausible (index = sensor: its scale factor leaves the bound at
/// some temperature of the span of use). An automatic order is refused only where order 0 is. `report` and
/// `fit_report`, where given, are filled as far as the stations allow, for refused fits too.
Expected<Calibration> calibrate_over_temperature(const Datasheet& datasheet, const GravityReference& gravity,
                                                 const Station* stations, int count, const TemperatureOptions& options,
                                                 Station* scratch, TemperatureWork& work,
                                                 TemperatureReport* report = nullptr,
                                                 FitReport* fit_report = nullptr) noexcept;

/// A datasheet whose sensors drift with temperature as those of the calibration do, its values at T_C as they were: by
/// it the fits at one temperature (`calibrate`, `inconsistent_sensor`) look at stations of any.
Datasheet with_temperature_of(const Datasheet& datasheet, const Calibration& calibration) noexcept;

/// So far beyond the stations' temperatures a monitor still judges.
inline constexpr double kLevelMargin_degc = 5.0;

}  // namespace PLUMB_ABI
}  // namespace plumb
