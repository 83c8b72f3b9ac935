#include "export_losses.hpp"

#include <algorithm>
#include <cmath>

#include "plumb/calibration/datasheet.hpp"
#include "plumb/numeric/symmetric_eigenvalues.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace coefficients {
namespace {

constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
/// What rounding leaves of an axis or a sigma that is as stated.
constexpr double kRounding = 1e-9;
constexpr int kSteps = 256;

double cubic(const std::array<double, 4>& c, double dt) { return c[0] + dt * (c[1] + dt * (c[2] + dt * c[3])); }

bool drifts(const std::array<double, 4>& c) { return c[1] != 0.0 || c[2] != 0.0 || c[3] != 0.0; }

/// Rows of a unit frame whose first is the axis.
std::array<Vec3, 3> frame_on(const Vec3& axis) {
  const Vec3 other = std::fabs(axis[0]) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0};
  const Vec3 across = cross(axis, other);
  const Vec3 second = scaled(across, 1.0 / norm(across));
  return {axis, second, cross(axis, second)};
}

using Mat4 = std::array<double, 16>;

/// Of the errors of sensors i and j: scale, two turns across the axis, and bias.
Mat4 turned_block(const SensorArray& array, int i, int j) {
  const std::array<Vec3, 3> fi = frame_on(array.axis(i)), fj = frame_on(array.axis(j));
  const auto weight = [](const std::array<Vec3, 3>& frame, std::size_t p, int r) {
    return p == 3 || r == 3 ? (p == 3 && r == 3 ? 1.0 : 0.0) : frame[p][at(r)];
  };
  Mat4 out{};
  for (std::size_t p = 0; p < 4; ++p) {
    for (std::size_t q = 0; q < 4; ++q) {
      for (int r = 0; r < 4; ++r) {
        for (int s = 0; s < 4; ++s)
          out[4 * p + q] += weight(fi, p, r) * weight(fj, q, s) * array.row_covariance(4 * i + r, 4 * j + s);
      }
    }
  }
  const double misfit = array.uncertainty().misfit_mps2[at(i)];
  if (i == j) out[15] += misfit * misfit;
  return out;
}

double sigma_of(const Prior& prior, std::size_t p) {
  if (p == 3) return prior.bias_mps2;
  return p == 0 ? prior.scale : prior.axis_rad;
}

}  // namespace

void lose_axis(const io::ArrayFile& array, const Calibration& calibration, int sensor, std::vector<ExportLoss>& out) {
  const double chord = norm(minus(calibration.array.axis(sensor), array.array.axis(sensor)));
  if (chord > kRounding) out.push_back({sensor, "the axis", chord * array.gravity.g_mps2});
}

void lose_drift(const io::ArrayFile& array, const Calibration& calibration, int sensor, std::vector<ExportLoss>& out) {
  const SensorCoefficients& c = calibration.model.sensor[at(sensor)];
  if (!drifts(c.bias) && !drifts(c.scale)) return;
  const double low = calibration.report.temperature_min_degc - c.reference_degc;
  const double high = calibration.report.temperature_max_degc - c.reference_degc;
  double worst = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double dt = low + (high - low) * k / kSteps;
    // a = raw / S - B, with raw = S(T) (a + B(T)): what the constants S and B make of it, at a = +G and -G.
    const double ratio = cubic(c.scale, dt) / c.scale[0];
    const double offset = ratio * cubic(c.bias, dt) - c.bias[0];
    worst = std::fmax(worst, std::fabs(ratio - 1.0) * array.gravity.g_mps2 + std::fabs(offset));
  }
  out.push_back({sensor, "the drift with temperature", worst});
}

std::vector<Uncertainty> separate_sigmas(const SensorArray& array, double& factor) {
  const int n = array.size();
  const auto size = at(4 * n);
  std::vector<Prior> priors;
  for (int i = 0; i < n; ++i) {
    priors.push_back(prior_in(array, i));
    priors.back().bias_mps2 = std::hypot(priors.back().bias_mps2, array.uncertainty().misfit_mps2[at(i)]);
  }
  // D^-1/2 C D^-1/2 with D of the sigmas apart: its largest eigenvalue is what D must be multiplied by to hold C.
  std::vector<double> matrix(size * size), values(size);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Mat4 block = turned_block(array, i, j);
      for (std::size_t p = 0; p < 4; ++p) {
        for (std::size_t q = 0; q < 4; ++q) {
          const double sigmas = sigma_of(priors[at(i)], p) * sigma_of(priors[at(j)], q);
          matrix[(at(4 * i) + p) * size + at(4 * j) + q] = sigmas > 0.0 ? block[4 * p + q] / sigmas : 0.0;
        }
      }
    }
  }
  const bool told = symmetric_eigenvalues(matrix.data(), 4 * n, 4 * n, values.data());
  factor = told ? std::sqrt(std::fmax(values.back(), 1.0)) : HUGE_VAL;
  if (factor < 1.0 + kRounding) factor = 1.0;
  const auto stated = [&factor](double sigma) {
    return sigma > 0.0 ? std::optional<double>(factor * sigma) : std::nullopt;
  };
  std::vector<Uncertainty> out;
  for (const Prior& p : priors) out.push_back({stated(p.bias_mps2), stated(p.scale), stated(p.axis_rad)});
  return out;
}

}  // namespace coefficients
}  // namespace PLUMB_ABI
}  // namespace plumb
