#include <cmath>

#include "station_solver.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

StationResidual station_residual(const Calibration& calibration, const GravityReference& gravity,
                                 const Station& station) noexcept {
  StationResidual out;
  const int n = calibration.array.size();
  const SensorSet delivered = station.delivered & calibration.array.all();
  if (station.count == 0 || rank_of(calibration.array, delivered) < 3) return out;
  // The calibrated array as a datasheet of its own, whose readings are m/s^2 already.
  Datasheet sheet;
  sheet.size = n;
  const auto count = static_cast<double>(station.count);
  for (int i = 0; i < n; ++i) {
    SensorRow& row = sheet.sensor[at(i)].row;
    row = calibration.array.row(i);
    const double misfit = calibration.array.uncertainty().misfit_mps2[at(i)];
    row.sigma_mps2 = std::sqrt(row.sigma_mps2 * row.sigma_mps2 + count * misfit * misfit);
  }
  Station readings = station;
  readings.mean = calibration.model.apply(station.mean, station.temperature_degc, delivered);
  readings.delivered = delivered;
  const fit::Problem problem = {sheet, gravity.g_mps2, {&readings, 1}, 1, {}, nullptr};
  const fit::Parameters theta = fit::datasheet_parameters(sheet);
  fit::StationSolver solver(problem, theta, 0.0);
  if (solver.solve(readings) != fit::Loaded::used) return out;
  out.gravity_mps2 = solver.gravity;
  out.norm_error_mps2 = norm(solver.estimate) - gravity.g_mps2;
  for (int k = 0; k < solver.rows; ++k) out.residual_mps2[at(solver.sensor[at(k)])] = solver.residual(k);
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
