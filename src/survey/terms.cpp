#include "plumb/survey/terms.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {

const char* to_string(Term term) noexcept {
  switch (term) {
    case Term::accelerometer_bias_x: return "accelerometer bias x";
    case Term::accelerometer_bias_y: return "accelerometer bias y";
    case Term::accelerometer_bias_z: return "accelerometer bias z";
    case Term::accelerometer_scale_x: return "accelerometer scale x";
    case Term::accelerometer_scale_y: return "accelerometer scale y";
    case Term::accelerometer_scale_z: return "accelerometer scale z";
    case Term::magnetometer_bias_x: return "magnetometer bias x";
    case Term::magnetometer_bias_y: return "magnetometer bias y";
    case Term::magnetometer_bias_z: return "magnetometer bias z";
    case Term::magnetometer_scale_x: return "magnetometer scale x";
    case Term::magnetometer_scale_y: return "magnetometer scale y";
    case Term::magnetometer_scale_z: return "magnetometer scale z";
  }
  return "?";
}

const char* unit_of(Term term) noexcept {
  const std::size_t kind = static_cast<std::size_t>(term) / 3;
  return kind == 0 ? "m/s^2" : kind == 2 ? "T" : "1";
}

double sigma_of(Term term, const ToolErrors& tool) noexcept {
  switch (static_cast<std::size_t>(term) / 3) {
    case 0: return tool.accelerometer_bias_mps2;
    case 1: return tool.accelerometer_scale;
    case 2:
      return term == Term::magnetometer_bias_z ? std::hypot(tool.magnetometer_bias_tesla, tool.axial_interference_tesla)
                                               : tool.magnetometer_bias_tesla;
    default: return tool.magnetometer_scale;
  }
}

Measurement without(const TermValues& errors, const Measurement& station) noexcept {
  Measurement out = station;
  for (std::size_t k = 0; k < 3; ++k) {
    out.gravity_mps2[k] = (station.gravity_mps2[k] - errors[k]) / (1.0 + errors[3 + k]);
    out.field_tesla[k] = (station.field_tesla[k] - errors[6 + k]) / (1.0 + errors[9 + k]);
  }
  return out;
}

std::array<double, 72> term_weights(const Measurement& station) noexcept {
  std::array<double, 72> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    out[kTermCount * k + k] = 1.0;
    out[kTermCount * k + 3 + k] = station.gravity_mps2[k];
    out[kTermCount * (3 + k) + 6 + k] = 1.0;
    out[kTermCount * (3 + k) + 9 + k] = station.field_tesla[k];
  }
  return out;
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
