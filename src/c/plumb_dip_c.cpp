// The dip behind the C header: copies in, one call, copies out. Nothing is decided here.
#include <algorithm>
#include <limits>
#include <new>
#include <type_traits>

#include "c_api.hpp"
#include "plumb/c/plumb_dip.h"
#include "plumb/health/dip_watch.hpp"

/// What stands in the storage of the caller: evidence over its own stations, or a watch beside a monitor.
struct plumb_dip {
  std::uint64_t alive = 0;
  plumb::SensorArray array;  ///< of the first
  plumb::DipEvidence evidence;
  plumb::DipWatch watch;
};

namespace {

using namespace plumb;
using namespace plumb::c_api;

constexpr std::uint64_t kStations = 0x706c756d622d6431ULL, kWatch = 0x706c756d622d6432ULL;

static_assert(std::is_trivially_destructible<plumb_dip>::value, "storage may simply be dropped");
static_assert(static_cast<int>(DipVerdict::unexplained) == PLUMB_DIP_UNEXPLAINED &&
                  static_cast<int>(DipAssumption::constant_bias) == PLUMB_DIP_CONSTANT_BIAS,
              "the header names them all");

FieldReading reading_of(const plumb_dip_field& from) noexcept {
  FieldReading out;
  std::copy(from.field_nt, from.field_nt + 3, out.field_nt.begin());
  out.axis_error_nt = {from.axis_sigma_nt, from.axis_bound_nt};
  out.vector_nt = from.vector_nt;
  out.turn_rad = from.turn_rad;
  return out;
}

FieldReference reference_of(const plumb_dip_field& from) noexcept {
  return {from.total_nt,
          {from.total_sigma_nt, from.total_bound_nt},
          from.dip_rad,
          {from.dip_sigma_rad, from.dip_bound_rad}};
}

DipStation station_of(const plumb_dip_station& from, SensorSet all, const plumb_dip_field& field) noexcept {
  DipStation out;
  out.used = SensorSet(from.used) & all;
  std::copy(from.mean_mps2, from.mean_mps2 + kCapacity, out.mean_mps2.begin());
  std::copy(from.sigma_mps2, from.sigma_mps2 + kCapacity, out.sigma_mps2.begin());
  std::copy(from.bound_mps2, from.bound_mps2 + kCapacity, out.bound_mps2.begin());
  out.gravity.g_mps2 = from.gravity_mps2;
  out.gravity.sigma_mps2 = from.gravity_sigma_mps2;
  out.acceleration_mps2 = from.acceleration_mps2;
  out.field = reading_of(field);
  out.reference = reference_of(field);
  out.sigmas = from.sigmas;
  return out;
}

plumb_dip_answer answer_of(const DipAnswer& from) noexcept {
  plumb_dip_answer out{};
  out.struct_size = sizeof out;
  out.verdict = static_cast<std::int32_t>(from.verdict);
  out.refusal = static_cast<std::int32_t>(from.refusal);
  out.named = from.named;
  out.suspects = from.suspects.bits;
  out.mirrors = from.mirrors.bits;
  std::copy(from.gravity_mps2.begin(), from.gravity_mps2.end(), out.gravity_mps2);
  out.bound_rad = from.bound_rad;
  return out;
}

plumb_dip_report report_of(const DipReport& from) noexcept {
  plumb_dip_report out{};
  out.struct_size = sizeof out;
  out.protected_by_dip = from.protected_by_dip ? 1 : 0;
  out.answer = answer_of(from.answer);
  std::copy(from.gravity_mps2.begin(), from.gravity_mps2.end(), out.gravity_mps2);
  out.protection_level_calibrated_axes_rad = from.protection_level_calibrated_axes_rad;
  out.protection_level_housing_rad = from.protection_level_housing_rad;
  return out;
}

/// An object that the init of its use has made.
plumb_error check(const plumb_dip* dip, std::uint64_t alive) noexcept {
  if (dip == nullptr) return missing(0);
  return dip->alive == alive ? answer(PLUMB_OK) : answer(PLUMB_NOT_INITIALISED);
}

/// What stood there before is not the answer to this call, and must not be taken for it.
template <class C, class Found>
plumb_error instead(const plumb_error& e, C* to, const Found& nothing) noexcept {
  if (to != nullptr && check_struct(to, 0).code == PLUMB_OK) *to = nothing;
  return e;
}

plumb_error make(void* storage, size_t size, std::int32_t assumption, std::uint64_t alive, const SensorArray& array,
                 plumb_dip** dip) noexcept {
  const plumb_error e = room_for<plumb_dip>(storage, size, 0);
  if (e.code != PLUMB_OK) return e;
  if (assumption != PLUMB_DIP_ANY_FAULT && assumption != PLUMB_DIP_CONSTANT_BIAS)
    return answer({Errc::out_of_range, 0, static_cast<double>(assumption), PLUMB_DIP_CONSTANT_BIAS});
  auto* made = new (storage) plumb_dip;
  const auto assumed = static_cast<DipAssumption>(assumption);
  made->array = array;
  made->evidence = DipEvidence(assumed);
  made->watch = DipWatch(assumed);
  made->alive = alive;
  *dip = made;
  return e;
}

plumb_error array_of(const double* axis, std::int32_t sensors, SensorArray& out) noexcept {
  if (axis == nullptr) return missing(2);
  if (sensors < 3) return answer({Errc::too_few_sensors, -1, static_cast<double>(sensors), 3.0});
  if (sensors > kCapacity) return answer({Errc::too_many_sensors, -1, static_cast<double>(sensors), kCapacity});
  std::array<SensorRow, kCapacity> rows{};
  for (size_t k = 0; k < static_cast<size_t>(sensors); ++k) {
    rows[k].id = {'s', static_cast<char>('0' + k / 10), static_cast<char>('0' + k % 10)};
    std::copy(axis + 3 * k, axis + 3 * k + 3, rows[k].axis.begin());
    rows[k].sigma_mps2 = 1.0;  // a station brings its own
  }
  const Expected<SensorArray> array = SensorArray::make(rows.data(), sensors);
  if (!array) return answer(array.error());
  out = *array;
  return answer(PLUMB_OK);
}

}  // namespace

extern "C" {

plumb_error plumb_dip_field_defaults(plumb_dip_field* field) noexcept {
  if (field == nullptr) return missing(0);
  *field = plumb_dip_field{};
  field->struct_size = sizeof(plumb_dip_field);
  return answer(PLUMB_OK);
}

plumb_error plumb_dip_station_defaults(plumb_dip_station* station) noexcept {
  if (station == nullptr) return missing(0);
  const DipStation d;
  *station = plumb_dip_station{};
  station->struct_size = sizeof(plumb_dip_station);
  station->gravity_mps2 = d.gravity.g_mps2;
  station->gravity_sigma_mps2 = d.gravity.sigma_mps2;
  station->sigmas = d.sigmas;
  return answer(PLUMB_OK);
}

plumb_error plumb_dip_answer_defaults(plumb_dip_answer* found) noexcept {
  if (found == nullptr) return missing(0);
  *found = answer_of(DipAnswer{});
  return answer(PLUMB_OK);
}

plumb_error plumb_dip_report_defaults(plumb_dip_report* report) noexcept {
  if (report == nullptr) return missing(0);
  *report = report_of(DipReport{});
  return answer(PLUMB_OK);
}

const char* plumb_dip_verdict_text(std::int32_t verdict) noexcept {
  return to_string(static_cast<DipVerdict>(number_of(verdict)));
}
const char* plumb_dip_refusal_text(std::int32_t refusal) noexcept {
  return to_string(static_cast<DipRefusal>(number_of(refusal)));
}

size_t plumb_dip_size(void) noexcept { return sizeof(plumb_dip); }
size_t plumb_dip_align(void) noexcept { return alignof(plumb_dip); }

plumb_error plumb_dip_init(void* storage, size_t storage_size, const double* axis, std::int32_t sensors,
                           std::int32_t assumption, plumb_dip** dip) noexcept {
  if (dip == nullptr) return missing(5);
  *dip = nullptr;
  SensorArray array;
  const plumb_error e = array_of(axis, sensors, array);
  return e.code != PLUMB_OK ? e : make(storage, storage_size, assumption, kStations, array, dip);
}

plumb_error plumb_dip_add(plumb_dip* dip, const plumb_dip_station* station, const plumb_dip_field* field,
                          plumb_dip_answer* found) noexcept {
  plumb_error e = check(dip, kStations);
  if (e.code == PLUMB_OK) e = check_struct(station, 1);
  if (e.code == PLUMB_OK) e = check_struct(field, 2);
  if (e.code == PLUMB_OK) e = check_struct(found, 3);
  if (e.code != PLUMB_OK) return instead(e, found, answer_of(DipAnswer{}));
  *found = answer_of(dip->evidence.add(judge_dip(dip->array, station_of(*station, dip->array.all(), *field))));
  return e;
}

plumb_error plumb_dip_watch_init(void* storage, size_t storage_size, std::int32_t assumption,
                                 plumb_dip** dip) noexcept {
  if (dip == nullptr) return missing(3);
  *dip = nullptr;
  return make(storage, storage_size, assumption, kWatch, SensorArray{}, dip);
}

plumb_error plumb_dip_watch_add(plumb_dip* dip, const plumb_monitor* monitor, void* workspace, size_t workspace_size,
                                const plumb_config* config, const plumb_dip_field* field,
                                plumb_dip_report* report) noexcept {
  plumb_error e = check(dip, kWatch);
  if (e.code == PLUMB_OK) e = check_monitor(monitor, 1);
  if (e.code == PLUMB_OK) e = desk_for(workspace, workspace_size, 2, monitor);
  if (e.code == PLUMB_OK) e = check_struct(field, 5);
  if (e.code == PLUMB_OK) e = check_struct(report, 6);
  if (e.code != PLUMB_OK) return instead(e, report, report_of(DipReport{}));
  auto* work = new (workspace) Workspace;
  e = prepare(config, *work, 4);
  if (e.code != PLUMB_OK) return instead(e, report, report_of(DipReport{}));
  *report = report_of(dip->watch.add(monitor->monitor, work->setup, reading_of(*field), reference_of(*field)));
  return e;
}

plumb_error plumb_dip_forget(plumb_dip* dip) noexcept {
  if (dip == nullptr) return missing(0);
  if (dip->alive != kStations && dip->alive != kWatch) return answer(PLUMB_NOT_INITIALISED);
  dip->evidence.forget();
  dip->watch.forget();
  return answer(PLUMB_OK);
}

}  // extern "C"
