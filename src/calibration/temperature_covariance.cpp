/// What a fit over temperature leaves: the posterior in natural units, as it acts at one temperature, and one
/// covariance that covers a span.
#include <cmath>

#include "plumb/numeric/cholesky.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"
#include "temperature_model.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Temperatures at which the span is looked at: a variance is of degree 6 in the temperature.
constexpr int kTemperatureGrid = 13;
/// Rotations carry no variance but rounding, of either sign; this part of the diagonal, or ten times as much where that
/// is not enough, stands above it. It goes into the result, so that what covers the rest covers them too.
constexpr double kRidge = 1e-7;
constexpr int kRidges = 5;

/// d(W, b) as it acts at one temperature, by the parameters of one sensor.
struct Action {
  Vec3 w{};             ///< W
  double offset = 0.0;  ///< b + beta
  double scale = 1.0;   ///< s
  Cubic t{};            ///< T_j
  int order = 0;

  /// Row p of the map times the vector of one sensor's parameters, entry k at v[k * step].
  double apply(int p, const double* v, int step) const noexcept {
    double out = v[at(p * step)];
    const double by_scale = (p < 3 ? w[at(p)] : offset) / scale;
    for (int j = 1; j <= order; ++j) {
      out += by_scale * t[at(j)] * v[at((2 + 2 * j) * step)];
      if (p == 3) out += t[at(j)] * v[at((3 + 2 * j) * step)];
    }
    return out;
  }
};

Action action_of(const Joint& joint, const JointState& state, int i, double temperature_degc) noexcept {
  Action out;
  out.w = row_of(state.theta, i);
  out.offset = state.theta[at(4 * i + 3)];
  out.scale = 0.0;
  out.t = chebyshev_values(joint.use_degc.scaled(temperature_degc));
  out.order = joint.order;
  for (std::size_t k = 0; k < out.t.size(); ++k) {
    out.offset += state.bias[at(i)][k] * out.t[k];
    out.scale += state.scale[at(i)][k] * out.t[k];
  }
  return out;
}

/// Replaces the columns of a (m x m) by l^-1 times them.
void solve_lower(const double* l, int m, double* a) noexcept {
  for (int c = 0; c < m; ++c) {
    for (int i = 0; i < m; ++i) {
      double sum = a[i * m + c];
      for (int k = 0; k < i; ++k) sum -= l[i * m + k] * a[k * m + c];
      a[i * m + c] = sum / l[i * m + i];
    }
  }
}

void transpose(double* a, int m) noexcept {
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < i; ++j) {
      const double kept = a[i * m + j];
      a[i * m + j] = a[j * m + i];
      a[j * m + i] = kept;
    }
  }
}

/// The lower factor of `a`, which gets as much of a ridge as it takes.
bool factor_of(double* a, int m, double* factor) noexcept {
  double ridge = kRidge;
  for (int k = 0; k < kRidges; ++k) {
    for (int i = 0; i < m; ++i) a[i * m + i] *= 1.0 + ridge;
    for (int i = 0; i < m * m; ++i) factor[i] = a[i];
    if (cholesky_factor(factor, m, m)) return true;
    ridge *= 10.0;
  }
  return false;
}

/// Largest x with det(c - x l l') = 0; c is destroyed, `l` the lower factor. Not above 0 where it could not be had.
double largest_ratio(const double* l, int m, double* c) noexcept {
  solve_lower(l, m, c);
  transpose(c, m);
  solve_lower(l, m, c);
  for (int i = 0; i < m; ++i) {
    for (int j = 0; j < i; ++j) c[j * m + i] = c[i * m + j];
  }
  Parameters values{};
  return symmetric_eigenvalues(c, m, m, values.data()) ? values[at(m - 1)] : 0.0;
}

/// Twelve directions, evenly spread: the corners of an icosahedron.
Vec3 corner(int k) noexcept {
  constexpr double kShort = 0.5257311121191336, kLong = 0.8506508083520399;
  const double a = k % 2 == 0 ? kShort : -kShort, b = k / 2 % 2 == 0 ? kLong : -kLong;
  Vec3 out{};
  out[at(k / 4)] = a;
  out[at((k / 4 + 1) % 3)] = b;
  return out;
}

/// Variance of the direction [rad^2] that sensors of equal weight give, mean over the sphere.
double tilt_variance(const JointState& state, int n, double g_mps2, const double* c) noexcept {
  constexpr int kCorners = 12;
  Symmetric3 normal{};
  for (int i = 0; i < n; ++i) add_outer(normal, row_of(state.theta, i), 1.0);
  std::array<Vec3, kCapacity> map{};
  for (int i = 0; i < n; ++i) map[at(i)] = solve(normal, row_of(state.theta, i));
  double sum = 0.0;
  for (int k = 0; k < kCorners; ++k) {
    const Vec3 u = corner(k);
    const std::array<double, 4> z = {g_mps2 * u[0], g_mps2 * u[1], g_mps2 * u[2], 1.0};
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        double variance = 0.0;
        for (int p = 0; p < 4; ++p) {
          for (int q = 0; q < 4; ++q) variance += z[at(p)] * z[at(q)] * c[(4 * i + p) * 4 * n + 4 * j + q];
        }
        const double across = dot(map[at(i)], map[at(j)]) - dot(map[at(i)], u) * dot(map[at(j)], u);
        sum += variance * across;
      }
    }
  }
  return std::fmax(sum, 0.0) / (kCorners * g_mps2 * g_mps2);
}

}  // namespace

void note_forecast(const Joint& joint, const JointState& state, double g_mps2, double misfit_mps2,
                   TemperatureWork& work, TemperatureReport& report) noexcept {
  const int n = joint.sensors();
  double* const c = work.vectors.data();
  const Vec3 degc = {report.use_degc.lowest, report.use_degc.middle(), report.use_degc.highest};
  for (std::size_t k = 0; k < degc.size(); ++k) {
    TemperatureForecast& out = report.forecast[k];
    out = TemperatureForecast{};
    out.degc = degc[k];
    covariance_at(joint, state, work.information.data(), out.degc, c);
    for (int i = 0; i < n; ++i) {
      double variance = misfit_mps2 * misfit_mps2;
      for (int p = 0; p < 4; ++p) {
        variance += c[at((4 * i + p) * (4 * n + 1))] * (p < 3 ? g_mps2 * g_mps2 / 3.0 : 1.0);
      }
      const double sigma = std::sqrt(std::fmax(variance, 0.0)) / norm(row_of(state.theta, i));
      if (!(sigma > out.reading_mps2)) continue;
      out.reading_mps2 = sigma;
      out.sensor = i;
    }
    out.tilt_rad = std::sqrt(tilt_variance(state, n, g_mps2, c));
  }
}

void covariance_at(const Joint& joint, const JointState& state, const double* covariance, double temperature_degc,
                   double* out) noexcept {
  const int n = joint.sensors(), per = joint.per_sensor(), size = joint.parameters();
  std::array<Action, kCapacity> action;
  for (int i = 0; i < n; ++i) action[at(i)] = action_of(joint, state, i, temperature_degc);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double* block = covariance + at(per * i) * at(size) + at(per * j);
      std::array<double, at(4 * kJointPerSensor)> half{};  // 4 x per
      for (int q = 0; q < per; ++q) {
        for (int p = 0; p < 4; ++p) half[at(p * per + q)] = action[at(i)].apply(p, block + q, size);
      }
      for (int p = 0; p < 4; ++p) {
        for (int q = 0; q < 4; ++q) {
          const double entry = action[at(j)].apply(q, half.data() + at(p * per), 1);
          out[(4 * i + p) * 4 * n + 4 * j + q] = entry;
          out[(4 * j + q) * 4 * n + 4 * i + p] = entry;
        }
      }
    }
  }
}

double covering_covariance(const Joint& joint, const JointState& state, const ChebyshevSpan& span,
                           TemperatureWork& work) noexcept {
  const int m = 4 * joint.sensors();
  const std::size_t size = at(m) * at(m);
  double* const mean = work.vectors.data();
  double* const factor = mean + size;
  double* const one = factor + size;
  const auto temperature = [&span](int k) {
    return span.lowest + (span.highest - span.lowest) * k / (kTemperatureGrid - 1.0);
  };
  for (std::size_t k = 0; k < size; ++k) mean[k] = 0.0;
  for (int g = 0; g < kTemperatureGrid; ++g) {
    covariance_at(joint, state, work.information.data(), temperature(g), one);
    for (std::size_t k = 0; k < size; ++k) mean[k] += one[k] / kTemperatureGrid;
  }
  if (!factor_of(mean, m, factor)) return 0.0;
  double inflation = 1.0;
  for (int g = 0; g < kTemperatureGrid; ++g) {
    covariance_at(joint, state, work.information.data(), temperature(g), one);
    const double ratio = largest_ratio(factor, m, one);
    if (!(ratio > 0.0)) return 0.0;
    inflation = std::fmax(inflation, ratio);
  }
  for (std::size_t k = 0; k < size; ++k) mean[k] *= inflation;
  return inflation;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
