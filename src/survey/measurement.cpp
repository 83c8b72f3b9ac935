#include "plumb/survey/measurement.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

Covariance6 independent_covariance(double gravity_sigma_mps2, double field_sigma_tesla) noexcept {
  Covariance6 out{};
  for (std::size_t k = 0; k < 6; ++k) {
    const double sigma = k < 3 ? gravity_sigma_mps2 : field_sigma_tesla;
    out[7 * k] = sigma * sigma;
  }
  return out;
}

Covariance6 total_covariance(const Measurement& station, const ToolErrors& tool) noexcept {
  const auto square = [](double x) { return x * x; };
  Covariance6 out = station.random;
  for (std::size_t k = 0; k < 3; ++k) {
    out[7 * k] += square(tool.accelerometer_bias_mps2) + square(tool.accelerometer_scale * station.gravity_mps2[k]);
    out[7 * (k + 3)] += square(tool.magnetometer_bias_tesla) + square(tool.magnetometer_scale * station.field_tesla[k]);
  }
  out[35] += square(tool.axial_interference_tesla);
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
