// The monitor behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <algorithm>
#include <new>
#include <type_traits>

#include "c_api.hpp"
#include "plumb/core/version.hpp"

namespace {

using namespace plumb;
using namespace plumb::c_api;

static_assert(static_cast<int>(kLastErrc) < PLUMB_NULL_POINTER, "codes of the C header begin above those of plumb");

static_assert(std::is_trivially_destructible<plumb_monitor>::value, "storage may simply be dropped");

plumb_error check(const plumb_monitor* m) noexcept { return check_monitor(m, 0); }

/// What stood in the verdict before is not the answer to this call, and must not be taken for it.
plumb_error without_verdict(const plumb_error& e, plumb_verdict* verdict) noexcept {
  if (verdict != nullptr && check_struct(verdict, 0).code == PLUMB_OK) no_verdict(*verdict);
  return e;
}

}  // namespace

extern "C" {

const char* plumb_error_text(std::int32_t code) noexcept {
  switch (code) {
    case PLUMB_NULL_POINTER: return "a pointer is null";
    case PLUMB_WRONG_STRUCT: return "struct_size differs from the size in the library's header";
    case PLUMB_STORAGE_TOO_SMALL: return "the storage is too small";
    case PLUMB_STORAGE_MISALIGNED: return "the storage is not aligned";
    case PLUMB_NOT_INITIALISED: return "nothing was set up in this storage";
    case PLUMB_STORAGE_OVERLAPS: return "the workspace and the storage of the monitor share memory";
    default: break;
  }
  const bool known = code >= 0 && code <= static_cast<std::int32_t>(kLastErrc);
  return known ? describe(static_cast<Errc>(code)) : "unknown error";
}

const char* plumb_error_remedy(std::int32_t code) noexcept {
  switch (code) {
    case PLUMB_NULL_POINTER: return "pass a pointer for argument number `index`, counted from 0";
    case PLUMB_WRONG_STRUCT: return "call the ..._defaults function, or build against the header of the library";
    case PLUMB_STORAGE_TOO_SMALL:
      return "give argument `index` as many bytes as the ..._size() function of what stands there says";
    case PLUMB_STORAGE_MISALIGNED:
      return "align argument `index` as the ..._align() function of what stands there says";
    case PLUMB_NOT_INITIALISED: return "call plumb_monitor_init, plumb_motion_init or plumb_inclination_init first";
    case static_cast<std::int32_t>(Errc::buffer_too_small): return "give at least plumb_snapshot_size_max() bytes";
    case PLUMB_STORAGE_OVERLAPS: return "give each its own memory; the workspace can be reused after the call";
    default: break;
  }
  const bool known = code >= 0 && code <= static_cast<std::int32_t>(kLastErrc);
  return known ? remedy(static_cast<Errc>(code)) : "see plumb/c/plumb.h";
}

const char* plumb_state_text(std::int32_t state) noexcept {
  return to_string(static_cast<HealthState>(number_of(state)));
}
const char* plumb_validity_text(std::int32_t validity) noexcept {
  return to_string(static_cast<Validity>(number_of(validity)));
}
const char* plumb_cause_text(std::int32_t cause) noexcept { return to_string(static_cast<Cause>(number_of(cause))); }

std::uint32_t plumb_c_version(void) noexcept { return PLUMB_C_VERSION; }
std::uint32_t plumb_library_version(void) noexcept { return kLibraryVersion; }
std::int32_t plumb_capacity(void) noexcept { return kCapacity; }
size_t plumb_monitor_size(void) noexcept { return sizeof(plumb_monitor); }
size_t plumb_monitor_align(void) noexcept { return alignof(plumb_monitor); }
size_t plumb_workspace_size(void) noexcept { return sizeof(Workspace); }
size_t plumb_workspace_align(void) noexcept { return alignof(Workspace); }
size_t plumb_snapshot_size_max(void) noexcept { return HealthMonitor::snapshot_size_max(); }

plumb_error plumb_monitor_init(void* storage, size_t storage_size, void* workspace, size_t workspace_size,
                               const plumb_config* config, plumb_monitor** monitor) noexcept {
  if (monitor == nullptr) return missing(5);
  *monitor = nullptr;
  plumb_error e = room_for<plumb_monitor>(storage, storage_size, 0);
  if (e.code == PLUMB_OK) e = desk_for(workspace, workspace_size, 2, storage);
  if (e.code != PLUMB_OK) return e;
  auto* work = new (workspace) Workspace;
  e = prepare(config, *work, 4);
  if (e.code != PLUMB_OK) return e;
  auto* made = new (storage) plumb_monitor;
  e = answer(made->monitor.configure(work->setup));
  if (e.code != PLUMB_OK) return e;
  made->alive = kMonitorAlive;
  *monitor = made;
  return e;
}

plumb_error plumb_monitor_restore(void* storage, size_t storage_size, void* workspace, size_t workspace_size,
                                  const plumb_config* config, const std::uint8_t* snapshot, size_t snapshot_size,
                                  plumb_monitor** monitor) noexcept {
  if (monitor == nullptr) return missing(7);
  const plumb_error e = plumb_monitor_init(storage, storage_size, workspace, workspace_size, config, monitor);
  if (e.code != PLUMB_OK) return e;
  if (snapshot == nullptr) return missing(5);
  const auto* work = static_cast<const Workspace*>(workspace);
  return answer((*monitor)->monitor.restore(work->setup, snapshot, snapshot_size));
}

plumb_error plumb_monitor_snapshot(const plumb_monitor* monitor, std::uint8_t* to, size_t room,
                                   size_t* written) noexcept {
  const plumb_error e = check(monitor);
  if (e.code != PLUMB_OK) return e;
  if (to == nullptr || written == nullptr) return missing(to == nullptr ? 1 : 3);
  *written = 0;
  const Expected<size_t> size = monitor->monitor.snapshot(to, room);
  if (!size) return answer(size.error());
  *written = *size;
  return answer(PLUMB_OK);
}

plumb_error plumb_monitor_step(plumb_monitor* monitor, const plumb_sample* sample, plumb_verdict* verdict) noexcept {
  plumb_error e = check(monitor);
  if (e.code == PLUMB_OK) e = check_struct(sample, 1);
  if (e.code != PLUMB_OK) return without_verdict(e, verdict);
  Sample s;
  s.time_s = sample->time_s;
  std::copy(sample->raw, sample->raw + kCapacity, s.raw.begin());
  s.delivered = SensorSet(sample->delivered);
  s.temperature_degc = sample->temperature_degc;
  s.station = sample->station;
  s.count = sample->count;
  const Verdict& v = monitor->monitor.step(s);
  return verdict != nullptr ? c_api::write(v, verdict, 2) : answer(PLUMB_OK);
}

plumb_error plumb_monitor_verdict(const plumb_monitor* monitor, plumb_verdict* verdict) noexcept {
  const plumb_error e = check(monitor);
  return e.code != PLUMB_OK ? without_verdict(e, verdict) : c_api::write(monitor->monitor.verdict(), verdict, 1);
}

plumb_error plumb_monitor_reset(plumb_monitor* monitor, std::uint64_t key, std::uint32_t sensors) noexcept {
  const plumb_error e = check(monitor);
  return e.code != PLUMB_OK ? e : answer(monitor->monitor.reset(key, SensorSet(sensors)));
}

plumb_error plumb_monitor_set_gravity(plumb_monitor* monitor, double g_mps2, double sigma_mps2) noexcept {
  const plumb_error e = check(monitor);
  return e.code != PLUMB_OK ? e : answer(monitor->monitor.set_gravity({g_mps2, sigma_mps2, GravityModel::value}));
}

plumb_error plumb_monitor_set_rotation(plumb_monitor* monitor, std::int32_t turning,
                                       const double rate_radps[3]) noexcept {
  const plumb_error e = check(monitor);
  if (e.code != PLUMB_OK) return e;
  Rotation rotation;
  rotation.turning = turning != 0;
  rotation.rate_known = rate_radps != nullptr;
  if (rate_radps != nullptr) rotation.rate_radps = {rate_radps[0], rate_radps[1], rate_radps[2]};
  return answer(monitor->monitor.set_rotation(rotation));
}

plumb_error plumb_monitor_request_recalibration(plumb_monitor* monitor) noexcept {
  const plumb_error e = check(monitor);
  return e.code != PLUMB_OK ? e : answer(monitor->monitor.request_recalibration());
}

plumb_error plumb_monitor_offer(plumb_monitor* monitor, void* workspace, size_t workspace_size,
                                const plumb_config* config) noexcept {
  plumb_error e = check(monitor);
  if (e.code == PLUMB_OK) e = desk_for(workspace, workspace_size, 1, monitor);
  if (e.code != PLUMB_OK) return e;
  auto* work = new (workspace) Workspace;
  e = prepare(config, *work, 3);
  if (e.code != PLUMB_OK) return e;
  if (!work->setup.calibrated) return answer({Errc::not_calibrated});
  return answer(monitor->monitor.offer_calibration(work->setup.model, work->setup.array));
}

plumb_error plumb_monitor_calibration(const plumb_monitor* monitor, std::int32_t sensor, plumb_sensor* to) noexcept {
  plumb_error e = check(monitor);
  if (e.code == PLUMB_OK) e = check_struct(to, 2);
  if (e.code != PLUMB_OK) return e;
  const HealthMonitor& m = monitor->monitor;
  if (sensor < 0 || sensor >= m.array().size())
    return answer({Errc::out_of_range, -1, static_cast<double>(sensor), static_cast<double>(m.array().size() - 1)});
  const Vec3 axis = m.array().axis(sensor);
  const SensorCoefficients& c = m.model().sensor[static_cast<size_t>(sensor)];
  std::copy(axis.begin(), axis.end(), to->axis);
  std::copy(c.scale.begin(), c.scale.end(), to->scale);
  std::copy(c.bias.begin(), c.bias.end(), to->bias_mps2);
  to->reference_degc = c.reference_degc;
  return e;
}

plumb_error plumb_monitor_inhibit(plumb_monitor* monitor, std::int32_t frozen) noexcept {
  const plumb_error e = check(monitor);
  if (e.code == PLUMB_OK) monitor->monitor.inhibit(frozen != 0);
  return e;
}

plumb_error plumb_monitor_begin_time_base(plumb_monitor* monitor) noexcept {
  const plumb_error e = check(monitor);
  if (e.code == PLUMB_OK) monitor->monitor.begin_time_base();
  return e;
}

}  // extern "C"
