#include <cmath>

#include "fit_internal.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

StationResidual station_residual(const Calibration& calibration, const GravityReference& gravity,
                                 const Station& station) noexcept {
  using fit::at;
  StationResidual out;
  const int n = calibration.array.size();
  const SensorSet delivered = station.delivered & calibration.array.all();
  if (station.count == 0 || rank_of(calibration.array, delivered) < 3) return out;
  const Readings reading = calibration.model.apply(station.mean, station.temperature_degc, delivered);
  fit::StationRows rows;
  fit::Parameters theta;
  for (int i = 0; i < n; ++i) {
    const Vec3& axis = calibration.array.axis(i);
    for (int p = 0; p < 3; ++p) theta[at(4 * i + p)] = axis[at(p)];
    theta[at(4 * i + 3)] = 0.0;
    if (!delivered.has(i)) continue;
    const double sigma = calibration.array.sigma_mps2(i);
    const double misfit = calibration.array.uncertainty().misfit_mps2[at(i)];
    const std::size_t k = at(rows.rows++);
    rows.sensor[k] = i;
    rows.reading[k] = reading[at(i)];
    rows.weight[k] = 1.0 / (sigma * sigma / static_cast<double>(station.count) + misfit * misfit);
  }
  fit::StationFit fitted;
  fit::fit_station(rows, theta, gravity.g_mps2, fitted);
  if (!fitted.finite) return out;
  out.gravity_mps2 = fitted.gravity;
  out.norm_error_mps2 = norm(fitted.estimate) - gravity.g_mps2;
  for (int k = 0; k < rows.rows; ++k) out.residual_mps2[at(rows.sensor[at(k)])] = fitted.residual[at(k)];
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
