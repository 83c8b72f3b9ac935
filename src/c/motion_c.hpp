/// What the C functions of motion share: the object in the caller's storage, and its inputs in their C++ form.
#pragma once

#include <algorithm>
#include <array>

#include "c_api.hpp"
#include "plumb/c/plumb_motion.h"
#include "plumb/motion/motion_monitor.hpp"

/// What stands in the storage of the caller.
struct plumb_motion {
  std::uint64_t alive = 0;
  plumb::MotionMonitor monitor;
};

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {

inline constexpr std::uint64_t kMotionAlive = 0x706c756d622d6d31ULL;

/// An object that an `init` has made: `T::alive` says so.
template <class T>
plumb_error check_alive(const T* object, std::uint64_t alive, int argument) noexcept {
  if (object == nullptr) return missing(argument);
  return object->alive == alive ? answer(PLUMB_OK) : answer(PLUMB_NOT_INITIALISED);
}

/// An array from structs that hold an axis, a chip and a noise. Errors: those of `SensorArray::make`; wrong struct of a
/// sensor, a chip that is no number of one; none at all counts as `argument`.
template <class Sensor>
plumb_error read_array(const Sensor* sensor, std::int32_t sensors, double Sensor::*sigma, int argument,
                       SensorArray& out) noexcept {
  if (sensors < 3) return answer({Errc::too_few_sensors, -1, static_cast<double>(sensors), 3.0});
  if (sensors > kMotionCapacity)
    return answer({Errc::too_many_sensors, -1, static_cast<double>(sensors), kMotionCapacity});
  if (sensor == nullptr) return missing(argument);
  std::array<SensorRow, kCapacity> rows{};
  for (size_t k = 0; k < static_cast<size_t>(sensors); ++k) {
    const Sensor& from = sensor[k];
    const plumb_error e = check_struct(&from, static_cast<int>(k));
    if (e.code != PLUMB_OK) return e;
    if (from.chip < 0 || from.chip > 255)
      return answer({Errc::out_of_range, static_cast<int>(k), static_cast<double>(from.chip), 255.0});
    rows[k].id = {'s', static_cast<char>('0' + k / 10), static_cast<char>('0' + k % 10)};
    std::copy(from.axis, from.axis + 3, rows[k].axis.begin());
    rows[k].sigma_mps2 = from.*sigma;
    rows[k].chip = static_cast<std::uint8_t>(from.chip);
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), sensors);
  if (!array) return answer(array.error());
  out = *array;
  return answer(PLUMB_OK);
}

/// What `MotionMonitor::configure` takes.
struct MotionProblem {
  SensorArray array;
  MotionSetup setup;
};
/// Errors: those of `SensorArray::make`, and of the header; the pointer counts as `argument`.
plumb_error prepare(const plumb_motion_config* config, int argument, MotionProblem& out) noexcept;

MotionSample sample_of(const plumb_motion_sample& from) noexcept;
plumb_motion_verdict verdict_of(const MotionVerdict& from) noexcept;
/// What stood in the verdict before is not the answer to this call, and must not be taken for it.
plumb_error without_verdict(const plumb_error& e, plumb_motion_verdict* verdict) noexcept;

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb
