#include "plumb/findings/frame_turn.hpp"

#include <cmath>

#include "plumb/numeric/tails.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace findings {
namespace {

/// Axes are known no better than this, those that a fit holds included: a weight must be finite.
constexpr double kSurest_rad = 1e-6;

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

void add_across(const Vec3& d, double weight, TurnInformation& form) noexcept {
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) form[3 * r + c] += weight * ((r == c ? 1.0 : 0.0) - d[r] * d[c]);
  }
}

/// The shortest turn from one direction to another.
Vec3 turn_between(const Vec3& from, const Vec3& to) noexcept {
  const Vec3 across = cross(from, to);
  const double sine = norm(across);
  return sine > 0.0 ? scaled(across, std::atan2(sine, dot(from, to)) / sine) : Vec3{};
}

/// Rodrigues' formula.
Mat3 matrix_of(const Vec3& turn) noexcept {
  const double angle = norm(turn);
  if (!(angle > 0.0)) return io::kIdentity3;
  const Vec3 u = scaled(turn, 1.0 / angle);
  const double s = std::sin(angle), c = std::cos(angle);
  Mat3 out = {c, -s * u[2], s * u[1], s * u[2], c, -s * u[0], -s * u[1], s * u[0], c};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t k = 0; k < 3; ++k) out[3 * r + k] += (1.0 - c) * u[r] * u[k];
  }
  return out;
}

std::size_t packed(std::size_t a, std::size_t b) noexcept { return a >= b ? a * (a + 1) / 2 + b : b * (b + 1) / 2 + a; }

/// The covariance of the rows of two sensors, each with its bias behind its three components.
void turn_block(const Mat3& turn, std::size_t i, std::size_t j, RowUncertainty& u) noexcept {
  double block[4][4] = {}, half[4][4] = {};
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) block[p][q] = u.covariance[packed(4 * i + p, 4 * j + q)];
  }
  const auto entry = [&turn](std::size_t p, std::size_t q) {
    return p < 3 && q < 3 ? turn[3 * p + q] : (p == q ? 1.0 : 0.0);
  };
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) {
      for (std::size_t k = 0; k < 4; ++k) half[p][q] += entry(p, k) * block[k][q];
    }
  }
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) {
      if (i == j && q > p) continue;
      double sum = 0.0;
      for (std::size_t k = 0; k < 4; ++k) sum += half[p][k] * entry(q, k);
      u.covariance[packed(4 * i + p, 4 * j + q)] = sum;
    }
  }
}

}  // namespace

TurnInformation information_of_axes(const Datasheet& datasheet) noexcept {
  TurnInformation out{};
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& sensor = datasheet.sensor[at(i)];
    const double sigma = std::fmax(sensor.prior.axis_rad, kSurest_rad);
    add_across(sensor.row.axis, 1.0 / (sigma * sigma), out);
  }
  return out;
}

TurnInformation information_of(const Datasheet& datasheet, const FitReport* fit) noexcept {
  const TurnInformation axes = information_of_axes(datasheet);
  if (fit == nullptr || !(norm(fit->roll_axis) > 0.0)) return axes;
  const Vec3& r = fit->roll_axis;
  const double sigma = std::fmax(std::hypot(fit->inclination_sigma_rad, fit->roll_axis_deviation_rad), kSurest_rad);
  const double about = dot(r, times(axes, r));
  TurnInformation out{};
  add_across(r, 1.0 / (sigma * sigma), out);
  for (std::size_t p = 0; p < 3; ++p) {
    for (std::size_t q = 0; q < 3; ++q) out[3 * p + q] += about * r[p] * r[q];
  }
  return out;
}

Vec3 solved(const TurnInformation& m, const Vec3& v) noexcept {
  const Vec3 a = {m[0], m[1], m[2]}, b = {m[3], m[4], m[5]}, c = {m[6], m[7], m[8]};
  const double d = det3(a, b, c);
  if (!(d > 0.0)) return {};
  // By cofactors: the matrix is symmetric.
  return scaled({dot(cross(b, c), v), dot(cross(c, a), v), dot(cross(a, b), v)}, 1.0 / d);
}

Vec3 turn_from_datasheet(const Datasheet& datasheet, const SensorArray& fitted) noexcept {
  Vec3 moment{};
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& sensor = datasheet.sensor[at(i)];
    const double sigma = std::fmax(sensor.prior.axis_rad, kSurest_rad);
    moment = plus(moment, scaled(turn_between(sensor.row.axis, fitted.axis(i)), 1.0 / (sigma * sigma)));
  }
  return solved(information_of_axes(datasheet), moment);
}

Mat3 turn_into_housing(const io::ArrayFile& array, const FitReport& fit,
                       const std::vector<MeasuredAttitude>& measured) noexcept {
  if (measured.empty()) return io::kIdentity3;
  const TurnInformation known = information_of(array.datasheet, &fit);
  TurnInformation sum = known;
  Vec3 moment{};
  // For q, the axis times the tangent of half the angle, `stated - shown = q x (stated + shown)` is exact.
  for (const MeasuredAttitude& m : measured) {
    const Vec3 stated = io::down_of(m.stated, array.output_frame), shown = scaled(m.down, 1.0 / norm(m.down));
    const Vec3 both = plus(stated, shown);
    const double length = norm(both);
    if (!(length > 0.0)) return io::kIdentity3;
    const Vec3 between = scaled(both, 1.0 / length);
    const double weight = 4.0 / (m.stated.tolerance_rad * m.stated.tolerance_rad);  // half a tolerance is a sigma
    add_across(between, weight, sum);
    moment = plus(moment, scaled(cross(between, minus(stated, shown)), weight / length));
  }
  const Vec3 q = solved(sum, moment);
  const double tangent = norm(q);
  const Vec3 turn = tangent > 0.0 ? scaled(q, 2.0 * std::atan(tangent) / tangent) : Vec3{};
  const bool excluded = dot(turn, times(known, turn)) > chi2_tail_quantile(array.monitor.integrity_risk, 3);
  return excluded ? io::kIdentity3 : matrix_of(turn);
}

void apply_turn(const Mat3& turn, Calibration& calibration) noexcept {
  const int n = calibration.array.size();
  std::array<SensorRow, kCapacity> rows{};
  RowUncertainty uncertainty = calibration.array.uncertainty();
  for (int i = 0; i < n; ++i) {
    rows[at(i)] = calibration.array.row(i);
    const Vec3 axis = times(turn, rows[at(i)].axis);
    rows[at(i)].axis = scaled(axis, 1.0 / norm(axis));
    for (int j = 0; j <= i; ++j) turn_block(turn, at(i), at(j), uncertainty);
  }
  (void)calibration.array.set_rows(rows.data());  // as sound as they were: the angles between them are the same
  calibration.array.set_uncertainty(uncertainty);
}

}  // namespace findings
}  // namespace PLUMB_ABI
}  // namespace plumb
