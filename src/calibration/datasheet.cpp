#include "plumb/calibration/datasheet.hpp"

#include <cstddef>

namespace plumb {
inline namespace PLUMB_ABI {

SensorModel Datasheet::model() const noexcept {
  SensorModel out;
  out.size = size;
  out.reads = reads;
  for (int i = 0; i < size; ++i) {
    out.sensor[static_cast<std::size_t>(i)] = sensor[static_cast<std::size_t>(i)].coefficients;
  }
  return out;
}

Expected<SensorArray> Datasheet::array() const noexcept {
  std::array<SensorRow, kCapacity> rows{};
  if (size > kCapacity) return fail(Errc::too_many_sensors, -1, size, kCapacity);
  for (int i = 0; i < size; ++i) rows[static_cast<std::size_t>(i)] = sensor[static_cast<std::size_t>(i)].row;
  return SensorArray::make(rows.data(), size);
}

}  // namespace PLUMB_ABI
}  // namespace plumb
