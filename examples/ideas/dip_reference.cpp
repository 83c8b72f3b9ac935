// Three accelerometers and magnetometers: a fault that mirrors gravity keeps its length; the dip of the field names it.
#include <cstdio>

#include "plumb/array/mirror.hpp"
#include "plumb/array/named.hpp"
#include "plumb/detection/dip_evidence.hpp"

int main() {
  plumb::AxisList axes{};
  plumb::SensorRow rows[3];
  plumb::orthogonal_triad(axes);
  for (std::size_t i = 0; i < 3; ++i) rows[i] = {plumb::make_id(i == 0 ? "x" : i == 1 ? "y" : "z"), axes[i], 0.002};
  const plumb::SensorArray array = *plumb::SensorArray::make(rows, 3);
  const plumb::Vec3 down{-4.9049, -3.9239, 7.5339};  // the truth; y reads what a mirror would show it
  plumb::DipStation s;                               // means of a block, and what they may be off by
  s.used = array.all();
  s.mean_mps2 = {down[0], down[1] + plumb::mirror_error(array, 0, 1, down), down[2]};
  s.sigma_mps2.fill(0.0005);
  s.field = {{-22000.0, -4100.0, 44710.0}, {20.0, 30.0}, 50.0, 0.001};  // noise, calibration, interference, turn
  s.reference = {50000.0, {130.0, 0.0}, plumb::rad_from_deg(70.0), {plumb::rad_from_deg(0.2), 0.0}};
  const plumb::DipAnswer a = plumb::DipEvidence().add(plumb::judge_dip(array, s));
  std::printf("%s: sensor %s\n", plumb::to_string(a.verdict), a.named < 0 ? "-" : array.row(a.named).id.data());
  const double off_rad = plumb::angle_between_rad(a.gravity_mps2, down);
  std::printf("%.2f deg off, at most %.2f\n", plumb::deg_from_rad(off_rad), plumb::deg_from_rad(a.bound_rad));
}
