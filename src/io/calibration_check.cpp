// What a calibration file may say: its checksum tells an accident from intent, and neither may put nonsense into the
// limits of a monitor.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "calibration_source.hpp"
#include "plumb/io/calibration_file.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

/// Ten times the full scale of anything that is calibrated by gravity.
constexpr double kMostAcceleration_mps2 = 1000.0;
constexpr double kMostNumber = 1e15;
/// Of the entries of a covariance, over what their variances allow.
constexpr double kRounding = 1e-6;
constexpr double kColdest_degc = -273.15, kHottest_degc = 1000.0;
constexpr double kUnitLength = 1e-6;

class Check {
 public:
  /// `number` of an entry where the section is a list, counted from 1; no section: the file itself.
  explicit Check(const Source& source, std::string section, int number = 0)
      : source_(source), section_(std::move(section)), number_(number) {}

  /// Written so that a NaN is refused too.
  void within(const std::string& name, double value, double least, double most) const {
    if (value >= least && value <= most) return;
    refuse(name, "is " + shortest(value) + ", must be " + bounds(least, most));
  }
  void positive(const std::string& name, double value, double most) const {
    if (value > 0.0 && value <= most) return;
    refuse(name, "is " + shortest(value) + ", must be above 0 and at most " + brief(most));
  }
  [[noreturn]] void refuse(const std::string& name, const std::string& what) const {
    const std::string index = number_ > 0 ? "[" + std::to_string(number_) + "]" : "";
    source_.fail(line_of(name), (section_.empty() ? "" : section_ + index + ".") + name, what, kMakeAnew);
  }

 private:
  int line_of(const std::string& key) const {
    std::size_t at = section_.empty() ? 0 : source_.text.find("\"" + section_.substr(section_.rfind('.') + 1) + "\"");
    for (int k = 0; k < std::max(number_, 1) && at != std::string::npos; ++k)
      at = source_.text.find("\"" + key + "\"", at + 1);
    return at == std::string::npos ? 0 : source_.line_at(at);
  }
  static std::string bounds(double least, double most) { return "from " + brief(least) + " to " + brief(most); }

  const Source& source_;
  std::string section_;
  int number_;
};

void check_report(const Check& check, const FitReport& report, int n) {
  constexpr double kCount = std::numeric_limits<int>::max();
  const double parameters = report.parameters;
  check.within("stations", report.stations, 0.0, kCount);
  check.within("parameters", parameters, 4.0 * n, 10.0 * n);
  check.within("rank", report.rank, 0.0, parameters);
  check.within("gauge", report.gauge, 0.0, 3.0);
  check.within("null_directions", report.null_directions, 0.0, parameters);
  check.within("condition", report.condition, 0.0, kMostNumber);
  check.within("norm_rms_mps2", report.norm_rms_mps2, 0.0, kMostAcceleration_mps2);
  check.within("parity_rms_mps2", report.parity_rms_mps2, 0.0, kMostAcceleration_mps2);
  check.within("misfit_mps2", report.misfit_mps2, 0.0, kMostAcceleration_mps2);
  check.within("chi2", report.chi2, 0.0, kMostNumber);
  check.within("degrees_of_freedom", report.degrees_of_freedom, 0.0, kCount);
  check.within("p_value", report.p_value, 0.0, 1.0);
  check.within("excitation", report.excitation, 0.0, kMostNumber);
  check.within("temperature_min_degc", report.temperature_min_degc, kColdest_degc, kHottest_degc);
  check.within("temperature_max_degc", report.temperature_max_degc, report.temperature_min_degc, kHottest_degc);
  check.within("iterations", report.iterations, 0.0, kCount);
  for (const NullDirection& direction : report.null_direction) {
    for (const double component : direction.component)
      check.within("null_direction", component, -kMostNumber, kMostNumber);
  }
}

void check_roll(const Check& check, const FitReport& report) {
  check.within("groups", report.roll_groups, 0.0, kMaxRollGroups);
  check.within("single_station_groups", report.single_station_groups, 0.0, report.roll_groups);
  check.within("axis_deviation_rad", report.roll_axis_deviation_rad, 0.0, kPi);
  check.within("inclination_sigma_rad", report.inclination_sigma_rad, 0.0, kMostNumber);
  check.within("common_turn_rad", report.common_turn.rad, 0.0, kPi);
  check.within("common_turn_sigma_rad", report.common_turn.sigma_rad, 0.0, kMostNumber);
  const double length = norm(report.roll_axis);  // 0: every group has one station
  if (length == 0.0) return;
  check.within("axis", length, 1.0 - kUnitLength, 1.0 + kUnitLength);
}

void check_sensor(const Check& check, const Calibration& calibration, int i) {
  const auto a = static_cast<std::size_t>(i);
  const SensorCoefficients& c = calibration.model.sensor[a];
  check.positive("sigma_mps2", calibration.array.sigma_mps2(i), kMostAcceleration_mps2);
  check.within("misfit_mps2", calibration.array.uncertainty().misfit_mps2[a], 0.0, kMostAcceleration_mps2);
  check.within("e_cal_mps2", calibration.report.e_cal_mps2[a], 0.0, kMostAcceleration_mps2);
  check.within("residual_rms_mps2", calibration.report.residual_rms_mps2[a], 0.0, kMostAcceleration_mps2);
  if (c.scale[0] == 0.0) check.refuse("scale", "is 0, and a scale factor cannot be 0");
  for (const double value : c.scale) check.within("scale", value, -kMostNumber, kMostNumber);
  for (const double value : c.bias) check.within("bias_mps2", value, -kMostNumber, kMostNumber);
  check.within("reference_degc", c.reference_degc, kColdest_degc, kHottest_degc);
  for (std::size_t k = 4 * a; k < 4 * a + 4; ++k) {
    check.within("fit_sigma", calibration.report.sigma[k], 0.0, kMostAcceleration_mps2);
    check.within("data_share", calibration.report.data_share[k], 0.0, 1.0);
  }
}

/// Variances that are none, and covariances that no variances have.
void check_covariance(const Source& source, const Calibration& calibration, std::size_t n) {
  const auto& entry = calibration.array.uncertainty().covariance;
  const auto at = [](std::size_t a, std::size_t b) { return a * (a + 1) / 2 + b; };
  const int line = source.line_of("covariance", "covariance");
  const double largest = kMostAcceleration_mps2 * kMostAcceleration_mps2;
  for (std::size_t a = 0; a < 4 * n; ++a) {
    const double variance = entry[at(a, a)];
    if (variance >= 0.0 && variance <= largest) continue;
    source.fail(line, "covariance[" + std::to_string(a + 1) + "][" + std::to_string(a + 1) + "]",
                "is " + shortest(variance) + ", but a variance must be from 0 to " + brief(largest), kMakeAnew);
  }
  for (std::size_t a = 0; a < 4 * n; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const double most = (1.0 + kRounding) * std::sqrt(entry[at(a, a)] * entry[at(b, b)]);
      if (std::fabs(entry[at(a, b)]) <= most) continue;
      source.fail(line, "covariance[" + std::to_string(a + 1) + "][" + std::to_string(b + 1) + "]",
                  "is " + shortest(entry[at(a, b)]) + ", but the variances allow at most " + brief(most), kMakeAnew);
    }
  }
}

/// The correlations of the parameters that are not exact, row by row; `which` receives their places.
std::vector<double> correlations(const Calibration& calibration, std::size_t n, std::vector<std::size_t>& which) {
  const auto& entry = calibration.array.uncertainty().covariance;
  const auto at = [](std::size_t a, std::size_t b) {
    return std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b);
  };
  for (std::size_t a = 0; a < 4 * n; ++a) {
    if (entry[at(a, a)] > 0.0) which.push_back(a);
  }
  std::vector<double> out;
  for (const std::size_t a : which) {
    for (const std::size_t b : which) out.push_back(entry[at(a, b)] / std::sqrt(entry[at(a, a)] * entry[at(b, b)]));
  }
  return out;
}

/// Every pair may be possible, and the whole none: a sum of the parameters would have a variance below zero.
void check_positive(const Source& source, const Calibration& calibration, std::size_t n) {
  std::vector<std::size_t> which;
  std::vector<double> matrix = correlations(calibration, n, which);
  if (which.empty()) return;
  const std::vector<double> kept = matrix;
  const int size = static_cast<int>(which.size());
  std::vector<double> values(which.size()), vectors(matrix.size());
  if (symmetric_eigenvalues(matrix.data(), size, size, values.data()) && values[0] >= -kRounding) return;
  matrix = kept;
  const bool told = symmetric_eigen(matrix.data(), size, size, values.data(), vectors.data());
  if (told && values[0] >= -kRounding) return;
  const int line = source.line_of("covariance", "covariance");
  if (!told) source.fail(line, "covariance", "has no eigenvalues", kMakeAnew);
  std::size_t most = 0;
  for (std::size_t a = 1; a < which.size(); ++a) {
    if (std::fabs(vectors[a * which.size()]) > std::fabs(vectors[most * which.size()])) most = a;
  }
  source.fail(line, "covariance",
              "is not positive semidefinite: its correlations have the eigenvalue " + brief(values[0]) +
                  ", most of it in row " + std::to_string(which[most] + 1) + " (" +
                  calibration.array.row(static_cast<int>(which[most] / 4)).id.data() + ")",
              kMakeAnew);
}

void check_context(const Source& source, const CalibrationContext& context) {
  const Check gravity(source, "gravity");
  const bool magnetic = context.gravity.model == GravityModel::magnetic;
  gravity.within("g_mps2", context.gravity.g_mps2, magnetic ? kLeastField : 9.0, magnetic ? kMostField : 10.5);
  gravity.within("sigma_mps2", context.gravity.sigma_mps2, 0.0, 0.1);
  Check(source, "provenance").within("stations", context.stations, 0.0, std::numeric_limits<int>::max());
}

}  // namespace

void check_content(const Source& source, const CalibrationFile& file) {
  const Calibration& calibration = file.calibration;
  const int n = calibration.array.size();
  check_report(Check(source, "report"), calibration.report, n);
  if (calibration.report.roll_groups != 0) check_roll(Check(source, "report.roll"), calibration.report);
  for (int i = 0; i < n; ++i) check_sensor(Check(source, "sensors", i + 1), calibration, i);
  for (const double m : calibration.model.misalignment)
    Check(source, "misalignment").within("m_ij", m, -kMostNumber, kMostNumber);
  Check(source, "").within("common_scale_sigma", calibration.array.uncertainty().common_scale, 0.0, 1.0);
  check_covariance(source, calibration, static_cast<std::size_t>(n));
  check_positive(source, calibration, static_cast<std::size_t>(n));
  check_context(source, file.context);
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
