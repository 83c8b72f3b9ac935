#include "oracle.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace plumb {
inline namespace PLUMB_ABI {
namespace testing {
namespace {

/// Gravity sigma of `setup_of`, and how many of it count as far.
constexpr double kFarGravity_mps2 = 8.0 * 1e-4 * kG0_mps2;

double largest_sigma(const SensorArray& array) {
  double sigma = 0.0;
  for (int i = 0; i < array.size(); ++i) sigma = std::max(sigma, array.sigma_mps2(i));
  return sigma;
}

double block_sigma(const Case& c) { return largest_sigma(c.array) / std::sqrt(static_cast<double>(c.config.window)); }

/// By how much the triple misses the length of gravity, in shares of what is far; negative where it is no triple.
double miss(const Case& c, int i, int j, int k, const std::array<double, kCapacity>& raw) {
  const Vec3& a = c.array.axis(i);
  const Vec3& b = c.array.axis(j);
  const Vec3& d = c.array.axis(k);
  const double det = dot(a, cross(b, d));
  if (std::abs(det) < 0.1) return -1.0;
  const Vec3 wa = scaled(cross(b, d), 1.0 / det);
  const Vec3 wb = scaled(cross(d, a), 1.0 / det);
  const Vec3 wd = scaled(cross(a, b), 1.0 / det);
  const auto value = [&raw](int s) { return raw[static_cast<std::size_t>(s)]; };
  const Vec3 x = plus(plus(scaled(wa, value(i)), scaled(wb, value(j))), scaled(wd, value(k)));
  const double far = kFarShift * block_sigma(c) * (norm(wa) + norm(wb) + norm(wd)) + kFarGravity_mps2 +
                     2.0 * c.config.acceleration_bound_mps2;
  return std::abs(norm(x) - kG0_mps2) / far;
}

/// The part of the four readings that no gravity vector explains, in shares of what is far.
double disagreement(const Case& c, const std::array<int, 4>& four, const std::array<double, kCapacity>& raw) {
  double sum = 0.0;
  double square = 0.0;
  for (std::size_t left = 0; left < 4; ++left) {
    std::array<Vec3, 3> axis{};
    std::size_t k = 0;
    for (std::size_t s = 0; s < 4; ++s) {
      if (s != left) axis[k++] = c.array.axis(four[s]);
    }
    const double det = (left % 2 == 0 ? 1.0 : -1.0) * dot(axis[0], cross(axis[1], axis[2]));
    sum += det * raw[static_cast<std::size_t>(four[left])];
    square += det * det;
  }
  return std::abs(sum) / (kFarShift * block_sigma(c) * std::sqrt(square));
}

/// Every four sensors with a faulty one among them disagree by far at each of the stations. Where some four agree, a
/// monitor must take the length of gravity for what is wrong rather than them.
bool fours_disagree(const Case& c, SensorSet faulty, const std::vector<std::array<double, kCapacity>>& seen) {
  const int n = c.array.size();
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        for (int l = k + 1; l < n; ++l) {
          if (!faulty.has(i) && !faulty.has(j) && !faulty.has(k) && !faulty.has(l)) continue;
          for (const auto& raw : seen) {
            if (disagreement(c, {i, j, k, l}, raw) < 1.0) return false;
          }
        }
      }
    }
  }
  return true;
}

}  // namespace

double parity_shift(const Case& c, int sensor, double bias_mps2) {
  // 1 - h' (H'H)^-1 h: the share of a unit error that the estimate leaves in the residual.
  Vec3 r0{}, r1{}, r2{};
  for (int i = 0; i < c.array.size(); ++i) {
    const Vec3& h = c.array.axis(i);
    r0 = plus(r0, scaled(h, h[0]));
    r1 = plus(r1, scaled(h, h[1]));
    r2 = plus(r2, scaled(h, h[2]));
  }
  const double det = dot(r0, cross(r1, r2));
  if (!(det > 1e-9)) return 0.0;
  const Vec3& h = c.array.axis(sensor);
  const Vec3 u = {dot(h, cross(r1, r2)) / det, dot(r0, cross(h, r2)) / det, dot(r0, cross(r1, h)) / det};
  const double share = std::max(0.0, 1.0 - dot(h, u));
  const double left = 3.0 * c.calibration_mps2 * std::sqrt(static_cast<double>(c.array.size())) * 5.0;
  return std::max(0.0, std::abs(bias_mps2) * std::sqrt(share) - left) / block_sigma(c);
}

bool told_apart(const Case& c, SensorSet faulty, int from, int until) {
  scenario::Scenario quiet = scenario_of(c);
  quiet.noise.white = 0.0;
  const auto simulator = scenario::Simulator::make(quiet);
  if (!simulator) return false;
  const auto rows = static_cast<std::uint64_t>(kStationBlocks * c.config.window);
  std::vector<std::array<double, kCapacity>> seen;
  for (int station = from; station <= until; ++station) {
    seen.push_back(simulator->at(static_cast<std::uint64_t>(kTrustStations + station - 1) * rows).raw);
  }
  if (!fours_disagree(c, faulty, seen)) return false;
  const int n = c.array.size();
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      for (int k = j + 1; k < n; ++k) {
        double best = 0.0;
        for (const auto& raw : seen) {
          const double far = miss(c, i, j, k, raw);
          if (far < 0.0) return false;
          best = std::max(best, far);
        }
        const bool wrong = faulty.has(i) || faulty.has(j) || faulty.has(k);
        if (wrong && best < 1.0) return false;
      }
    }
  }
  return true;
}

}  // namespace testing
}  // namespace PLUMB_ABI
}  // namespace plumb
