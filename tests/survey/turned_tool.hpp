/// Stations of a tool whose magnetometers are turned against its accelerometers, with errors and noise.
#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "plumb/survey/terms.hpp"
#include "simulated_survey.hpp"

namespace turned_tool {

using plumb::Mat3;
using plumb::Vec3;

inline Vec3 degrees(double x, double y, double z) {
  return {plumb::rad_from_deg(x), plumb::rad_from_deg(y), plumb::rad_from_deg(z)};
}

/// exp of a rotation vector.
inline Mat3 rotation_of(const Vec3& turn_rad) {
  const double angle = plumb::norm(turn_rad);
  const Eigen::Vector3d axis(turn_rad[0], turn_rad[1], turn_rad[2]);
  Mat3 out{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  if (angle > 0.0)
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.data()) =
        Eigen::AngleAxisd(angle, axis / angle).toRotationMatrix();
  return out;
}

inline Mat3 transposed(const Mat3& m) { return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]}; }

struct TurnedTool {
  Vec3 turn_rad{};  ///< from the magnetometers' frame to the accelerometers'
  plumb::survey::TermValues errors{};
  simulated_survey::World world;
  double gravity_noise_mps2 = 1e-3, field_noise_tesla = 20e-9;
  bool noisy = true;
  unsigned seed = 1;

  std::vector<plumb::survey::ReferencedStation> of(
      const std::vector<simulated_survey::Truth>& hole,
      const simulated_survey::World& stated = simulated_survey::World{}) const {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    const Mat3 back = transposed(rotation_of(turn_rad));
    std::vector<plumb::survey::ReferencedStation> out;
    for (std::size_t i = 0; i < hole.size(); ++i) {
      plumb::survey::Measurement m = simulated_survey::station_of(hole[i], world, 30.0 * static_cast<double>(i));
      m.field_tesla = plumb::times(back, m.field_tesla);
      for (std::size_t k = 0; k < 3; ++k) {
        m.gravity_mps2[k] = (1.0 + errors[3 + k]) * m.gravity_mps2[k] + errors[k];
        m.field_tesla[k] = (1.0 + errors[9 + k]) * m.field_tesla[k] + errors[6 + k];
        if (noisy) m.gravity_mps2[k] += gravity_noise_mps2 * normal(generator);
        if (noisy) m.field_tesla[k] += field_noise_tesla * normal(generator);
      }
      m.random = plumb::survey::independent_covariance(gravity_noise_mps2, field_noise_tesla);
      out.push_back({m, simulated_survey::reference_of(stated)});
    }
    return out;
  }
};

/// Upright and upside down, to all sides, no two alike.
inline std::vector<simulated_survey::Truth> scattered(int stations) {
  std::vector<simulated_survey::Truth> out;
  for (int k = 0; k < stations; ++k)
    out.push_back({std::acos(1.0 - 2.0 * (k + 0.5) / stations), 2.399963 * k, 1.1 * k + 0.3 * k * k});
  return out;
}

/// From one inclination to another on one azimuth, the tool turned at every station.
inline std::vector<simulated_survey::Truth> build_up(double azimuth_deg, int stations, double from_deg = 2.0,
                                                     double to_deg = 90.0) {
  std::vector<simulated_survey::Truth> out;
  for (int k = 0; k < stations; ++k)
    out.push_back({plumb::rad_from_deg(from_deg + (to_deg - from_deg) * k / (stations - 1)),
                   plumb::rad_from_deg(azimuth_deg), plumb::rad_from_deg(77.0 * k)});
  return out;
}

}  // namespace turned_tool
