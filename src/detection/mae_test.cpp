#include "plumb/detection/mae_test.hpp"

#include <cmath>
#include <limits>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// Mean of a half-normal variable, in sigmas.
constexpr double kHalfNormalMean = 0.79788456080286535588;

MaeLimit noise_limit(double sigma_of_one_mps2, const BlockEvidence& block, int window, double quantile) noexcept {
  const double per_sample = std::sqrt(block.samples / window);  // a sample may be a mean itself
  const double sigma = sigma_of_one_mps2 / per_sample;
  return {kHalfNormalMean * sigma, sigma * quantile, 0.0};
}

}  // namespace

int voting_triples(const SensorArray& array) noexcept {
  int count = 0;
  for (int k = 0; k < array.triple_count(); ++k) count += array.triple(k).votes ? 1 : 0;
  return count;
}

double triple_share(const SensorArray& array, double false_alarm_rate) noexcept {
  const int voting = voting_triples(array);
  return voting > 0 ? false_alarm_rate / voting : false_alarm_rate;
}

MaeLimit computed_mae_limit(const SetTest& triple, const BlockEvidence& block, int window, double quantile) noexcept {
  MaeLimit out = noise_limit(triple.norm_sigma_mps2, block, window, quantile);
  out.systematic_mps2 = triple.norm_systematic / std::sqrt(block.samples) * triple.norm_sigma_mps2;
  return out;
}

MaeLimit least_mae_limit(const SensorArray& array, const Triple& triple, const BlockEvidence& block, int window,
                         double quantile) noexcept {
  const std::array<std::uint8_t, 3>& s = triple.sensors;
  const Vec3 &a = array.axis(s[0]), &b = array.axis(s[1]), &c = array.axis(s[2]);
  // Times the determinant: the columns of the triple's map (eqs 18-21).
  const std::array<Vec3, 3> column = {cross(b, c), cross(c, a), cross(a, b)};
  Vec3 x{};
  for (std::size_t k = 0; k < 3; ++k) x = plus(x, scaled(column[k], block.mean_mps2[s[k]]));
  const double length2 = dot(x, x);
  // Three that all read zero point nowhere, and nothing is clean by them: the least limit that can be divided by.
  if (!(length2 > 0.0)) return given_mae_limit(std::numeric_limits<double>::min());
  double square = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double share = dot(column[k], x) * array.sigma_mps2(s[k]);
    square += share * share;
  }
  const double sigma = std::sqrt(square / length2) / std::fabs(triple.det);
  return noise_limit(sigma, block, window, quantile);
}

MaeLimit given_mae_limit(double delta_f_mps2) noexcept { return {0.0, delta_f_mps2, 0.0}; }

}  // namespace PLUMB_ABI
}  // namespace plumb
