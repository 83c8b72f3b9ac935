/// One station: which rows it has, and the direction of gravity that explains them.
#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace fit {
namespace {

/// Newton on the sphere settles quadratically: after a step below this (squared) the error is about 1e-8 rad,
/// and the residuals, projected across the tangents, feel its square.
constexpr int kDirectionSteps = 8;
constexpr double kDirectionStop = 1e-8;

/// det(H'H) of the rows of a station, relative to equal axes: |det| of a triple above about 1e-3.
constexpr double kIndependent = 1e-6;

struct Tangents {
  Vec3 first{};
  Vec3 second{};
  double s11 = 0.0, s12 = 0.0, s22 = 0.0;  ///< of the information about the vector
};

/// Orthonormal tangents of the unit sphere without a root or a case distinction (Duff et al. 2017).
inline Tangents tangents_at(const Vec3& u, const Symmetric3& h) noexcept {
  Tangents t;
  const double sign = std::copysign(1.0, u[2]);
  const double a = -1.0 / (sign + u[2]);
  const double b = u[0] * u[1] * a;
  t.first = {1.0 + sign * u[0] * u[0] * a, sign * b, -sign * u[0]};
  t.second = {b, sign + u[1] * u[1] * a, -u[1]};
  const Vec3 h1 = times(h, t.first), h2 = times(h, t.second);
  t.s11 = dot(t.first, h1);
  t.s12 = dot(t.first, h2);
  t.s22 = dot(t.second, h2);
  return t;
}

/// Unit vector u that minimises (G u)' h (G u) / 2 - c' G u, from the direction of `start`.
inline Vec3 best_direction(const Symmetric3& h, const Vec3& c, const Vec3& start, double g_mps2) noexcept {
  Vec3 u = scaled(start, 1.0 / norm(start));
  for (int step = 0; step < kDirectionSteps; ++step) {
    const Vec3 down = minus(c, times(h, scaled(u, g_mps2)));
    const Tangents t = tangents_at(u, h);
    double a = t.s11, d = t.s22;
    // Curvature of the sphere. Left out where it would spoil the convexity: plain Gauss-Newton then.
    const double curvature = dot(u, down) / g_mps2;
    const double determinant = a * d - t.s12 * t.s12;
    if (curvature > -0.5 * determinant / (a + d)) {
      a += curvature;
      d += curvature;
    }
    const double scale = 1.0 / ((a * d - t.s12 * t.s12) * g_mps2);
    const double p = dot(t.first, down), q = dot(t.second, down);
    const double alpha = (d * p - t.s12 * q) * scale;
    const double beta = (a * q - t.s12 * p) * scale;
    const Vec3 moved = plus(u, plus(scaled(t.first, alpha), scaled(t.second, beta)));
    u = scaled(moved, 1.0 / norm(moved));
    if (!(alpha * alpha + beta * beta > kDirectionStop)) break;
  }
  return u;
}

/// Images W t of the tangents, weighted and made orthonormal in the whitened space.
inline void set_tangents(const StationRows& rows, const Parameters& theta, const Tangents& t,
                         StationFit& out) noexcept {
  const double first = 1.0 / std::sqrt(t.s11);
  const double shear = t.s12 / t.s11;
  const double rest = t.s22 - t.s12 * shear;
  const double second = 1.0 / std::sqrt(rest);
  for (int k = 0; k < rows.rows; ++k) {
    const Vec3 w = row_of(theta, rows.sensor[at(k)]);
    const double u1 = dot(w, t.first);
    const double u2 = dot(w, t.second) - shear * u1;
    out.tangent1[at(k)] = rows.weight[at(k)] * u1 * first;
    out.tangent2[at(k)] = rows.weight[at(k)] * u2 * second;
  }
}

}  // namespace

bool independent(const Datasheet& datasheet, SensorSet delivered) noexcept {
  Symmetric3 h{};
  int rows = 0;
  for (int i = 0; i < datasheet.size; ++i) {
    if (!delivered.has(i)) continue;
    add_outer(h, datasheet.sensor[at(i)].row.axis, 1.0);
    ++rows;
  }
  const double mean = static_cast<double>(rows) / 3.0;
  return rows >= 3 && det(h) > kIndependent * mean * mean * mean;
}

int usable_stations(const Problem& problem) noexcept {
  int usable = 0;
  for (int s = 0; s < problem.count; ++s) {
    const SensorSet delivered = problem.stations[s].delivered & SensorSet::first(problem.datasheet.size);
    if (problem.stations[s].count > 0 && independent(problem.datasheet, delivered)) ++usable;
  }
  return usable;
}

Loaded load_rows(const Datasheet& datasheet, const Station& station, double misfit_variance,
                 StationRows& rows) noexcept {
  rows.rows = 0;
  if (station.count == 0) return Loaded::skipped;
  const SensorSet all = SensorSet::first(datasheet.size);
  const SensorSet delivered = station.delivered & all;
  if (delivered != all && !independent(datasheet, delivered)) return Loaded::skipped;
  const double sign = datasheet.reads == Reads::gravity ? 1.0 : -1.0;
  const double share = 1.0 / static_cast<double>(station.count);
  for (int i = 0; i < datasheet.size; ++i) {
    if (!delivered.has(i)) continue;
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const double t = station.temperature_degc - s.coefficients.reference_degc;
    const double scale = cubic(s.coefficients.scale, t);
    if (scale == 0.0) return Loaded::not_finite;
    const double reading = sign * (station.mean[at(i)] / scale - cubic(s.coefficients.bias, t));
    const double weight = 1.0 / (s.row.sigma_mps2 * s.row.sigma_mps2 * share + misfit_variance);
    if (!std::isfinite(reading) || !std::isfinite(weight)) return Loaded::not_finite;
    const std::size_t k = at(rows.rows++);
    rows.sensor[k] = i;
    rows.reading[k] = reading;
    rows.weight[k] = weight;
  }
  return Loaded::used;
}

void fit_station(const StationRows& rows, const Parameters& theta, double g_mps2, StationFit& out) noexcept {
  Symmetric3 h{};
  Vec3 c{};
  for (int k = 0; k < rows.rows; ++k) {
    const int i = rows.sensor[at(k)];
    const Vec3 w = row_of(theta, i);
    add_outer(h, w, rows.weight[at(k)]);
    c = plus(c, scaled(w, rows.weight[at(k)] * (rows.reading[at(k)] - theta[at(4 * i + 3)])));
  }
  out.estimate = solve(h, c);
  const double length = norm(out.estimate);
  out.finite = std::isfinite(length) && length > 0.0;
  if (!out.finite) return;
  const Vec3 u = best_direction(h, c, out.estimate, g_mps2);
  out.gravity = scaled(u, g_mps2);
  const Tangents t = tangents_at(u, h);
  set_tangents(rows, theta, t, out);
  out.direction_variance = (t.s11 + t.s22) / ((t.s11 * t.s22 - t.s12 * t.s12) * g_mps2 * g_mps2);
  out.chi2 = 0.0;
  for (int k = 0; k < rows.rows; ++k) {
    const int i = rows.sensor[at(k)];
    const double e = rows.reading[at(k)] - dot(row_of(theta, i), out.gravity) - theta[at(4 * i + 3)];
    out.residual[at(k)] = e;
    out.chi2 += rows.weight[at(k)] * e * e;
  }
  out.finite = std::isfinite(out.chi2) && std::isfinite(out.direction_variance);
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
