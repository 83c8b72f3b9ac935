#include "plumb/health/stability.hpp"

#include "plumb/detection/set_test.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

Expected<void> checked(const Stability& stability, int sensor) noexcept {
  const double figures[] = {stability.mps2, stability.per_day_mps2, stability.per_degc_mps2,
                            stability.per_degc_per_min_mps2};
  for (const double figure : figures) {
    if (!std::isfinite(figure)) return fail(Errc::not_finite, sensor, figure, 0.0);
    if (figure < 0.0) return fail(Errc::out_of_range, sensor, figure, 0.0);
    if (figure > kMostStability_mps2) return fail(Errc::out_of_range, sensor, figure, kMostStability_mps2);
  }
  return {};
}

float StabilityNow::tolerance_mps2(double away_degc, double rate_degc_per_min) const noexcept {
  const double sigma_mps2 = static_cast<double>(mps2) + static_cast<double>(per_degc_mps2) * std::fabs(away_degc) +
                            static_cast<double>(per_degc_per_min_mps2) * std::fabs(rate_degc_per_min);
  const auto tolerance = static_cast<float>(kStabilitySigmas * sigma_mps2);
  return tolerance < kMostTolerance_mps2 ? tolerance : kMostTolerance_mps2;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
