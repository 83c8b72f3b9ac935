#include "plumb/health/detail/tolerance.hpp"

#include <cmath>

namespace plumb {
inline namespace PLUMB_ABI {

using std::size_t;

void allow_for_drift(const Settings& settings, const InForce& in_force, double temperature_degc,
                     double lag_degc_per_min, float learned_mps2, BlockEvidence& evidence) noexcept {
  for (int i = 0; i < in_force.array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double away_degc = temperature_degc - in_force.model.sensor[a].reference_degc;
    evidence.tolerance_mps2[a] = settings.stability[a].tolerance_mps2(away_degc, lag_degc_per_min);
    evidence.tolerance_mps2[a] = std::fmin(evidence.tolerance_mps2[a] + learned_mps2, kMostTolerance_mps2);
  }
}

void allow_for_steps(const Settings& settings, const SensorArray& array, const BlockAccumulator& block,
                     SensorSet in_service, BlockEvidence& evidence) noexcept {
  double widest = 1.0;
  for (int i = 0; i < array.size(); ++i) {
    const auto a = static_cast<size_t>(i);
    const double step = static_cast<double>(settings.resolution_mps2[a]), sigma = array.sigma_mps2(i);
    const double scatter = block.size() > 1 ? block.covariance(i, i) : sigma * sigma;
    if (!(2.0 * sigma >= step && 4.0 * scatter >= step * step)) {
      const double within = static_cast<double>(evidence.tolerance_mps2[a]) + 0.5 * step;
      evidence.tolerance_mps2[a] = static_cast<float>(std::fmin(within, static_cast<double>(kMostTolerance_mps2)));
    } else if (in_service.has(i)) {
      widest = std::fmax(widest, 1.0 + step * step / (12.0 * sigma * sigma));
    }
  }
  evidence.samples /= widest;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
