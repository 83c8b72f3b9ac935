// Six axes: magnetometers are calibrated as if the field were gravity, then aligned to the accelerometers by the dip.
#include <cstdio>
#include "plumb/calibration/calibration.hpp"
#include "plumb/scenario/library.hpp"
#include "plumb/survey/joint_alignment.hpp"
using namespace plumb;
int main() {
  const Datasheet sheet = scenario::paper_datasheet();  // four magnetometers, in units in which the field is g0 long
  const survey::Reference place = {{}, {"", 2026, 50e-6, 1.2, {1e-7, 0}, {4e-3, 0}, false, 0, {}, {}}};
  std::vector<Station> raw(40, {{}, {}, SensorSet::first(4), 25, 100});
  std::vector<survey::ReferencedStation> stations(40, {{0, {}, {}, survey::independent_covariance(1e-3, 2e-8)}, place});
  for (std::size_t k = 0; k < 40; ++k) {
    const double a = 2.4 * double(k);
    const Vec3 north = {std::cos(a), std::sin(a), a / 24 - 2}, c = cross(north, {std::sin(3 * a), 0.7, std::cos(a)});
    const Vec3 field = plus(scaled(c, std::sin(1.2) / norm(c)), scaled(north, std::cos(1.2) / norm(north)));
    const Vec3 seen = plus(field, cross(field, {0.005, 0, 0.01}));  // turned by 0.29 deg about x, 0.57 deg about z
    for (std::size_t i = 0; i < 4; ++i) raw[k].mean[i] = 3 * dot(sheet.sensor[i].row.axis, seen) + 0.1;  // hard iron
    stations[k].measured.gravity_mps2 = scaled(c, kG0_mps2 / norm(c));
  }
  const auto fit = calibrate(sheet, {}, raw.data(), 40);
  for (std::size_t k = 0; fit && k < 40; ++k)
    stations[k].measured.field_tesla = scaled(station_residual(*fit, {}, raw[k]).gravity_mps2, 50e-6 / kG0_mps2);
  const auto found = survey::align_magnetometers(stations, {});
  if (found) std::printf("%.2f, %.2f deg\n", deg_from_rad(found->turn_rad[0]), deg_from_rad(found->turn_rad[2]));
}
