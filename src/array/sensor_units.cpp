#include "plumb/array/sensor_units.hpp"

namespace plumb {
inline namespace PLUMB_ABI {

SensorSet SensorUnits::spread(SensorSet units) const noexcept {
  SensorSet out;
  for (int i = 0; i < sensors_; ++i) {
    if (units.has(of(i))) out = out.with(i);
  }
  return out;
}

SensorSet SensorUnits::gathered(SensorSet sensors) const noexcept {
  SensorSet out;
  for (int i = 0; i < sensors_; ++i) {
    if (sensors.has(i)) out = out.with(of(i));
  }
  return out;
}

}  // namespace PLUMB_ABI
}  // namespace plumb
