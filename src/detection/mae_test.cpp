#include "plumb/detection/mae_test.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

namespace {

/// Mean of a half-normal variable, in sigmas.
constexpr double kHalfNormalMean = 0.79788456080286535588;

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
  const double per_sample = std::sqrt(block.samples / window);  // a sample may be a mean itself
  const double sigma = triple.norm_sigma_mps2 / per_sample;
  MaeLimit out;
  out.mean_mps2 = kHalfNormalMean * sigma;
  out.noise_mps2 = sigma * quantile;
  out.systematic_mps2 = triple.norm_systematic / std::sqrt(block.samples) * triple.norm_sigma_mps2;
  return out;
}

MaeLimit given_mae_limit(double delta_f_mps2) noexcept { return {0.0, delta_f_mps2, 0.0}; }

}  // namespace PLUMB_ABI
}  // namespace plumb
