/// Stations with accelerometers and magnetometers, one accelerometer perhaps faulty: what tests and the campaign of the
/// dip draw from.
#pragma once

#include <cmath>
#include <functional>

#include "plumb/array/named.hpp"
#include "plumb/detection/dip_evidence.hpp"
#include "support/noise.hpp"

namespace plumb_test {

/// Any direction at this angle from `from` (unit length).
inline plumb::Vec3 direction_beside(const plumb::Vec3& from, double angle_rad, Noise& noise) {
  plumb::Vec3 side{};
  do side = plumb::cross(from, random_direction(noise));
  while (plumb::norm(side) < 0.1);
  side = plumb::scaled(side, 1.0 / plumb::norm(side));
  return plumb::plus(plumb::scaled(from, std::cos(angle_rad)), plumb::scaled(side, std::sin(angle_rad)));
}

/// Axes of which the first three have at least this determinant: at least 0.05 for three, and for more that no plane
/// of others comes near all of them at least 0.16.
inline plumb::AxisList random_axes(int n, double least_det, Noise& noise) {
  plumb::AxisList axes{};
  do
    for (int i = 0; i < n; ++i) axes[static_cast<std::size_t>(i)] = random_direction(noise);
  while (std::fabs(plumb::det3(axes[0], axes[1], axes[2])) < std::fmax(least_det, n > 3 ? 0.16 : 0.05));
  return axes;
}

/// Sensors s0, s1, ... along these axes.
inline plumb::SensorArray sensors_along(const plumb::AxisList& axes, int n) {
  std::array<plumb::SensorRow, plumb::kCapacity> rows{};
  for (int i = 0; i < n; ++i) {
    const char id[] = {'s', static_cast<char>('0' + i), '\0'};
    rows[static_cast<std::size_t>(i)] = {plumb::make_id(id), axes[static_cast<std::size_t>(i)], 2e-4 * plumb::kG0_mps2};
  }
  return *plumb::SensorArray::make(rows.data(), n);
}
inline plumb::SensorArray triad_array() {
  plumb::AxisList axes{};
  return sensors_along(axes, plumb::orthogonal_triad(axes));
}

/// The place and the instruments. Errors that are drawn stay within what is stated; `draw` gives -1 to 1.
struct DipScene {
  plumb::SensorArray array;
  plumb::DipStation stated;  ///< all but the readings
  double dip_rad = 0.0;      ///< true; that of `stated` is off
  double g_mps2 = plumb::kG0_mps2, total_nt = 50000.0;

  static DipScene make(const plumb::SensorArray& array, double dip_deg) {
    DipScene out;
    out.array = array;
    out.dip_rad = plumb::rad_from_deg(dip_deg);
    plumb::DipStation& s = out.stated;
    s.used = array.all();
    s.sigma_mps2.fill(5e-5 * plumb::kG0_mps2);
    s.bound_mps2.fill(2e-4 * plumb::kG0_mps2);
    s.field.axis_error_nt = {20.0, 0.0};
    s.reference = {out.total_nt, {130.0, 0.0}, out.dip_rad, {plumb::rad_from_deg(0.2), 0.0}};
    return out;
  }

  /// The reference drawn anew, as it is at a place: alike at all stations there.
  void settle(const std::function<double()>& draw) {
    const double k = stated.sigmas;
    g_mps2 = stated.gravity.g_mps2 + k * stated.gravity.sigma_mps2 * draw();
    total_nt = stated.reference.total_nt + stated.reference.total_error_nt.within(k) * draw();
    const double off_rad = stated.reference.dip_error_rad.within(k) * draw();
    dip_rad = std::fmax(-0.5 * plumb::kPi, std::fmin(0.5 * plumb::kPi, stated.reference.dip_rad + off_rad));
  }

  /// Readings at gravity along `down`, the field in a drawn azimuth, fault `f_mps2` of sensor `faulty` (-1: none).
  plumb::DipStation station(const plumb::Vec3& down, int faulty, double f_mps2, Noise& noise,
                            const std::function<double()>& draw) const {
    return station(down, direction_beside(down, 0.5 * plumb::kPi - dip_rad, noise), faulty, f_mps2, noise, draw);
  }
  plumb::DipStation station(const plumb::Vec3& down, const plumb::Vec3& along, int faulty, double f_mps2, Noise& noise,
                            const std::function<double()>& draw) const {
    plumb::DipStation s = stated;
    const plumb::Vec3 acceleration = plumb::scaled(random_direction(noise), s.acceleration_mps2 * draw());
    const plumb::Vec3 felt = plumb::plus(plumb::scaled(down, g_mps2), acceleration);
    for (int i = 0; i < array.size(); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double error = (s.sigmas * s.sigma_mps2[k] + s.bound_mps2[k]) * draw();
      s.mean_mps2[k] = plumb::dot(array.axis(i), felt) + error + (i == faulty ? f_mps2 : 0.0);
    }
    const plumb::Vec3 turned = direction_beside(along, s.field.turn_rad * std::fabs(draw()), noise);
    const plumb::Vec3 interference = plumb::scaled(random_direction(noise), s.field.vector_nt * draw());
    for (std::size_t c = 0; c < 3; ++c)
      s.field.field_nt[c] = turned[c] * total_nt + interference[c] + s.field.axis_error_nt.within(s.sigmas) * draw();
    return s;
  }
};

/// The fault of sensor i that mirrors gravity in the plane of the two others of a triad of sensors (T1).
inline double mirror_fault_mps2(const plumb::SensorArray& array, int i, const plumb::Vec3& gravity_mps2) {
  const plumb::Vec3 v = plumb::least_squares(array, array.all()).column[static_cast<std::size_t>(i)];
  return -2.0 * plumb::dot(gravity_mps2, v) / plumb::dot(v, v);
}

}  // namespace plumb_test
