#include "plumb/health/detail/held_axis.hpp"

#include <cmath>

#include "plumb/core/detail/numbers.hpp"
#include "plumb/numeric/cholesky.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace {

constexpr int kFitted = 2 * kCapacity;  ///< scale, bias per sensor
constexpr int kHeld = 3 * kCapacity;    ///< axis error per sensor, its part along the axis without effect

/// AxisSums over the stations of the fit, of the fitted sensors in the order of the array.
struct AxisSums {
  int k = 0;
  std::array<int, kCapacity> sensor{};
  std::array<double, std::size_t{kFitted} * kFitted> fitted{};  ///< F'MF, stride kFitted
  std::array<double, std::size_t{kFitted} * kHeld> cross{};     ///< F'MA, stride kHeld
};

/// What one station tells: M = W - W A (A'WA)^-1 A'W with A the images of two directions across gravity.
[[gnu::noinline]] void add_axis_station(const SensorArray& array, const HeldAxisFit& fit, const Vec3& u, double g_mps2,
                                        AxisSums& sums) noexcept {
  const Vec3 aside = std::fabs(u[2]) < 0.8 ? Vec3{0.0, 0.0, 1.0} : Vec3{1.0, 0.0, 0.0};
  const Vec3 across = cross(u, aside);
  const Vec3 first = scaled(across, 1.0 / norm(across));
  const Vec3 second = cross(u, first);
  std::array<double, kCapacity> weight{}, a{}, b{}, along{};
  double aa = 0.0, ab = 0.0, bb = 0.0;
  for (int i = 0; i < sums.k; ++i) {
    const int s = sums.sensor[at(i)];
    weight[at(i)] = 1.0 / (fit.sigma_mps2[at(s)] * fit.sigma_mps2[at(s)]);
    a[at(i)] = dot(array.axis(s), first);
    b[at(i)] = dot(array.axis(s), second);
    along[at(i)] = dot(array.axis(s), u) * g_mps2;
    aa += weight[at(i)] * a[at(i)] * a[at(i)];
    ab += weight[at(i)] * a[at(i)] * b[at(i)];
    bb += weight[at(i)] * b[at(i)] * b[at(i)];
  }
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > 0.0)) return;
  for (int i = 0; i < sums.k; ++i) {
    const double pa = (bb * a[at(i)] - ab * b[at(i)]) / determinant;
    const double pb = (aa * b[at(i)] - ab * a[at(i)]) / determinant;
    for (int l = 0; l < sums.k; ++l) {
      double m = -weight[at(i)] * weight[at(l)] * (pa * a[at(l)] + pb * b[at(l)]);
      if (i == l) m += weight[at(i)];
      const double f[2] = {along[at(i)] * m, m};
      const Vec3 held = minus(scaled(u, g_mps2), scaled(array.axis(sums.sensor[at(l)]), along[at(l)]));
      for (int p = 0; p < 2; ++p) {
        sums.fitted[at((2 * i + p) * kFitted + 2 * l)] += f[p] * along[at(l)];
        sums.fitted[at((2 * i + p) * kFitted + 2 * l + 1)] += f[p];
        for (int q = 0; q < 3; ++q) sums.cross[at((2 * i + p) * kHeld + 3 * l + q)] += f[p] * held[at(q)];
      }
    }
  }
}

/// Turns F'MF into the covariance of the fit and F'MA into how far a held axis bends it; false where it cannot be.
[[gnu::noinline]] bool solve_axis(const HeldAxisFit& fit, AxisSums& sums) noexcept {
  const int rows = 2 * sums.k;
  for (int i = 0; i < sums.k; ++i) {
    const HeldPrior& prior = fit.prior[at(sums.sensor[at(i)])];
    sums.fitted[at(2 * i * (kFitted + 1))] += 1.0 / (prior.scale * prior.scale);
    sums.fitted[at((2 * i + 1) * (kFitted + 1))] += 1.0 / (prior.bias_mps2 * prior.bias_mps2);
  }
  if (!cholesky_factor(sums.fitted.data(), rows, kFitted)) return false;
  std::array<double, kFitted> column{};
  for (int c = 0; c < 3 * sums.k; ++c) {
    for (int r = 0; r < rows; ++r) column[at(r)] = sums.cross[at(r * kHeld + c)];
    cholesky_solve(sums.fitted.data(), rows, kFitted, column.data());
    for (int r = 0; r < rows; ++r) sums.cross[at(r * kHeld + c)] = -column[at(r)];
  }
  cholesky_inverse(sums.fitted.data(), rows, kFitted);
  return true;
}

/// Old errors that make up the new one of a parameter, dense over the 4n of the array.
using Line = std::array<double, std::size_t{4} * kCapacity>;

/// Row of T for component p (0..2 axis, 3 bias) of sensor s; `i` its place among the fitted ones, -1 for none.
Line line_of(const SensorArray& array, const AxisSums& sums, int s, int i, int p) noexcept {
  Line t{};
  if (i < 0) {
    t[at(4 * s + p)] = 1.0;
    return t;
  }
  const Vec3& h = array.axis(s);
  const int row = 2 * i + (p == 3 ? 1 : 0);
  const double factor = p == 3 ? 1.0 : h[at(p)];
  for (int l = 0; l < sums.k; ++l) {
    for (int q = 0; q < 3; ++q) {
      t[at(4 * sums.sensor[at(l)] + q)] = factor * sums.cross[at(row * kHeld + 3 * l + q)];
    }
  }
  for (int q = 0; q < 3 && p < 3; ++q) t[at(4 * s + q)] += (p == q ? 1.0 : 0.0) - h[at(p)] * h[at(q)];
  return t;
}

/// Covariance of the fitted parameters p and q without the held axes. The weights count those axes as if they were
/// noise, which they are not: of F'MF + P = A only the share that is noise comes back, and the prior.
double fit_covariance(const HeldAxisFit& fit, const AxisSums& sums, int p, int q) noexcept {
  double from_prior = 0.0;
  for (int m = 0; m < 2 * sums.k; ++m) {
    const HeldPrior& prior = fit.prior[at(sums.sensor[at(m / 2)])];
    const double sigma = m % 2 == 0 ? prior.scale : prior.bias_mps2;
    from_prior += sums.fitted[at(p * kFitted + m)] * sums.fitted[at(q * kFitted + m)] / (sigma * sigma);
  }
  return fit.inflation * (fit.noise_share * sums.fitted[at(p * kFitted + q)] + (1.0 - fit.noise_share) * from_prior);
}

/// What of a common scale the prior keeps back, and what it makes of it instead: (F'MF + P)^-1 P e, e all scales.
using Kept = std::array<double, kFitted>;
Kept kept_back(const HeldAxisFit& fit, const AxisSums& sums) noexcept {
  Kept out{};
  for (int p = 0; p < 2 * sums.k; ++p) {
    for (int i = 0; i < sums.k; ++i) {
      const double sigma = fit.prior[at(sums.sensor[at(i)])].scale;
      out[at(p)] += sums.fitted[at(p * kFitted + 2 * i)] / (sigma * sigma);
    }
  }
  return out;
}

double entry(const RowUncertainty& u, int a, int b) noexcept {
  return a >= b ? u.covariance[at(a * (a + 1) / 2 + b)] : u.covariance[at(b * (b + 1) / 2 + a)];
}

/// 1 sigma of the scale that all rows share, in every number of theirs.
Line common_scale_of(const SensorArray& array) noexcept {
  Line out{};
  for (int a = 0; a < 4 * array.size(); ++a)
    out[at(a)] = a % 4 < 3 ? array.uncertainty().common_scale * array.axis(a / 4)[at(a % 4)] : 0.0;
  return out;
}

/// Not inlined, nor is the next: neither needs its room while the other works.
[[gnu::noinline]] void add_stations(const SensorArray& array, const HeldAxisFit& fit, double g_mps2,
                                    AxisSums& sums) noexcept {
  for (int i = 0; i < array.size(); ++i) {
    if (fit.sensors.has(i)) sums.sensor[at(sums.k++)] = i;
  }
  for (int k = 0; k < fit.count; ++k) {
    if (fit.left_out > 0 && k % fit.left_out == fit.left_out - 1) continue;
    add_axis_station(array, fit, fit.station[k].direction, g_mps2, sums);
  }
}

/// The covariance of the rows that the fit leaves, from the solved sums.
[[gnu::noinline]] void write_uncertainty(const SensorArray& array, const GravityReference& gravity,
                                         const HeldAxisFit& fit, const AxisSums& sums,
                                         RowUncertainty& uncertainty) noexcept {
  std::array<int, kCapacity> place{};
  place.fill(-1);
  for (int i = 0; i < sums.k; ++i) place[at(sums.sensor[at(i)])] = i;
  const double common = gravity.sigma_mps2 / gravity.g_mps2;
  const Kept kept = kept_back(fit, sums);
  const RowUncertainty& old = array.uncertainty();
  const Line shared = common_scale_of(array);
  for (int a = 0; a < 4 * array.size(); ++a) {
    const int i = place[at(a / 4)];
    const Line line = line_of(array, sums, a / 4, i, a % 4);
    Line carried{};
    double along = 0.0;
    for (int d = 0; d < 4 * array.size(); ++d) along += shared[at(d)] * line[at(d)];
    for (int c = 0; c < 4 * array.size(); ++c) {
      carried[at(c)] = shared[at(c)] * along;
      for (int d = 0; d < 4 * array.size(); ++d) carried[at(c)] += entry(old, c, d) * line[at(d)];
    }
    for (int b = 0; b <= a; ++b) {
      const int l = place[at(b / 4)];
      const Line other = line_of(array, sums, b / 4, l, b % 4);
      double sum = 0.0;
      for (int c = 0; c < 4 * array.size(); ++c) sum += other[at(c)] * carried[at(c)];
      if (i >= 0 && l >= 0) {
        const int p = 2 * i + (a % 4 == 3 ? 1 : 0), q = 2 * l + (b % 4 == 3 ? 1 : 0);
        const double of_a = a % 4 == 3 ? 1.0 : array.axis(a / 4)[at(a % 4)];
        const double of_b = b % 4 == 3 ? 1.0 : array.axis(b / 4)[at(b % 4)];
        // Of the length of now the prior keeps a part back; that part of the length that it was made with it keeps.
        const double now = ((p % 2 == 0 ? 1.0 : 0.0) - kept[at(p)]) * ((q % 2 == 0 ? 1.0 : 0.0) - kept[at(q)]);
        const double then = kept[at(p)] * kept[at(q)];
        sum += of_a * of_b * (fit_covariance(fit, sums, p, q) + common * common * (now + then));
      }
      uncertainty.covariance[at(a * (a + 1) / 2 + b)] = sum;
    }
  }
  uncertainty.misfit_mps2 = array.uncertainty().misfit_mps2;
  uncertainty.common_scale = 0.0;  // the rows no longer share it alike
}

}  // namespace

bool held_axis_uncertainty(const SensorArray& array, const GravityReference& gravity, const HeldAxisFit& fit,
                           RowUncertainty& uncertainty, std::array<double, kCapacity>& data_share) noexcept {
  AxisSums sums;
  add_stations(array, fit, gravity.g_mps2, sums);
  if (!solve_axis(fit, sums)) return false;
  data_share.fill(0.0);
  for (int i = 0; i < sums.k; ++i) {
    const HeldPrior& prior = fit.prior[at(sums.sensor[at(i)])];
    const double scale = sums.fitted[at(2 * i * (kFitted + 1))] / (prior.scale * prior.scale);
    const double bias = sums.fitted[at((2 * i + 1) * (kFitted + 1))] / (prior.bias_mps2 * prior.bias_mps2);
    data_share[at(sums.sensor[at(i)])] = 1.0 - std::fmax(scale, bias);
  }
  write_uncertainty(array, gravity, fit, sums, uncertainty);
  return true;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
