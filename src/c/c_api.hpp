/// What the C functions share: errors as they cross the border, the workspace, the two conversions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "plumb/c/plumb.h"
#include "plumb/calibration/datasheet.hpp"
#include "plumb/health/health_monitor.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {

using std::size_t;

/// Setting up needs more room than running, and only once.
struct Workspace {
  MonitorSetup setup;
  Datasheet datasheet;  ///< of a monitor without a calibration
  RowUncertainty uncertainty;
  std::array<SensorRow, kCapacity> rows{};
};

inline plumb_error answer(std::int32_t code, std::int32_t index = -1, double value = 0.0, double limit = 0.0) noexcept {
  return {code, index, value, limit};
}
inline plumb_error answer(const Error& e) noexcept {
  return answer(static_cast<std::int32_t>(e.code), e.index, e.value, e.limit);
}
inline plumb_error answer(const Expected<void>& result) noexcept {
  return result ? answer(PLUMB_OK) : answer(result.error());
}
inline plumb_error missing(int argument) noexcept { return answer(PLUMB_NULL_POINTER, argument); }

/// A pointer to a struct of this header, or what is wrong with it.
template <class T>
plumb_error check_struct(const T* given, int argument) noexcept {
  if (given == nullptr) return missing(argument);
  if (given->struct_size == sizeof(T)) return answer(PLUMB_OK);
  return answer(PLUMB_WRONG_STRUCT, argument, static_cast<double>(given->struct_size), sizeof(T));
}

inline std::uintptr_t address_of(const void* storage) noexcept { return reinterpret_cast<std::uintptr_t>(storage); }

template <class T>
plumb_error room_for(const void* storage, size_t size, int argument) noexcept {
  if (storage == nullptr) return missing(argument);
  if (size < sizeof(T)) return answer(PLUMB_STORAGE_TOO_SMALL, argument, static_cast<double>(size), sizeof(T));
  if (address_of(storage) % alignof(T) != 0) return answer(PLUMB_STORAGE_MISALIGNED, argument, 0.0, alignof(T));
  return answer(PLUMB_OK);
}

/// As a number that an enumeration can hold: one that has no name where it is none.
inline std::uint8_t number_of(std::int32_t given) noexcept {
  return given >= 0 && given < 255 ? static_cast<std::uint8_t>(given) : std::uint8_t{255};
}

/// From the caller's configuration to a setup in the workspace. Errors: those of `SensorArray::make`, and of the
/// header; the pointer counts as `argument`.
plumb_error prepare(const plumb_config* given, Workspace& work, int argument) noexcept;

/// What a monitor says before its first sample that knows of no sensors: suspect, invalid, alert.
void no_verdict(plumb_verdict& out) noexcept;

/// Copies a verdict out. Errors: null pointer, wrong struct, with `argument`.
plumb_error write(const Verdict& v, plumb_verdict* to, int argument) noexcept;

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb

/// What stands in the storage of the caller.
struct plumb_monitor {
  std::uint64_t alive = 0;
  plumb::HealthMonitor monitor;
};

namespace plumb {
inline namespace PLUMB_ABI {
namespace c_api {

/// Marks storage that holds a monitor: memory that was never initialised, or was cleared, is answered with an error.
inline constexpr std::uint64_t kMonitorAlive = 0x706c756d622d6331ULL;

inline plumb_error check_monitor(const plumb_monitor* monitor, int argument) noexcept {
  if (monitor == nullptr) return missing(argument);
  return monitor->alive == kMonitorAlive ? answer(PLUMB_OK) : answer(PLUMB_NOT_INITIALISED);
}

/// A workspace as `argument`, beside the monitor in `storage`: where both share a byte, setting up the one would write
/// over the other unseen.
inline plumb_error desk_for(const void* workspace, size_t size, int argument, const void* storage) noexcept {
  const plumb_error e = room_for<Workspace>(workspace, size, argument);
  if (e.code != PLUMB_OK) return e;
  const std::uintptr_t desk = address_of(workspace), home = address_of(storage);
  const bool apart = desk < home ? home - desk >= sizeof(Workspace) : desk - home >= sizeof(plumb_monitor);
  return apart ? e : answer(PLUMB_STORAGE_OVERLAPS, argument);
}

}  // namespace c_api
}  // namespace PLUMB_ABI
}  // namespace plumb
