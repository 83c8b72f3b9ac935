/// The paper's error of one station and its derivatives.
#include <cmath>
#include <limits>

#include "fit_internal.hpp"
#include "plumb/calibration/paper_calibration.hpp"
#include "plumb/numeric/symmetric_eigen.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace {

using fit::at;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double least_singular_value(const fit::Symmetric3& m) noexcept {
  std::array<double, 9> a = {m[0], m[1], m[2], m[1], m[3], m[4], m[2], m[4], m[5]};
  std::array<double, 9> vectors{};
  std::array<double, 3> values{};
  if (!symmetric_eigen(a.data(), 3, 3, values.data(), vectors.data())) return 0.0;
  return values[0] > 0.0 ? std::sqrt(values[0]) : 0.0;
}

Error check_sensor(const DatasheetSensor& s, int i) noexcept {
  const std::array<double, 3> prior = {s.prior.bias_mps2, s.prior.scale, s.prior.axis_rad};
  double sum = 0.0;
  for (const double v : s.row.axis) sum += v;
  for (const double v : s.coefficients.scale) sum += v;
  for (const double v : s.coefficients.bias) sum += v;
  for (const double v : prior) sum += v;
  sum += s.coefficients.reference_degc;
  if (!std::isfinite(sum) || s.coefficients.scale[0] == 0.0) return Error{Errc::not_finite, i, sum, 0.0};
  for (const double v : prior) {
    if (!(v >= 0.0)) return Error{Errc::out_of_range, 5, v, 0.0};
  }
  return Error{};
}

}  // namespace

/// What the error and its derivatives have in common at one station.
struct PaperError::Point {
  std::array<double, kPaperCapacity> direct{};   ///< V / SF*
  std::array<double, kPaperCapacity> slope{};    ///< -d(direct)/dSF
  std::array<double, kPaperCapacity> reading{};  ///< before the misalignment
  std::array<Vec3, kPaperCapacity> column{};     ///< of map (I - m)
  Vec3 x{};
  bool finite = true;

  /// Derivatives of x, in the order of the parameters.
  std::array<Vec3, kPaperParameters> derivatives(const PaperError& error) const noexcept {
    std::array<Vec3, kPaperParameters> d{};
    const int n = error.n_;
    for (int i = 0; i < n; ++i) {
      d[fit::at(i)] = scaled(column[fit::at(i)], -1.0);
      d[fit::at(n + i)] = scaled(column[fit::at(i)], -slope[fit::at(i)]);
      for (int j = 0; j < n; ++j) {
        if (j == i) continue;
        d[fit::at(error.misalignment(i, j))] = scaled(error.map_[fit::at(i)], -reading[fit::at(j)]);
      }
    }
    return d;
  }
};

Expected<PaperError> PaperError::make(const Datasheet& datasheet, const GravityReference& gravity,
                                      SensorSet used) noexcept {
  const int n = used.size();
  if (n < 3) return fail(Errc::too_few_sensors, -1, n, 3.0);
  if (n > kPaperCapacity || datasheet.size > kCapacity) {
    return fail(Errc::too_many_sensors, -1, n > kPaperCapacity ? n : datasheet.size,
                n > kPaperCapacity ? kPaperCapacity : kCapacity);
  }
  if (!SensorSet::first(datasheet.size).contains(used)) return fail(Errc::out_of_range, 3, n, datasheet.size);
  if (!(gravity.g_mps2 > 0.0) || !std::isfinite(gravity.g_mps2)) {
    return fail(Errc::out_of_range, 4, gravity.g_mps2, 0.0);
  }
  PaperError out;
  out.n_ = n;
  out.used_ = used;
  out.g_squared_ = gravity.g_mps2 * gravity.g_mps2;
  fit::Symmetric3 square{};
  int k = 0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!used.has(i)) continue;
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const Error wrong = check_sensor(s, i);
    if (wrong.code != Errc::ok) return tl::unexpected<Error>(wrong);
    out.sensor_[at(k)] = i;
    out.nominal_[at(k)] = s.coefficients;
    out.map_[at(k)] = s.row.axis;
    fit::add_outer(square, s.row.axis, 1.0);
    out.start_[at(k)] = s.coefficients.bias[0];
    out.start_[at(n + k)] = s.coefficients.scale[0];
    out.prior_[at(k)] = s.prior.bias_mps2;
    out.prior_[at(n + k)] = s.prior.scale * std::fabs(s.coefficients.scale[0]);
    for (int j = 0; j < n - 1; ++j) out.prior_[at(2 * n + k * (n - 1) + j)] = s.prior.axis_rad;
    ++k;
  }
  const double least = least_singular_value(square);
  if (!(least >= kPaperMinSingular)) return fail(Errc::axes_rank_deficient, -1, least, kPaperMinSingular);
  for (int i = 0; i < n; ++i) out.map_[at(i)] = fit::solve(square, out.map_[at(i)]);
  return out;
}

PaperError::Point PaperError::point(const PaperParameters& at, const Station& station) const noexcept {
  Point p;
  for (int i = 0; i < n_; ++i) {
    const SensorCoefficients& c = nominal_[fit::at(i)];
    const double t = station.temperature_degc - c.reference_degc;
    const double factor = at[fit::at(n_ + i)];
    const double scale = fit::cubic(c.scale, t) * (factor / c.scale[0]);
    if (scale == 0.0 || factor == 0.0) {
      p.finite = false;
      return p;
    }
    p.direct[fit::at(i)] = station.mean[fit::at(sensor_[fit::at(i)])] / scale;
    p.slope[fit::at(i)] = p.direct[fit::at(i)] / factor;
    p.reading[fit::at(i)] = p.direct[fit::at(i)] - at[fit::at(i)] - (fit::cubic(c.bias, t) - c.bias[0]);
  }
  for (int j = 0; j < n_; ++j) {
    Vec3 column = map_[fit::at(j)];
    for (int i = 0; i < n_; ++i) {
      if (i != j) column = minus(column, scaled(map_[fit::at(i)], at[fit::at(misalignment(i, j))]));
    }
    p.column[fit::at(j)] = column;
    p.x = plus(p.x, scaled(column, p.reading[fit::at(j)]));
  }
  return p;
}

double PaperError::operator()(const PaperParameters& at, const Station& station,
                              PaperParameters* gradient) const noexcept {
  const Point p = point(at, station);
  if (gradient != nullptr) {
    gradient->fill(0.0);
    const std::array<Vec3, kPaperParameters> d = p.derivatives(*this);
    for (int k = 0; k < parameters(); ++k) (*gradient)[fit::at(k)] = 2.0 * dot(d[fit::at(k)], p.x);
  }
  return p.finite ? dot(p.x, p.x) - g_squared_ : kNan;
}

void PaperError::add_curvature(const PaperParameters& at, const Station& station, double weight,
                               double* matrix) const noexcept {
  const Point p = point(at, station);
  if (!p.finite) return;
  const int count = parameters();
  const std::array<Vec3, kPaperParameters> d = p.derivatives(*this);
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b <= a; ++b) matrix[a * count + b] += 2.0 * weight * dot(d[fit::at(a)], d[fit::at(b)]);
  }
  // x is linear in each parameter but SF, and its mixed derivatives pair m_ij with what sensor j alone has.
  const Vec3 w = scaled(p.x, 2.0 * weight);
  for (int j = 0; j < n_; ++j) {
    const double slope = p.slope[fit::at(j)];
    const int scale = n_ + j;
    matrix[scale * count + scale] += 2.0 * dot(w, p.column[fit::at(j)]) * slope / at[fit::at(scale)];
    for (int i = 0; i < n_; ++i) {
      if (i == j) continue;
      const int m = misalignment(i, j);
      const double along = dot(w, map_[fit::at(i)]);
      matrix[m * count + j] += along;
      matrix[m * count + scale] += along * slope;
    }
  }
}

double PaperError::cost(const PaperParameters& at, const Station* stations, int count) const noexcept {
  double sum = 0.0;
  int used = 0;
  for (int k = 0; k < (stations == nullptr ? 0 : count); ++k) {
    if (!usable(stations[k])) continue;
    const double error = (*this)(at, stations[k]);
    sum += error * error;
    ++used;
  }
  return used > 0 ? sum / used : kNan;
}

void PaperError::store(const PaperParameters& at, SensorModel& model) const noexcept {
  for (int i = 0; i < n_; ++i) {
    const int row = sensor_[fit::at(i)];
    SensorCoefficients& c = model.sensor[fit::at(row)];
    c = nominal_[fit::at(i)];
    const double ratio = at[fit::at(n_ + i)] / c.scale[0];
    for (double& term : c.scale) term *= ratio;
    c.scale[0] = at[fit::at(n_ + i)];
    c.bias[0] = at[fit::at(i)];
    for (int j = 0; j < n_; ++j) {
      if (j != i) model.misalignment[fit::at(row * kCapacity + sensor_[fit::at(j)])] = at[fit::at(misalignment(i, j))];
    }
  }
}

Vec3 paper_vector(const SensorArray& nominal, const PaperFit& fit, const std::array<double, kCapacity>& raw,
                  double temperature_degc, SensorSet of) noexcept {
  const SensorSet read = fit.used & of;
  const Readings y = fit.model.apply(raw, temperature_degc, read);
  fit::Symmetric3 square{};
  Vec3 sum{};
  for (int i = 0; i < nominal.size(); ++i) {
    if (!read.has(i)) continue;
    fit::add_outer(square, nominal.axis(i), 1.0);
    sum = plus(sum, scaled(nominal.axis(i), y[at(i)]));
  }
  return fit::solve(square, sum);
}

Vec3 paper_vector(const SensorArray& nominal, const PaperFit& fit, const std::array<double, kCapacity>& raw,
                  double temperature_degc) noexcept {
  return paper_vector(nominal, fit, raw, temperature_degc, fit.used);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
