/// What the C functions of motion share: the object in the caller's storage, and its inputs in their C++ form.
#pragma once

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
