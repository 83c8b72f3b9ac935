// What an array finds, before anything is built: least faults, and the tilt error that can stay unseen.
#include <cstdio>

#include "plumb/array/named.hpp"
#include "plumb/core/units.hpp"
#include "plumb/detection/thresholds.hpp"

int main() {
  for (const int n : {4, 5, 6, 8}) {
    plumb::AxisList axes{};
    plumb::SensorRow rows[8];
    plumb::cone_with_axis(axes, n);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      const char id[] = {'a', static_cast<char>('1' + i), '\0'};
      rows[i] = {plumb::make_id(id), axes[i], 0.002};  // noise of one sample [m/s^2]
    }
    const plumb::Expected<plumb::SensorArray> array = plumb::SensorArray::make(rows, n);
    if (!array) return 1;
    const plumb::Thresholds t = plumb::thresholds_of(*array, plumb::GravityReference{}, plumb::TestSettings{});
    std::printf("%d sensors: bias of a1 detected from %.4f m/s^2, tilt error unseen at most %.3f deg\n", n,
                t.sensor[0].detectable_mps2, plumb::deg_from_rad(t.protection_rad));
  }
}
