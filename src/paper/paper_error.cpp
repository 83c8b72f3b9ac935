/// The paper's error of one station and its derivatives.
#include <cmath>
#include <limits>

#include "paper_points.hpp"
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
  std::array<double, kPaperCapacity> slope{};    ///< minus the derivative of the reading by SF
  std::array<double, kPaperCapacity> reading{};  ///< before the misalignment
  Vec3 x{};
  bool finite = true;
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
  if (!fit::usual(gravity.g_mps2)) return fail(Errc::out_of_range, 4, gravity.g_mps2, 0.0);
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

PaperError::Prepared PaperError::prepare(const PaperParameters& at) const noexcept {
  Prepared out;
  for (int j = 0; j < n_; ++j) {
    Vec3 column = map_[fit::at(j)];
    for (int i = 0; i < n_; ++i) {
      if (i != j) column = minus(column, scaled(map_[fit::at(i)], at[fit::at(misalignment(i, j))]));
    }
    const double factor = at[fit::at(n_ + j)];
    out.finite = out.finite && factor != 0.0;
    out.column[fit::at(j)] = column;
    out.ratio[fit::at(j)] = factor / nominal_[fit::at(j)].scale[0];
    out.inverse[fit::at(j)] = out.finite ? 1.0 / factor : 0.0;
    out.bias[fit::at(j)] = at[fit::at(j)];
  }
  return out;
}

/// Kept from one station to the next of the same temperature.
void PaperError::temper(double temperature_degc, Prepared& prepared) const noexcept {
  prepared.temperature_degc = temperature_degc;
  prepared.tempered = true;
  for (int i = 0; i < n_; ++i) {
    const SensorCoefficients& c = nominal_[fit::at(i)];
    const double t = temperature_degc - c.reference_degc;
    const double scale = fit::cubic(c.scale, t) * prepared.ratio[fit::at(i)];
    prepared.gain[fit::at(i)] = scale != 0.0 ? 1.0 / scale : kNan;
    prepared.drift[fit::at(i)] = prepared.bias[fit::at(i)] + (fit::cubic(c.bias, t) - c.bias[0]);
  }
}

PaperError::Point PaperError::point(Prepared& prepared, const Station& station) const noexcept {
  if (!prepared.tempered || prepared.temperature_degc != station.temperature_degc) {
    temper(station.temperature_degc, prepared);
  }
  Point p;
  p.finite = prepared.finite;
  Vec3 x{};
  for (int i = 0; i < n_; ++i) {
    const double gain = prepared.gain[fit::at(i)];
    p.finite = p.finite && !std::isnan(gain);
    const double direct = station.mean[fit::at(sensor_[fit::at(i)])] * gain;
    p.slope[fit::at(i)] = direct * prepared.inverse[fit::at(i)];
    p.reading[fit::at(i)] = direct - prepared.drift[fit::at(i)];
    x = plus(x, scaled(prepared.column[fit::at(i)], p.reading[fit::at(i)]));
  }
  p.x = x;
  return p;
}

/// Of |x|^2, in the order of the parameters.
void PaperError::derivatives(const Point& p, const Prepared& prepared, PaperParameters& gradient) const noexcept {
  const Vec3 w = scaled(p.x, -2.0);
  double* m = gradient.data() + fit::at(2 * n_);
  for (int i = 0; i < n_; ++i) {
    const double along = dot(prepared.column[fit::at(i)], w), row = dot(map_[fit::at(i)], w);
    gradient[fit::at(i)] = along;
    gradient[fit::at(n_ + i)] = along * p.slope[fit::at(i)];
    for (int j = 0; j < n_; ++j) {
      if (j != i) *m++ = row * p.reading[fit::at(j)];
    }
  }
}

double PaperError::operator()(const PaperParameters& at, const Station& station,
                              PaperParameters* gradient) const noexcept {
  Prepared prepared = prepare(at);
  const Point p = point(prepared, station);
  if (gradient != nullptr) {
    gradient->fill(0.0);
    if (p.finite) derivatives(p, prepared, *gradient);
  }
  return p.finite ? dot(p.x, p.x) - g_squared_ : kNan;
}

double PaperError::gauss_newton(const PaperParameters& at, const Station* stations, int count, double* matrix,
                                int stride, PaperParameters& gradient) const noexcept {
  using Four = Eigen::Array4d;
  const int size = parameters();
  for (int k = 0; k < size * stride; ++k) matrix[k] = 0.0;
  gradient.fill(0.0);
  PaperParameters slope{};
  Prepared prepared = prepare(at);
  double sum = 0.0;
  int used = 0;
  for (int s = 0; s < (stations == nullptr ? 0 : count); ++s) {
    if (!usable(stations[s])) continue;
    const Point p = point(prepared, stations[s]);
    if (!p.finite) return kNan;
    const double e = dot(p.x, p.x) - g_squared_;
    derivatives(p, prepared, slope);
    for (int a = 0; a < size; a += 4) Four::Map(gradient.data() + a) += e * Four::Map(slope.data() + a);
    paper::add_square(slope.data(), size, matrix, stride);
    sum += e * e;
    ++used;
  }
  return used > 0 ? sum / used : kNan;
}

void PaperError::add_curvature(const PaperParameters& at, const Station& station, double weight,
                               double* matrix) const noexcept {
  Prepared prepared = prepare(at);
  const Point p = point(prepared, station);
  if (!p.finite) return;
  const int count = parameters();
  // Derivatives of x, in the order of the parameters.
  std::array<Vec3, kPaperParameters> d{};
  for (int i = 0; i < n_; ++i) {
    d[fit::at(i)] = scaled(prepared.column[fit::at(i)], -1.0);
    d[fit::at(n_ + i)] = scaled(prepared.column[fit::at(i)], -p.slope[fit::at(i)]);
    for (int j = 0; j < n_; ++j) {
      if (j != i) d[fit::at(misalignment(i, j))] = scaled(map_[fit::at(i)], -p.reading[fit::at(j)]);
    }
  }
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b <= a; ++b) matrix[a * count + b] += 2.0 * weight * dot(d[fit::at(a)], d[fit::at(b)]);
  }
  // x is linear in each parameter but SF, and its mixed derivatives pair m_ij with what sensor j alone has.
  const Vec3 w = scaled(p.x, 2.0 * weight);
  for (int j = 0; j < n_; ++j) {
    const double slope = p.slope[fit::at(j)];
    const int scale = n_ + j;
    matrix[scale * count + scale] += 2.0 * dot(w, prepared.column[fit::at(j)]) * slope / at[fit::at(scale)];
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
  Prepared prepared = prepare(at);
  double sum = 0.0;
  int used = 0;
  for (int k = 0; k < (stations == nullptr ? 0 : count); ++k) {
    if (!usable(stations[k])) continue;
    const Point p = point(prepared, stations[k]);
    const double error = p.finite ? dot(p.x, p.x) - g_squared_ : kNan;
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
