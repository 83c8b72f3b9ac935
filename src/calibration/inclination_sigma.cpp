/// How surely a calibration knows an inclination itself, not only its changes.
#include <cmath>

#include "fit_report.hpp"
#include "plumb/array/geometry.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

using numbers::at;

namespace fit {
namespace {

/// Below this sine of the inclination its direction of growth is no direction.
constexpr double kUpright = 1e-3;

/// The nominal axes fix the two rotations that tilt the roll axis, each axis with the same say: 1 sigma of one of them.
double of_nominal_axes(const Datasheet& datasheet, const Vec3& axis) noexcept {
  Symmetric3 sum{}, spread{};
  for (int i = 0; i < datasheet.size; ++i) {
    const DatasheetSensor& s = datasheet.sensor[at(i)];
    const double variance = s.prior.axis_rad * s.prior.axis_rad;
    for (const std::size_t diagonal : {0U, 3U, 5U}) {
      sum[diagonal] += 1.0;
      spread[diagonal] += variance;
    }
    add_outer(sum, s.row.axis, -1.0);
    add_outer(spread, s.row.axis, -variance);
  }
  double variance = 0.0;
  for (std::size_t p = 0; p < 3; ++p) {
    Vec3 e{};
    e[p] = 1.0;
    const Vec3 across = solve(sum, minus(e, scaled(axis, axis[p])));
    variance += 0.5 * dot(across, times(spread, across));
  }
  return std::sqrt(std::fmax(variance, 0.0));
}

}  // namespace

double inclination_sigma(const Problem& problem, const Parameters& theta, const SensorArray& calibrated) noexcept {
  const Vec3& axis = problem.roll.axis;
  if (!problem.roll.used) return of_nominal_axes(problem.datasheet, axis);
  const int n = calibrated.size();
  const LeastSquares map = least_squares(calibrated, calibrated.all());
  StationSolver solver(problem, theta, 0.0);
  double sum = 0.0;
  int stations = 0;
  for (int s = 0; s < problem.count; ++s) {
    if (solver.solve(problem.stations[s]) != Loaded::used) continue;
    const Vec3& u = solver.direction;
    Vec3 growing = minus(scaled(u, dot(axis, u)), axis);
    if (!(norm(growing) > kUpright)) growing = cross(u, std::fabs(u[0]) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    growing = scaled(growing, 1.0 / (norm(growing) * problem.g_mps2));
    double variance = 0.0;
    for (int i = 0; i < n; ++i) {
      const double own = dot(map.column[at(i)], growing);
      for (int j = 0; j < n; ++j) {
        const double other = dot(map.column[at(j)], growing);
        variance += own * other * calibrated.uncertainty().at(i, j, solver.gravity);
      }
    }
    sum += variance;
    ++stations;
  }
  return stations > 0 ? std::sqrt(std::fmax(sum, 0.0) / stations) : 0.0;
}

}  // namespace fit
}  // namespace PLUMB_ABI
}  // namespace plumb
