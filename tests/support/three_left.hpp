/// The paper's four accelerometers of which one is dead, in a field of known dip.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "plumb/health/dip_watch.hpp"
#include "support/simulated_tool.hpp"

namespace three_left {

using namespace plumb;  // NOLINT(google-build-using-namespace)
using plumb_test::direction_at;
using plumb_test::Rig;

inline constexpr double kTotal_nt = 50000.0, kDip_deg = 60.0;

inline FieldReference reference() {
  return {kTotal_nt, {130.0, 0.0}, rad_from_deg(kDip_deg), {rad_from_deg(0.2), 0.0}};
}
/// The field at this attitude, exactly as the reference has it, in a fixed azimuth.
inline FieldReading field_at(const Vec3& down) {
  Vec3 north = cross(down, Vec3{0.3, -0.5, 0.8});
  north = scaled(north, 1.0 / norm(north));
  const double dip = rad_from_deg(kDip_deg);
  FieldReading out;
  out.field_nt = scaled(plus(scaled(down, std::sin(dip)), scaled(north, std::cos(dip))), kTotal_nt);
  out.axis_error_nt = {20.0, 0.0};
  return out;
}

/// The paper's four, of which the first dies: three are left.
struct ThreeLeft {
  Rig rig{plumb_test::tetrahedron()};
  double f_mps2 = 0.0;      ///< of sensor 2
  double noise_mps2 = 0.0;  ///< beyond the stated one
  double memory = 0.0;      ///< of that noise, from sample to sample
  bool dead = false;        ///< sensor 1
  plumb_test::Noise noise{3};
  std::array<double, 4> noise_of{};

  explicit ThreeLeft(
      const std::function<void(MonitorSetup&)>& change = [](MonitorSetup&) {}, double more_noise_mps2 = 0.0,
      double from_the_last = 0.0)
      : noise_mps2(more_noise_mps2), memory(from_the_last) {
    change(rig.setup);
    rig.restart();
    rig.distort = [this](int i, double reading, int) {
      if (i == 0 && dead) return std::nan("");
      double& last = noise_of[static_cast<std::size_t>(i)];
      last = memory * last + noise_mps2 * noise.normal();
      return reading + last + (i == 1 ? f_mps2 : 0.0);
    };
    rig.prove();
    dead = true;
    rig.stay(direction_at(30, 40));
    rig.stay(direction_at(70, 140));
  }
  /// Stays until a block of this attitude is complete.
  DipReport report(DipWatch& watch, const Vec3& down, int blocks = 2) {
    rig.stay(down, blocks);
    return watch.add(rig.monitor, rig.setup, field_at(down), reference());
  }
  /// The error of sensor 2 that turns gravity into its mirror image in the plane of 3 and 4.
  double mirror_mps2(const Vec3& down) const {
    const SensorArray& array = rig.setup.array;
    const Vec3 v = least_squares(array, array.all().without(0)).column[1];
    return -2.0 * kG0_mps2 * dot(down, v) / dot(v, v);
  }
};

}  // namespace three_left
